#pragma once
/// The plane along which a picture is cut, with its right and up directions.

#include <string>

#include "palpate/core/math.h"
#include "picture/track.h"
#include "text.h"

namespace palpate::tools {

/// Everything on the side that `normal` points to, that of the viewer, is cut away.
struct CutPlane {
  Vec3 point{0.0};            ///< [m]
  Vec3 right{1.0, 0.0, 0.0};  ///< unit
  Vec3 up{0.0, 0.0, 1.0};     ///< unit; right x up points at the viewer
  std::string name;           ///< "at y = 12 mm"
  int right_axis = -1;        ///< world axis that `right` is parallel to, or -1
  int up_axis = -1;

  [[nodiscard]] Vec3 normal() const { return glm::cross(right, up); }
  [[nodiscard]] Vec3 at(double u, double v) const { return point + u * right + v * up; }
  [[nodiscard]] double u(const Vec3& p) const { return glm::dot(p - point, right); }
  [[nodiscard]] double v(const Vec3& p) const { return glm::dot(p - point, up); }
};

/// Perpendicular to world axis 0, 1 or 2, at `value` [m].
[[nodiscard]] CutPlane planeAcross(int axis, double value, const LengthUnit& unit);

/// Through `point`, perpendicular to `normal` (of any length except zero), with up as near to z
/// (else y) as possible.
[[nodiscard]] CutPlane planeThrough(const Vec3& point, const Vec3& normal, const LengthUnit& unit);

/// The plane that a hand's path lies in, or that fits it best. Straight paths lie in many planes;
/// then the plane most nearly across y is chosen, else across x, then z.
[[nodiscard]] CutPlane planeAlong(const Track& track, const LengthUnit& unit);

/// "x=12" (scene's unit), of `option`. @throws Error (kUsage).
[[nodiscard]] CutPlane parsePlane(const std::string& text, const LengthUnit& unit,
                                  const char* option = "--plane");
/// "X,Y,Z,NX,NY,NZ". @throws Error (kUsage).
[[nodiscard]] CutPlane parseCut(const std::string& text, const LengthUnit& unit);

}  // namespace palpate::tools
