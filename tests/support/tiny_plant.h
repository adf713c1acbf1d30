#pragma once
// One axis of a held device, integrated exactly: an independent oracle for code that closes a loop
// around it.

#include <cmath>

namespace palpate::testing {

/// A mass with two dampers, its own and the hand's, and the hand's spring to its target. The
/// motor's force and the target are held constant for a period. The motion in between is the closed
/// form of the damped oscillator, which may be underdamped or overdamped.
class TinyPlant {
 public:
  struct Parts {
    double mass = 0.1;            ///< [kg]
    double damping = 0.1;         ///< [N s/m] of the device
    double hand_damping = 0.0;    ///< [N s/m]
    double hand_stiffness = 0.0;  ///< [N/m]
  };

  TinyPlant(const Parts& parts, double period, double position = 0.0, double velocity = 0.0)
      : parts_(parts), part_(period / kParts), x_(position), v_(velocity), first_(energy()) {}

  /// Runs one period under the motor's `force` [N], with the hand's target at `aim` [m].
  void step(double force, double aim) noexcept {
    const double begin = x_;
    for (int i = 0; i < kParts; ++i) {
      const double before = v_;
      advance(0.5 * part_, force, aim);
      const double middle = v_;
      advance(0.5 * part_, force, aim);
      // Simpson's rule: the square of the velocity is smooth within the period.
      lost_ += parts_.damping * part_ * (before * before + 4.0 * middle * middle + v_ * v_) / 6.0;
    }
    work_ += force * (x_ - begin);
  }

  [[nodiscard]] double position() const noexcept { return x_; }
  [[nodiscard]] double velocity() const noexcept { return v_; }
  /// [J] work of the motor.
  [[nodiscard]] double work() const noexcept { return work_; }
  /// [J] energy that left the device at the hand's side: the motor's work, minus the device's
  /// losses and its gain of kinetic energy.
  [[nodiscard]] double givenToHand() const noexcept { return work_ - lost_ - energy() + first_; }

 private:
  static constexpr int kParts = 4;

  [[nodiscard]] double energy() const noexcept { return 0.5 * parts_.mass * v_ * v_; }

  void advance(double t, double force, double aim) noexcept {
    const double m = parts_.mass;
    const double decay = 0.5 * (parts_.damping + parts_.hand_damping) / m;
    const double k = parts_.hand_stiffness;
    if (k == 0.0) {
      const double rate = 2.0 * decay;
      const double slow = rate * t > 1e-9 ? -std::expm1(-rate * t) / rate : t;
      const double end = rate > 0.0 ? force / (m * rate) : 0.0;
      if (rate > 0.0) {
        x_ += end * t + (v_ - end) * slow;
        v_ = end + (v_ - end) * std::exp(-rate * t);
      } else {
        x_ += v_ * t + 0.5 * force / m * t * t;
        v_ += force / m * t;
      }
      return;
    }
    const double rest = aim + force / k;
    const double square = k / m - decay * decay;
    const double w = std::sqrt(std::fabs(square));
    const double c = square > 0.0 ? std::cos(w * t) : std::cosh(w * t);
    const double s = w * t < 1e-9 ? t : (square > 0.0 ? std::sin(w * t) : std::sinh(w * t)) / w;
    const double fall = std::exp(-decay * t);
    const double x = x_ - rest;
    const double v = v_;
    x_ = rest + fall * (x * (c + decay * s) + v * s);
    v_ = fall * (v * (c - decay * s) - x * (k / m) * s);
  }

  Parts parts_;
  double part_;
  double x_;
  double v_;
  double first_;
  double work_ = 0.0;
  double lost_ = 0.0;
};

}  // namespace palpate::testing
