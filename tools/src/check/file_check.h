#pragma once
/// The findings of `palpate check` in one file.

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

/// Something that is wrong or worth knowing.
struct Finding {
  std::string code;     ///< "mesh.holes", "grid.band_holes", ...
  std::string message;  ///< for people, with the place
  std::uint64_t count = 0;
  std::optional<Vec3> place = {};  ///< [m]
};

struct FileCheck {
  bool is_yes = true;  ///< the content can be touched
  Json json;           ///< begins with "file", "kind" and "ok"
  std::string text;
};

[[nodiscard]] FileCheck checkMeshFile(const std::string& file, const CheckOptions& options,
                                      Console& console);
/// The answer is "no" if a grid of the level-set class cannot be touched, or if the file has no
/// grid that can.
[[nodiscard]] FileCheck checkGridFile(const std::string& file, const CheckOptions& options,
                                      Console& console);

/// Makes everything in the scene. Notes report parts of meshes and scans that its grids could not
/// hold; they do not make the answer "no". @throws Error, if the scene cannot be made.
[[nodiscard]] FileCheck checkSceneFile(const std::string& file, Console& console);

[[nodiscard]] Json findingsJson(const std::vector<Finding>& findings);
/// One line for each finding.
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
