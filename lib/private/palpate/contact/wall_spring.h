#pragma once
/// The spring of a wall at one place, linear or not.

namespace palpate {

/// A wall's spring (materials/material.h, SpringCurve), with its parameters at the proxy.
struct WallSpring {
  double stiffness = 0.0;   ///< [N/m]
  double stiffening = 0.0;  ///< [N/m^2]
  double exponent = 1.0;    ///< [-] 1 or more
  double reference = 1.0;   ///< [m] positive

  [[nodiscard]] bool isStraight() const noexcept { return stiffening == 0.0 && exponent == 1.0; }
  /// [N/m] Force over depth at `depth` [m]; exactly `stiffness` if the spring is linear.
  [[nodiscard]] double secant(double depth) const noexcept;
  /// [N] The force at `depth` [m]; 0 without depth.
  [[nodiscard]] double force(double depth) const noexcept {
    return depth > 0.0 ? secant(depth) * depth : 0.0;
  }
  /// [m^2] Derivative of the stored energy by `stiffness`: half of depth^2 if the spring is linear.
  [[nodiscard]] double energyPerStiffness(double depth) const noexcept;
  /// [m^3] Derivative of the stored energy by `stiffening`.
  [[nodiscard]] static double energyPerStiffening(double depth) noexcept {
    return depth > 0.0 ? depth * depth * depth / 3.0 : 0.0;
  }
  /// [J] The energy stored at `depth` [m].
  [[nodiscard]] double energy(double depth) const noexcept {
    return stiffness * energyPerStiffness(depth) + stiffening * energyPerStiffening(depth);
  }

 private:
  /// (depth / reference)^(exponent - 1)
  [[nodiscard]] double growth(double depth) const noexcept;
};

}  // namespace palpate
