#pragma once
/// Lines of equal distance to the nearest surface of a layer, on a plane through a scene.

#include "palpate/core/math.h"
#include "palpate/scene/scene.h"

namespace palpate::tools {

class DistanceLines {
 public:
  /// One line every `spacing` [m]; the surfaces themselves get none.
  DistanceLines(const Scene& scene, double spacing) : scene_(scene), spacing_(spacing) {}

  /// 0 to 1: how much ink a pixel of side `pixel` [m] around `p` gets, on a plane with the unit
  /// normal `normal`. Every fifth line is dark.
  [[nodiscard]] double inkAt(const Vec3& p, const Vec3& normal, double pixel) const;
  /// @throws Error (kUsage) if lines would merge in pixels of side `pixel` [m].
  void check(double pixel) const;
  [[nodiscard]] double spacing() const noexcept { return spacing_; }

 private:
  const Scene& scene_;
  double spacing_;
};

}  // namespace palpate::tools
