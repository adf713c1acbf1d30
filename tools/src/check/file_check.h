#pragma once
/// What `palpate check` finds in one file.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "console.h"
#include "options.h"
#include "palpate/core/error.h"
#include "palpate/core/math.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// Something that is not as it should be.
struct Finding {
  std::string code;     ///< "mesh.holes", "grid.band_holes", ...
  std::string message;  ///< for people, with the place
  std::uint64_t count = 0;
  std::optional<Vec3> place = {};  ///< [m]
};

struct FileCheck {
  bool is_yes = true;  ///< it can be touched
  Json json;           ///< with "file", "kind" and "ok" first
  std::string text;
};

[[nodiscard]] FileCheck checkMeshFile(const std::string& file, const CheckOptions& options,
                                      Console& console);
/// One grid of the level-set class that cannot be touched is a no, and so is a file without any
/// that can.
[[nodiscard]] FileCheck checkGridFile(const std::string& file, const CheckOptions& options,
                                      Console& console);

/// Makes all of it; what its grids could not hold of meshes and scans is a note, and does not make
/// the answer no. @throws Error, if it cannot be made.
[[nodiscard]] FileCheck checkSceneFile(const std::string& file, Console& console);

[[nodiscard]] Json findingsJson(const std::vector<Finding>& findings);
/// A line for each.
[[nodiscard]] std::string findingsText(const std::vector<Finding>& findings, const char* indent);
[[nodiscard]] Json problemJson(const Problem& problem);
/// "the mesh is open: ... (close it ...)"
[[nodiscard]] std::string problemText(const Problem& problem);
/// "12 triangles", "1 triangle"
[[nodiscard]] std::string countOf(std::uint64_t count, const std::string& one,
                                  const std::string& many);
/// "(1, 2, 3) mm"
[[nodiscard]] std::string placeText(const Vec3& place, const LengthUnit& unit);

}  // namespace palpate::tools
