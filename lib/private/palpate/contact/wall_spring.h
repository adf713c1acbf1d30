#pragma once
/// The spring of a wall at one place, straight or not.

namespace palpate {

/// A wall's spring (materials/material.h, SpringCurve), as it is at the proxy.
struct WallSpring {
  double stiffness = 0.0;   ///< [N/m]
  double stiffening = 0.0;  ///< [N/m^2]
  double exponent = 1.0;    ///< [-] 1 or more
  double reference = 1.0;   ///< [m] positive

  [[nodiscard]] bool isStraight() const noexcept { return stiffening == 0.0 && exponent == 1.0; }
  /// [N/m] Force over depth, `depth` [m] deep; exactly `stiffness` where the spring is straight.
  [[nodiscard]] double secant(double depth) const noexcept;
  /// [N] that it pushes with, `depth` [m] deep; 0 for no depth.
  [[nodiscard]] double force(double depth) const noexcept {
    return depth > 0.0 ? secant(depth) * depth : 0.0;
  }
  /// [m^2] What the stored energy changes by per change of `stiffness`: half of depth^2 where
  /// straight.
  [[nodiscard]] double energyPerStiffness(double depth) const noexcept;
  /// [m^3] The same per change of `stiffening`.
  [[nodiscard]] static double energyPerStiffening(double depth) noexcept {
    return depth > 0.0 ? depth * depth * depth / 3.0 : 0.0;
  }
  /// [J] stored, `depth` [m] deep.
  [[nodiscard]] double energy(double depth) const noexcept {
    return stiffness * energyPerStiffness(depth) + stiffening * energyPerStiffening(depth);
  }

 private:
  /// (depth / reference)^(exponent - 1)
  [[nodiscard]] double growth(double depth) const noexcept;
};

}  // namespace palpate
