#include "image/nrrd_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <limits>

#include "image/header_text.h"
#include "image/nrrd_fields.h"

namespace palpate::vdb {
namespace {

VoxelType voxelType(const NrrdFields& fields) {
  const std::string& name = fields.require("type");
  constexpr std::pair<std::string_view, VoxelType> kNames[] = {
      {"signed char", VoxelType::kInt8},
      {"int8", VoxelType::kInt8},
      {"int8_t", VoxelType::kInt8},
      {"uchar", VoxelType::kUint8},
      {"unsigned char", VoxelType::kUint8},
      {"uint8", VoxelType::kUint8},
      {"uint8_t", VoxelType::kUint8},
      {"short", VoxelType::kInt16},
      {"short int", VoxelType::kInt16},
      {"signed short", VoxelType::kInt16},
      {"signed short int", VoxelType::kInt16},
      {"int16", VoxelType::kInt16},
      {"int16_t", VoxelType::kInt16},
      {"ushort", VoxelType::kUint16},
      {"unsigned short", VoxelType::kUint16},
      {"unsigned short int", VoxelType::kUint16},
      {"uint16", VoxelType::kUint16},
      {"uint16_t", VoxelType::kUint16},
      {"int", VoxelType::kInt32},
      {"signed int", VoxelType::kInt32},
      {"int32", VoxelType::kInt32},
      {"int32_t", VoxelType::kInt32},
      {"uint", VoxelType::kUint32},
      {"unsigned int", VoxelType::kUint32},
      {"uint32", VoxelType::kUint32},
      {"uint32_t", VoxelType::kUint32},
      {"longlong", VoxelType::kInt64},
      {"long long", VoxelType::kInt64},
      {"long long int", VoxelType::kInt64},
      {"signed long long", VoxelType::kInt64},
      {"signed long long int", VoxelType::kInt64},
      {"int64", VoxelType::kInt64},
      {"int64_t", VoxelType::kInt64},
      {"ulonglong", VoxelType::kUint64},
      {"unsigned long long", VoxelType::kUint64},
      {"unsigned long long int", VoxelType::kUint64},
      {"uint64", VoxelType::kUint64},
      {"uint64_t", VoxelType::kUint64},
      {"float", VoxelType::kFloat32},
      {"double", VoxelType::kFloat64}};
  const std::string wanted = lowerCase(name);
  for (const auto& [known, type] : kNames) {
    if (known == wanted) return type;
  }
  throw fields.fail("nrrd.data_type", "type", "voxels of type '" + name + "' cannot be read",
                    "save the image with an integer or float type of 8 to 64 bits");
}

void readSizes(const NrrdFields& fields, NrrdHeader& out) {
  const auto dimension = numberIn<int>(fields.require("dimension"));
  const auto sizes = numbersIn<std::int64_t>(fields.require("sizes"));
  if (!dimension || !sizes || *dimension < 1 ||
      sizes->size() != static_cast<std::size_t>(*dimension)) {
    throw fields.fail("nrrd.dimensions", "sizes",
                      "sizes '" + fields.require("sizes") + "' are not those of " +
                          fields.require("dimension") + " dimensions");
  }
  for (const std::int64_t n : *sizes) {
    if (n < 1 || n > std::numeric_limits<int>::max()) {
      throw fields.fail("nrrd.dimensions", "sizes",
                        "the image is " + shapeText(*sizes) + " voxels, which cannot be");
    }
  }
  out.sizes = *sizes;
}

/// The vectors of `space directions`; nothing for an axis that is not in space.
std::vector<std::optional<Vec3>> readDirections(const NrrdFields& fields, std::size_t axes) {
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

std::vector<std::string> readKinds(const NrrdFields& fields, std::size_t axes) {
  std::vector<std::string> kinds;
  if (const std::string* text = fields.find("kinds")) {
    for (const std::string_view word : wordsOf(*text)) kinds.push_back(lowerCase(word));
    if (kinds.size() != axes) {
      throw fields.fail("nrrd.dimensions", "kinds",
                        "kinds '" + *text + "' are not those of " + std::to_string(axes) + " axes");
    }
  }
  return kinds;
}

/// Which axes lie in space, and which one does not.
void sortAxes(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
              NrrdHeader& out) {
  const std::vector<std::string> kinds = readKinds(fields, out.sizes.size());
  const std::string shape = shapeText(out.sizes);
  std::vector<std::size_t> spatial, other;
  for (std::size_t axis = 0; axis < out.sizes.size(); ++axis) {
    const bool in_space = !directions.empty() ? directions[axis].has_value()
                          : !kinds.empty()    ? kinds[axis] == "domain" || kinds[axis] == "space"
                                              : true;
    if (in_space) {
      spatial.push_back(axis);
    } else if (out.sizes[axis] > 1) {
      other.push_back(axis);
    }
  }
  if (spatial.size() != 3 || other.size() > 1) {
    throw fields.fail("nrrd.dimensions", "sizes",
                      "of the " + std::to_string(out.sizes.size()) + " axes (" + shape + ") " +
                          std::to_string(spatial.size()) +
                          " lie in space; three are needed, and one other at most",
                      "save one 3-D volume of single values");
  }
  std::copy(spatial.begin(), spatial.end(), out.spatial.begin());
  for (const std::size_t axis : spatial) {
    if (out.sizes[axis] < 2) {
      throw fields.fail("nrrd.dimensions", "sizes",
                        "the image is " + shape +
                            "; a 3-D image with at least two voxels along each axis is needed",
                        "an empty segmentation is saved as a single voxel");
    }
  }
  if (other.empty()) return;
  out.other = other.front();
  if (!kinds.empty()) out.other_kind = kinds[*out.other];
  const std::string& kind = out.other_kind;
  if (kind.find("color") != std::string::npos || kind.find("vector") != std::string::npos ||
      kind.find("matrix") != std::string::npos || kind == "complex" || kind == "quaternion" ||
      kind.find("normal") != std::string::npos || kind.find("gradient") != std::string::npos) {
    throw fields.fail("nrrd.data_type", "kinds",
                      "voxels of kind '" + kind + "' are not single numbers",
                      "save one number a voxel");
  }
}

/// [m] in the unit of space.
double metresPerUnit(const NrrdFields& fields, NrrdHeader& out) {
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
  for (const auto& [known, metres] : kUnits) {
    if (known != name) continue;
    out.length_unit = metres == 1e-6 ? "um" : name;
    return metres;
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
                        ? std::string("the header does not say which way its space runs")
                        : "the space '" + *space + "' is not an anatomical one",
                    "say it: space: RAS or space: LPS (on the command line --space RAS)");
}

Vec3 readOrigin(const NrrdFields& fields, std::vector<std::string>& notes) {
  const std::string* const text = fields.find("spaceorigin");
  if (text == nullptr) {
    notes.emplace_back(
        "the header has no space origin: the first voxel's centre is taken as 0, 0, 0");
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

/// Spacings along the three axes in space, whatever says them.
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
                      "spacings '" + fields.require("spacings") + "' are not those of " +
                          std::to_string(header.sizes.size()) + " axes");
  }
  for (int a = 0; a < 3; ++a) {
    spacing[a] = (*numbers)[header.spatial[static_cast<std::size_t>(a)]];
    if (!(spacing[a] > 0.0) || !std::isfinite(spacing[a])) {
      throw fields.fail("nrrd.spacing", "spacings",
                        "the spacing " + shortNumber(spacing[a]) + " is not greater than 0");
    }
  }
  return spacing;
}

void placeInSpace(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
                  const ImageOptions& options, NrrdHeader& out) {
  const double metres = metresPerUnit(fields, out);
  if (options.affine == AffineChoice::kSpacing) {
    const Vec3 spacing = readSpacings(fields, directions, out);
    for (int a = 0; a < 3; ++a) out.place.axes[a][a] = spacing[a] * metres;
    return;
  }
  if (directions.empty()) {
    throw fields.fail("nrrd.no_affine", "space",
                      "the header has no space directions, so nothing says where and which way "
                      "round the image lies",
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
    out.place.axes[a] = *directions[out.spatial[static_cast<std::size_t>(a)]] * sign * metres;
  }
  out.place.origin = readOrigin(fields, out.notes) * sign * metres;
  if (!isUsable(out.place)) {
    throw fields.fail("nrrd.singular", "spacedirections",
                      "the space directions are singular: they give the voxels no volume in space");
  }
}

NrrdEncoding encodingOf(const NrrdFields& fields) {
  const std::string name = lowerCase(fields.require("encoding"));
  if (name == "raw") return NrrdEncoding::kRaw;
  if (name == "gzip" || name == "gz") return NrrdEncoding::kGzip;
  if (name == "text" || name == "txt" || name == "ascii") return NrrdEncoding::kText;
  throw fields.fail("nrrd.encoding", "encoding", "the encoding '" + name + "' cannot be read",
                    "save the image with encoding raw or gzip");
}

void readByteOrder(const NrrdFields& fields, NrrdHeader& out) {
  if (bytesOf(out.coding.type) == 1 || out.encoding == NrrdEncoding::kText) return;
  const std::string* const endian = fields.find("endian");
  const std::string order = endian == nullptr ? "" : lowerCase(*endian);
  if (order != "little" && order != "big") {
    throw fields.fail("nrrd.endian", "endian",
                      endian == nullptr ? "the header does not say the byte order"
                                        : "the byte order '" + *endian + "' is not known",
                      "add endian: little or endian: big");
  }
  out.coding.swapped = (order == "little") != (std::endian::native == std::endian::little);
}

void findData(const NrrdFields& fields, NrrdHeader& out) {
  out.data_path = fields.path;
  out.data_begin = fields.end;
  if (const std::string* name = fields.find("datafile")) {
    if (lowerCase(*name).starts_with("list") || name->find('%') != std::string::npos) {
      throw fields.fail("nrrd.data_files", "datafile",
                        "the voxels are spread over several files (" + *name + ")",
                        "save the image with one data file");
    }
    out.data_path =
        (std::filesystem::path(fields.path).parent_path() / std::filesystem::path(*name)).string();
    out.data_begin = 0;
  } else if (!fields.has_end) {
    throw inputError("nrrd.truncated", "the file ends within its header",
                     "fetch or write the file again", fields.path);
  }
  const auto count = [&](const char* name, std::int64_t least) {
    const std::string* const text = fields.find(name);
    const auto value =
        text == nullptr ? std::optional<std::int64_t>(0) : numberIn<std::int64_t>(*text);
    if (!value || *value < least) {
      throw fields.fail("nrrd.field", name,
                        std::string(name) + " '" + *text + "' is not a number to skip");
    }
    return *value;
  };
  out.byte_skip = count("byteskip", -1);
  if (out.byte_skip < 0 && out.encoding != NrrdEncoding::kRaw) {
    throw fields.fail("nrrd.field", "byteskip", "byte skip -1 is for raw data only");
  }
  if (const std::int64_t lines = count("lineskip", 0); lines > 0) {
    std::ifstream file(out.data_path, std::ios::binary);
    file.seekg(static_cast<std::streamoff>(out.data_begin));
    std::string line;
    for (std::int64_t i = 0; i < lines && std::getline(file, line); ++i) {
    }
    if (file) out.data_begin = static_cast<std::uint64_t>(file.tellg());
  }
}

}  // namespace

NrrdHeader readNrrdHeader(const std::string& path, const ImageOptions& options) {
  const NrrdFields fields = readNrrdFields(path);
  NrrdHeader out;
  out.pairs = fields.pairs;
  out.coding.type = voxelType(fields);
  readSizes(fields, out);
  std::vector<std::optional<Vec3>> directions;
  if (fields.find("spacedirections") != nullptr)
    directions = readDirections(fields, out.sizes.size());
  sortAxes(fields, directions, out);
  out.encoding = encodingOf(fields);
  readByteOrder(fields, out);
  findData(fields, out);
  placeInSpace(fields, directions, options, out);
  return out;
}

}  // namespace palpate::vdb
