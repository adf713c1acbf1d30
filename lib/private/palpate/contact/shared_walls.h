#pragma once
/// Walls beside each other on one surface that share one press.

#include <array>

#include "palpate/contact/wall_law.h"

namespace palpate {

/// A wall's law at one place, and its derivatives by the place.
struct SharedWall {
  WallLaw law;
  Vec3 height_rise{0.0, 0.0, 0.0};      ///< [-] gradient of its height by the place, ...
  Vec3 stiffness_rise{0.0, 0.0, 0.0};   ///< [N/m^2] ... of its stiffness ...
  Vec3 stiffening_rise{0.0, 0.0, 0.0};  ///< [N/m^3] ... and of its stiffening
  Vec3 stiffness_press{0.0, 0.0,
                       0.0};  ///< [N/m^2] gradient of its stiffness by the press: see overPatch()

  /// True if the law is the same everywhere, whatever the press.
  [[nodiscard]] bool isEven() const noexcept {
    return height_rise == Vec3(0.0) && stiffness_rise == Vec3(0.0) &&
           stiffening_rise == Vec3(0.0) && stiffness_press == Vec3(0.0);
  }
  /// [N] The gradient, at `depth` [m], of the energy by the place at constant press, ...
  [[nodiscard]] Vec3 rise(double depth) const noexcept;
  /// [N] ... and by the press at constant place.
  [[nodiscard]] Vec3 byPress(double depth) const noexcept {
    if (stiffness_press == Vec3(0.0)) return stiffness_press;
    return law.energyPerStiffness(depth) * stiffness_press;
  }
};

/// Walls that share a press. Each stores its share of the energy that its own law would store
/// alone. So the force has a potential, whatever the shares, if it includes the gradient of the
/// shares. A single wall has the share 1. A value type; real-time safe.
class SharedWalls {
 public:
  /// The largest number of walls; if there are more, those with the smallest shares are left out.
  static constexpr std::size_t kMost = 4;

  /// Adds a wall that bears `share` [-] of the press; `by_place` [1/m] is the gradient of the share
  /// by the place at constant press, `by_press` [1/m] that by the press at constant place.
  void add(const SharedWall& felt, double share = 1.0, const Vec3& by_place = Vec3(0.0),
           const Vec3& by_press = Vec3(0.0)) noexcept;

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] bool isStraight() const noexcept;
  [[nodiscard]] bool isEven() const noexcept;
  /// [N], [N/m], [J]: as those of WallLaw.
  [[nodiscard]] double force(double depth) const noexcept;
  [[nodiscard]] double tangent(double depth) const noexcept;
  [[nodiscard]] double energy(double depth) const noexcept;
  /// [N] Gradients of the energy at `depth` [m] by the place and by the press.
  [[nodiscard]] Vec3 rise(double depth) const noexcept;
  [[nodiscard]] Vec3 byPress(double depth) const noexcept;

 private:
  struct Part {
    SharedWall felt;
    double share = 1.0;
    Vec3 by_place{0.0, 0.0, 0.0};
    Vec3 by_press{0.0, 0.0, 0.0};

    /// [N] The part due to the share's own gradient [1/m]; most walls are alone and have none.
    [[nodiscard]] Vec3 byShare(const Vec3& gradient, double depth) const noexcept {
      return gradient == Vec3(0.0) ? gradient : felt.law.energy(depth) * gradient;
    }
  };
  template <typename OfPart>
  [[nodiscard]] auto sum(const OfPart& of) const noexcept;
  std::array<Part, kMost> part_;
  std::size_t count_ = 0;
};

/// Like softWall() of one law.
[[nodiscard]] SoftWall softWall(const SharedWalls& walls, double stop, double give) noexcept;

}  // namespace palpate
