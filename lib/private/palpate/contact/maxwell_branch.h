#pragma once
/// The state of a Maxwell branch: a spring of stiffness K' in series with a dashpot of viscosity K'
/// tau.

namespace palpate {

/// The stretch of the branch's spring; its force is K' times that. A value type; real-time safe.
/// Passive: it gives back only the energy that was put in, minus what the dashpot dissipated.
class MaxwellBranch {
 public:
  /// The depth changed at a constant rate by `by` [m] within `dt` [s]; the result is exact for
  /// that. `time` [s] is tau, positive.
  void step(double by, double dt, double time) noexcept;
  /// Raises the stretch to at least `least` [m] (0 or less), so that the branch does not pull
  /// harder.
  void keepAbove(double least) noexcept {
    if (stretch_ < least) stretch_ = least;
  }
  void reset() noexcept { stretch_ = 0.0; }

  [[nodiscard]] double stretch() const noexcept { return stretch_; }  ///< [m]

 private:
  double stretch_ = 0.0;
};

}  // namespace palpate
