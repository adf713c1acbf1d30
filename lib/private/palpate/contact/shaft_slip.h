#pragma once
/// Stick and slip of a needle's shaft in one tissue (materials/material.h, ShaftFriction).

namespace palpate {

/// The friction of one tissue along the shaft, per length of it, with its parameters at the place
/// of the shaft.
struct ShaftLaw {
  struct Way {
    double static_force = 0.0;   ///< [N/m]
    double kinetic_force = 0.0;  ///< [N/m] at most `static_force`
    double damping = 0.0;        ///< [N s/m^2]
  };
  Way in;
  Way out;
  double stiffness = 0.0;    ///< [N/m^2] positive
  double stick_speed = 0.0;  ///< [m/s]
};

/// How far the tissue that sticks to the shaft is drawn along, and whether the shaft slides through
/// it. A value type; real-time safe. Passive: new length enters unstretched, length that leaves
/// takes its share of the stretch with it, and slipping only ever reduces the stretch.
class ShaftSlip {
 public:
  /// The shaft went in by `advance` [m] (negative: out), while the hand moves at `speed` [m/s]
  /// along it; now `length` [m] of it is in this tissue. Returns the force [N] on the shaft against
  /// going in.
  double step(const ShaftLaw& law, double length, double advance, double speed) noexcept;
  void reset() noexcept { *this = {}; }

  [[nodiscard]] bool isSliding() const noexcept { return is_sliding_; }
  [[nodiscard]] double stretch() const noexcept { return stretch_; }  ///< [m] mean over the length
  /// [J] Energy in the tissue that is drawn along, of stiffness `stiffness` [N/m^2].
  [[nodiscard]] double stored(double stiffness) const noexcept {
    return 0.5 * stiffness * stretch_ * stretch_ * length_;
  }

 private:
  double stretch_ = 0.0;
  double length_ = 0.0;  ///< [m] at the last step
  bool is_sliding_ = false;
};

}  // namespace palpate
