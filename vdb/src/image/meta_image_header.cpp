#include "image/meta_image_header.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <limits>
#include <map>

#include "image/header_text.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kLongestLine = std::size_t{1} << 20U;

class Fields {
 public:
  explicit Fields(const std::string& path) : path_(path) {
    // Refuses anything but a regular file
    const ByteStream whole(path, "metaimage", 0, Packing::kNone);
    std::ifstream file(path, std::ios::binary);
    std::string line;
    for (int number = 1; std::getline(file, line); ++number) {
      if (trimmed(line).empty()) continue;
      const std::size_t sign = line.find('=');
      if (sign == std::string::npos || line.size() > kLongestLine ||
          line.find('\0') != std::string::npos) {
        break;
      }
      const std::string key(trimmed(std::string_view(line).substr(0, sign)));
      const std::string value(trimmed(std::string_view(line).substr(sign + 1)));
      if (!values_.emplace(key, value).second) {
        throw failAt(number, "metaimage.field", "'" + key + "' is given twice");
      }
      lines_[key] = number;
      if (key == "ElementDataFile") {  // the last line, by the format's rule
        end_ = file.eof() ? whole.fileSize() : static_cast<std::uint64_t>(file.tellg());
        return;
      }
    }
    if (values_.contains("NDims") || values_.contains("ObjectType")) {
      throw inputError("metaimage.truncated", "the header ends without 'ElementDataFile'",
                       "fetch or write the file again", path_);
    }
    throw inputError(
        "metaimage.format",
        "this is not a MetaImage file: it does not begin with `NDims = 3` and the like",
        "such files end in .mha or .mhd", path_);
  }

  /// The first of these synonymous keys that the header has; empty: none.
  [[nodiscard]] std::string key(std::initializer_list<const char*> names) const {
    for (const char* name : names) {
      if (values_.contains(name)) return name;
    }
    return {};
  }
  [[nodiscard]] const std::string& value(const std::string& key) const {
    const auto at = values_.find(key);
    if (at != values_.end()) return at->second;
    throw inputError("metaimage.field", "the header has no '" + key + "'", "write the file again",
                     path_);
  }
  [[nodiscard]] Error fail(const char* code, const std::string& key, std::string message,
                           std::string hint = {}) const {
    const auto at = lines_.find(key);
    return failAt(at == lines_.end() ? 0 : at->second, code, std::move(message), std::move(hint));
  }
  template <typename Number>
  [[nodiscard]] std::vector<Number> numbers(const std::string& key, std::size_t count,
                                            const char* code) const {
    const auto list = numbersIn<Number>(value(key));
    if (!list || list->size() != count) {
      throw fail(code, key,
                 key + " is '" + value(key) + "', not " + std::to_string(count) +
                     (count == 1 ? " number" : " numbers"));
    }
    return *list;
  }
  [[nodiscard]] bool flag(std::initializer_list<const char*> names, bool otherwise) const {
    const std::string name = key(names);
    if (name.empty()) return otherwise;
    const std::string text = lowerCase(value(name));
    if (text == "true" || text == "t" || text == "1") return true;
    if (text == "false" || text == "f" || text == "0") return false;
    throw fail("metaimage.field", name, name + " is '" + value(name) + "', not True or False");
  }
  [[nodiscard]] std::uint64_t end() const noexcept { return end_; }

 private:
  [[nodiscard]] Error failAt(int line, const char* code, std::string message,
                             std::string hint = {}) const {
    Problem problem{code, std::move(message), std::move(hint), path_};
    problem.line = line;
    return Error(ErrorKind::kInput, std::move(problem));
  }

  const std::string& path_;
  std::map<std::string, std::string> values_;
  std::map<std::string, int> lines_;
  std::uint64_t end_ = 0;
};

Scalar voxelType(const Fields& fields) {
  const std::string& name = fields.value("ElementType");
  constexpr ScalarName kNames[] = {
      {"MET_CHAR", Scalar::kInt8},       {"MET_UCHAR", Scalar::kUint8},
      {"MET_SHORT", Scalar::kInt16},     {"MET_USHORT", Scalar::kUint16},
      {"MET_INT", Scalar::kInt32},       {"MET_UINT", Scalar::kUint32},
      {"MET_LONG", Scalar::kInt32},      {"MET_ULONG", Scalar::kUint32},
      {"MET_LONG_LONG", Scalar::kInt64}, {"MET_ULONG_LONG", Scalar::kUint64},
      {"MET_FLOAT", Scalar::kFloat32},   {"MET_DOUBLE", Scalar::kFloat64}};
  if (const auto kind = scalarCalled(name, kNames)) return *kind;
  throw fields.fail("metaimage.data_type", "ElementType",
                    "voxels of type '" + name + "' cannot be read",
                    "save the image with an integer or float type of 8 to 64 bits");
}

/// Returns the number of dimensions.
std::size_t readSize(const Fields& fields, const ImageOptions& options, MetaImageHeader& out) {
  const int dimensions = fields.numbers<int>("NDims", 1, "metaimage.dimensions").front();
  if (dimensions < 1 || dimensions > 10) {
    throw fields.fail("metaimage.dimensions", "NDims",
                      std::to_string(dimensions) + " dimensions cannot be");
  }
  const auto count = static_cast<std::size_t>(dimensions);
  const auto sizes = fields.numbers<std::int64_t>("DimSize", count, "metaimage.dimensions");
  const std::string shape = shapeText(sizes);
  for (const std::int64_t n : sizes) {
    if (n < 1 || n > std::numeric_limits<int>::max()) {
      throw fields.fail("metaimage.dimensions", "DimSize",
                        "the image is " + shape + " voxels, which cannot be");
    }
  }
  const bool flat = count < 3 || sizes[0] < 2 || sizes[1] < 2 || sizes[2] < 2;
  if (flat) {
    throw fields.fail("metaimage.dimensions", "DimSize",
                      "the image is " + shape +
                          "; a 3-D image with at least two voxels along each axis is needed");
  }
  for (std::size_t i = 4; i < count; ++i) {
    if (sizes[i] > 1) {
      throw fields.fail("metaimage.dimensions", "DimSize",
                        "the image has more than 4 dimensions (" + shape + ")",
                        "save the volume that you mean to a file of its own");
    }
  }
  for (std::size_t a = 0; a < 3; ++a) out.size[a] = static_cast<int>(sizes[a]);
  out.frames = count > 3 ? static_cast<int>(sizes[3]) : 1;
  if (out.frames > 1 && !options.frame) {
    throw fields.fail(
        "metaimage.dimensions", "DimSize",
        "the image has 4 dimensions (" + shape + "); one 3-D volume of single values is needed",
        "frame chooses one of the " + std::to_string(out.frames) +
            " volumes, from 0 (on the command line --frame 0)");
  }
  if (options.frame && (*options.frame < 0 || *options.frame >= out.frames)) {
    throw fields.fail(
        "metaimage.frame", "DimSize",
        "there is no frame " + std::to_string(*options.frame) + " in an image of " + shape,
        "frames are counted from 0");
  }
  if (const std::string key = fields.key({"ElementNumberOfChannels"});
      !key.empty() && fields.numbers<int>(key, 1, "metaimage.data_type").front() != 1) {
    throw fields.fail("metaimage.data_type", key,
                      "voxels of " + fields.value(key) + " channels are not single numbers",
                      "save one number a voxel");
  }
  return count;
}

/// Sets the place; LPS and mm, by the format's convention.
void placeInSpace(const Fields& fields, std::size_t dimensions, MetaImageHeader& out) {
  const std::string spacing_key = fields.key({"ElementSpacing", "ElementSize"});
  if (spacing_key.empty()) {
    throw fields.fail("metaimage.spacing", "DimSize", "the header has no 'ElementSpacing'",
                      "add ElementSpacing, in mm");
  }
  const auto spacing = fields.numbers<double>(spacing_key, dimensions, "metaimage.spacing");
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(spacing[a] > 0.0) || !std::isfinite(spacing[a])) {
      throw fields.fail("metaimage.spacing", spacing_key,
                        "the spacing " + shortNumber(spacing[a], 3) + " is not greater than 0",
                        "write a mirrored axis as a negative row of TransformMatrix");
    }
  }
  Place lps;
  const std::string matrix_key = fields.key({"TransformMatrix", "Rotation", "Orientation"});
  if (matrix_key.empty()) {
    out.notes.emplace_back("the header has no TransformMatrix: axes are taken as L, P, S");
  } else {
    // A row for each axis of the image: its direction.
    const auto m = fields.numbers<double>(matrix_key, dimensions * dimensions, "metaimage.matrix");
    for (std::size_t axis = 0; axis < 3; ++axis) {
      for (std::size_t x = 0; x < 3; ++x) {
        lps.axes[static_cast<int>(axis)][static_cast<int>(x)] = m[axis * dimensions + x];
      }
    }
    for (std::size_t i = 0; i < dimensions * dimensions; ++i) {
      const bool mixes = (i / dimensions < 3) != (i % dimensions < 3);
      if (mixes && m[i] != 0.0) {
        throw fields.fail("metaimage.matrix", matrix_key,
                          matrix_key + " mixes space and the fourth axis");
      }
    }
  }
  const std::string offset_key = fields.key({"Offset", "Origin", "Position"});
  if (offset_key.empty()) {
    out.notes.emplace_back(
        "the header has no Offset: the first voxel's center is taken as 0, 0, 0");
  } else {
    const auto offset = fields.numbers<double>(offset_key, dimensions, "metaimage.offset");
    lps.origin = {offset[0], offset[1], offset[2]};
  }
  for (int a = 0; a < 3; ++a) lps.axes[a] *= spacing[static_cast<std::size_t>(a)];
  if (!isUsable(lps)) {
    throw fields.fail("metaimage.singular", matrix_key,
                      "its place is singular: it gives the voxels no volume in space");
  }
  out.place = scaled(turned(lps), 1e-3);
  if (const std::string key = fields.key({"AnatomicalOrientation"}); !key.empty()) {
    // Letters name the side that an axis comes from: RAI runs towards L, P, S.
    std::string to = fields.value(key);
    for (char& c : to) {
      constexpr std::string_view kFrom = "RLAPSI";
      constexpr std::string_view kTo = "LRPAIS";
      const std::size_t at = kFrom.find(c);
      c = at == std::string_view::npos ? '?' : kTo[at];
    }
    const std::string matrix = orientationCodes(out.place.axes);
    if (to.find('?') == std::string::npos && to != matrix) {
      out.notes.push_back("AnatomicalOrientation says that the axes run to " + to +
                          ", the matrix to " + matrix + ": the matrix counts");
    }
  }
}

void findData(const Fields& fields, const std::string& path, MetaImageHeader& out) {
  const std::string& name = fields.value("ElementDataFile");
  if (name.starts_with("LIST") || name.find('%') != std::string::npos) {
    throw fields.fail("metaimage.data_files", "ElementDataFile",
                      "the voxels are spread over several files (" + name + ")",
                      "save the image with one data file");
  }
  const bool local = name == "LOCAL" || name == "Local" || name == "local";
  out.data_path =
      local ? path
            : (std::filesystem::path(path).parent_path() / std::filesystem::path(name)).string();
  out.data_begin = local ? fields.end() : 0;
  if (const std::string key = fields.key({"HeaderSize"}); !key.empty()) {
    const auto size = fields.numbers<std::int64_t>(key, 1, "metaimage.field").front();
    out.at_end = size < 0;
    if (size > 0) out.data_begin = static_cast<std::uint64_t>(size);
  }
  out.text = !fields.flag({"BinaryData"}, true);
  if (fields.flag({"CompressedData"}, false)) out.packing = Packing::kZlib;
  if (out.text && out.packing != Packing::kNone) {
    throw fields.fail("metaimage.field", "CompressedData", "text cannot be compressed",
                      "write the file again");
  }
  if (const std::string key = fields.key({"CompressedDataSize"}); !key.empty()) {
    out.compressed_bytes = fields.numbers<std::uint64_t>(key, 1, "metaimage.field").front();
  }
  const bool big = fields.flag({"BinaryDataByteOrderMSB", "ElementByteOrderMSB"}, false);
  out.coding.swapped = !out.text && big == (std::endian::native == std::endian::little) &&
                       bytesOf(out.coding.type) > 1;
}

void readScaling(const Fields& fields, MetaImageHeader& out) {
  const auto number = [&](const char* name, double otherwise) {
    const std::string key = fields.key({name});
    return key.empty() ? otherwise : fields.numbers<double>(key, 1, "metaimage.field").front();
  };
  out.coding.slope = number("ElementToIntensityFunctionSlope", 1.0);
  out.coding.intercept = number("ElementToIntensityFunctionOffset", 0.0);
  out.coding.scaled = out.coding.slope != 1.0 || out.coding.intercept != 0.0;
  if (out.coding.scaled) {
    out.notes.push_back("values are scaled as the header says: times " +
                        shortNumber(out.coding.slope, 3) + ", plus " +
                        shortNumber(out.coding.intercept, 3));
  }
}

}  // namespace

MetaImageHeader readMetaImageHeader(const std::string& path, const ImageOptions& options) {
  const Fields fields(path);
  if (const std::string key = fields.key({"ObjectType"});
      !key.empty() && fields.value(key) != "Image") {
    throw fields.fail("metaimage.format", key,
                      "this is a Meta" + fields.value(key) + ", not an image");
  }
  MetaImageHeader out;
  out.coding.type = voxelType(fields);
  const std::size_t dimensions = readSize(fields, options, out);
  placeInSpace(fields, dimensions, out);
  findData(fields, path, out);
  readScaling(fields, out);
  return out;
}

}  // namespace palpate::vdb
