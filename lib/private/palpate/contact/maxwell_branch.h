#pragma once
/// The state of a Maxwell branch: a spring of stiffness K' behind a dashpot of K' tau.

namespace palpate {

/// How far the branch's spring is stretched; it pushes with K' times that. A value; real-time safe.
/// Passive: what it gives back was put in, less what the dashpot took.
class MaxwellBranch {
 public:
  /// The depth changed evenly by `by` [m] within `dt` [s]; exact for that. `time` [s] is tau,
  /// positive.
  void step(double by, double dt, double time) noexcept;
  /// Lets go of what is below `least` [m] (which is 0 or less): the branch does not pull harder.
  void keepAbove(double least) noexcept {
    if (stretch_ < least) stretch_ = least;
  }
  void reset() noexcept { stretch_ = 0.0; }

  [[nodiscard]] double stretch() const noexcept { return stretch_; }  ///< [m]

 private:
  double stretch_ = 0.0;
};

}  // namespace palpate
