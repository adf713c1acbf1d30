#pragma once
/// Lines of equal distance from the nearest surface of a layer, on a plane through a scene.

#include "palpate/core/math.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

class DistanceLines {
 public:
  /// A line every `spacing` [m], the surfaces themselves left out.
  DistanceLines(const Scene& scene, double spacing) : scene_(scene), spacing_(spacing) {}

  /// 0 to 1: how much ink a pixel of side `pixel` [m] around `p` has, on a plane across unit
  /// `normal`. Every fifth line is dark.
  [[nodiscard]] double inkAt(const Vec3& p, const Vec3& normal, double pixel) const;
  /// @throws Error (kUsage) if lines in pixels of side `pixel` [m] would run into one another.
  void check(double pixel) const;
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

 private:
  const Scene& scene_;
  double spacing_;
};

}  // namespace palpate::tools
