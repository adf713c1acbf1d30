#pragma once
/// Points, lines and curves as 3D Slicer keeps them: its Markups files (.mrk.json, Slicer 4.11 and
/// later; the format is that of its published JSON schema, version 1.0.3).

#include <string>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::tools {

struct MarkupPoint {
  std::string label;
  Vec3 position{0.0};  ///< [m] RAS
};

struct Markup {
  std::string type;  ///< "Fiducial", "Line", "Curve", ...
  std::string name;  ///< as Slicer calls it; may be empty
  std::vector<MarkupPoint> points;
};

[[nodiscard]] bool isMarkupsName(const std::string& path);

/// Points that were not placed yet are left out. A file that does not say otherwise is in LPS and
/// millimeters, as the schema has it.
/// @throws Error (kInput, markups.*) with file and place: not JSON, not Markups, a point without
/// three finite numbers, a coordinate system or a unit that is not known.
[[nodiscard]] std::vector<Markup> readMarkups(const std::string& path);

/// The text of a file, in LPS and millimeters.
[[nodiscard]] std::string markupsText(const std::vector<Markup>& markups);

/// `points` without those that lie within `tolerance` [m] of the straight line between their
/// neighbors (Ramer 1972, Douglas and Peucker 1973). The first and the last stay.
[[nodiscard]] std::vector<Vec3> thinned(const std::vector<Vec3>& points, double tolerance);

}  // namespace palpate::tools
