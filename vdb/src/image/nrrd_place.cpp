#include "image/nrrd_place.h"

#include <algorithm>
#include <cmath>
#include <string_view>

#include "image/header_text.h"
#include "palpate/core/text.h"

namespace palpate::vdb {
namespace {

/// [m] Size of one unit of the file's space.
double metersPerUnit(const NrrdFields& fields, NrrdHeader& out) {
  const std::string* text = fields.find("spaceunits");
  out.length_unit = "mm";
  if (text == nullptr) return 1e-3;
  std::string name;
  for (std::string_view word : wordsOf(*text)) {
    if (word.starts_with('"')) word.remove_prefix(1);
    if (word.ends_with('"')) word.remove_suffix(1);
    if (!name.empty() && name != word) {
      throw fields.fail("nrrd.unit", "spaceunits",
                        "the axes of space have different units: " + *text, "use mm for all");
    }
    name = word;
  }
  constexpr std::pair<std::string_view, double> kUnits[] = {
      {"mm", 1e-3}, {"m", 1.0}, {"cm", 1e-2}, {"um", 1e-6}, {"µm", 1e-6}};
  for (const auto& [known, meters] : kUnits) {
    if (known != name) continue;
    out.length_unit = meters == 1e-6 ? "um" : name;
    return meters;
  }
  throw fields.fail("nrrd.unit", "spaceunits", "the length unit " + *text + " is not known",
                    "m, cm, mm and um are");
}

/// Signs that turn the file's space into RAS.
Vec3 toRas(const NrrdFields& fields, Space chosen) {
  const std::string* const space = fields.find("space");
  const std::string name = space == nullptr ? "" : lowerCase(*space);
  if (name == "right-anterior-superior" || name == "ras") return Vec3(1.0);
  if (name == "left-anterior-superior" || name == "las") return {-1.0, 1.0, 1.0};
  if (name == "left-posterior-superior" || name == "lps") return {-1.0, -1.0, 1.0};
  if (name.ends_with("-time") || name == "rast" || name == "last" || name == "lpst") {
    throw fields.fail("nrrd.space", "space", "the space '" + *space + "' has four dimensions",
                      "save one 3-D volume");
  }
  if (chosen == Space::kRas) return Vec3(1.0);
  if (chosen == Space::kLps) return {-1.0, -1.0, 1.0};
  throw fields.fail("nrrd.space", "space",
                    space == nullptr
                        ? std::string("the header does not say which way the axes of its space run")
                        : "the space '" + *space + "' is not an anatomical one",
                    "say it: space: RAS or space: LPS (on the command line --space RAS)");
}

Vec3 readOrigin(const NrrdFields& fields, std::vector<std::string>& notes) {
  const std::string* const text = fields.find("spaceorigin");
  if (text == nullptr) {
    notes.emplace_back(
        "the header has no space origin: the first voxel's center is taken as 0, 0, 0");
    return Vec3(0.0);
  }
  std::string numbers = *text;
  for (char& c : numbers) {
    if (c == ',' || c == '(' || c == ')') c = ' ';
  }
  const auto v = numbersIn<double>(numbers);
  if (!v || v->size() != 3) {
    throw fields.fail("nrrd.origin", "spaceorigin",
                      "the space origin '" + *text + "' is not of three numbers");
  }
  return {(*v)[0], (*v)[1], (*v)[2]};
}

/// Spacings along the three spatial axes, from whichever field gives them.
Vec3 readSpacings(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
                  const NrrdHeader& header) {
  Vec3 spacing(0.0);
  if (!directions.empty()) {
    for (int a = 0; a < 3; ++a) {
      spacing[a] = glm::length(*directions[header.spatial[static_cast<std::size_t>(a)]]);
    }
    return spacing;
  }
  const auto numbers = numbersIn<double>(fields.require("spacings"));
  if (!numbers || numbers->size() != header.sizes.size()) {
    throw fields.fail("nrrd.spacing", "spacings",
                      "spacings '" + fields.require("spacings") +
                          "' are not one number for each of the " +
                          std::to_string(header.sizes.size()) + " axes");
  }
  for (int a = 0; a < 3; ++a) {
    spacing[a] = (*numbers)[header.spatial[static_cast<std::size_t>(a)]];
    if (!(spacing[a] > 0.0) || !std::isfinite(spacing[a])) {
      throw fields.fail("nrrd.spacing", "spacings",
                        "the spacing " + shortNumber(spacing[a], 3) + " is not greater than 0");
    }
  }
  return spacing;
}

}  // namespace

std::vector<std::optional<Vec3>> readNrrdDirections(const NrrdFields& fields, std::size_t axes) {
  const std::string& text = *fields.find("spacedirections");
  const auto wrong = [&](const std::string& what) {
    return fields.fail("nrrd.directions", "spacedirections",
                       what + " in space directions '" + text + "'",
                       "one `none` or `(x,y,z)` is needed for each axis");
  };
  std::vector<std::optional<Vec3>> out;
  std::string_view rest = text;
  while (!(rest = trimmed(rest)).empty()) {
    if (lowerCase(rest.substr(0, 4)) == "none") {
      out.emplace_back();
      rest.remove_prefix(4);
      continue;
    }
    const std::size_t close = rest.find(')');
    if (rest.front() != '(' || close == std::string_view::npos) throw wrong("something else");
    std::string numbers(rest.substr(1, close - 1));
    std::replace(numbers.begin(), numbers.end(), ',', ' ');
    const auto v = numbersIn<double>(numbers);
    if (!v || v->size() != 3) throw wrong("a vector that is not of three numbers");
    const Vec3 direction((*v)[0], (*v)[1], (*v)[2]);
    const bool none = std::isnan(direction.x) && std::isnan(direction.y) && std::isnan(direction.z);
    out.push_back(none ? std::nullopt : std::optional(direction));
    rest.remove_prefix(close + 1);
  }
  if (out.size() != axes) throw wrong(std::to_string(out.size()) + " entries");
  return out;
}

void placeNrrd(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
               const ImageOptions& options, NrrdHeader& out) {
  const double meters = metersPerUnit(fields, out);
  if (options.affine == AffineChoice::kSpacing) {
    const Vec3 spacing = readSpacings(fields, directions, out);
    for (int a = 0; a < 3; ++a) out.place.axes[a][a] = spacing[a] * meters;
    return;
  }
  if (directions.empty()) {
    throw fields.fail(
        "nrrd.no_affine", "space",
        "the header has no space directions, so the place and orientation of the image "
        "are not known",
        "if axes along R, A, S from 0 will do: affine: spacing (on the command line "
        "--affine spacing)");
  }
  if (fields.find("spacings") != nullptr) {
    throw fields.fail("nrrd.directions", "spacings",
                      "both space directions and spacings are given, and only one of them can hold",
                      "drop one of the two lines");
  }
  const Vec3 sign = toRas(fields, options.space);
  for (int a = 0; a < 3; ++a) {
    out.place.axes[a] = *directions[out.spatial[static_cast<std::size_t>(a)]] * sign * meters;
  }
  out.place.origin = readOrigin(fields, out.notes) * sign * meters;
  if (!isUsable(out.place)) {
    throw fields.fail("nrrd.singular", "spacedirections",
                      "the space directions are singular: they give the voxels no volume in space");
  }
}

}  // namespace palpate::vdb
