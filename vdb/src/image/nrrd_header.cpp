#include "image/nrrd_header.h"

#include <algorithm>
#include <bit>
#include <filesystem>
#include <fstream>
#include <limits>

#include "image/header_text.h"
#include "image/nrrd_fields.h"
#include "image/nrrd_place.h"

namespace palpate::vdb {
namespace {

Scalar voxelType(const NrrdFields& fields) {
  const std::string& name = fields.require("type");
  constexpr ScalarName kNames[] = {{"signed char", Scalar::kInt8},
                                   {"int8", Scalar::kInt8},
                                   {"int8_t", Scalar::kInt8},
                                   {"uchar", Scalar::kUint8},
                                   {"unsigned char", Scalar::kUint8},
                                   {"uint8", Scalar::kUint8},
                                   {"uint8_t", Scalar::kUint8},
                                   {"short", Scalar::kInt16},
                                   {"short int", Scalar::kInt16},
                                   {"signed short", Scalar::kInt16},
                                   {"signed short int", Scalar::kInt16},
                                   {"int16", Scalar::kInt16},
                                   {"int16_t", Scalar::kInt16},
                                   {"ushort", Scalar::kUint16},
                                   {"unsigned short", Scalar::kUint16},
                                   {"unsigned short int", Scalar::kUint16},
                                   {"uint16", Scalar::kUint16},
                                   {"uint16_t", Scalar::kUint16},
                                   {"int", Scalar::kInt32},
                                   {"signed int", Scalar::kInt32},
                                   {"int32", Scalar::kInt32},
                                   {"int32_t", Scalar::kInt32},
                                   {"uint", Scalar::kUint32},
                                   {"unsigned int", Scalar::kUint32},
                                   {"uint32", Scalar::kUint32},
                                   {"uint32_t", Scalar::kUint32},
                                   {"longlong", Scalar::kInt64},
                                   {"long long", Scalar::kInt64},
                                   {"long long int", Scalar::kInt64},
                                   {"signed long long", Scalar::kInt64},
                                   {"signed long long int", Scalar::kInt64},
                                   {"int64", Scalar::kInt64},
                                   {"int64_t", Scalar::kInt64},
                                   {"ulonglong", Scalar::kUint64},
                                   {"unsigned long long", Scalar::kUint64},
                                   {"unsigned long long int", Scalar::kUint64},
                                   {"uint64", Scalar::kUint64},
                                   {"uint64_t", Scalar::kUint64},
                                   {"float", Scalar::kFloat32},
                                   {"double", Scalar::kFloat64}};
  if (const auto kind = scalarCalled(lowerCase(name), kNames)) return *kind;
  throw fields.fail("nrrd.data_type", "type", "voxels of type '" + name + "' cannot be read",
                    "save the image with an integer or float type of 8 to 64 bits");
}

void readSizes(const NrrdFields& fields, NrrdHeader& out) {
  const auto dimension = numberIn<int>(fields.require("dimension"));
  const auto sizes = numbersIn<std::int64_t>(fields.require("sizes"));
  if (!dimension || !sizes || *dimension < 1 ||
      sizes->size() != static_cast<std::size_t>(*dimension)) {
    throw fields.fail("nrrd.dimensions", "sizes",
                      "sizes '" + fields.require("sizes") +
                          "' are not one whole number for each of the " +
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

std::vector<std::string> readKinds(const NrrdFields& fields, std::size_t axes) {
  std::vector<std::string> kinds;
  if (const std::string* text = fields.find("kinds")) {
    for (const std::string_view word : wordsOf(*text)) kinds.push_back(lowerCase(word));
    if (kinds.size() != axes) {
      throw fields.fail(
          "nrrd.dimensions", "kinds",
          "kinds '" + *text + "' are not one for each of the " + std::to_string(axes) + " axes");
    }
  }
  return kinds;
}

/// Finds the axes that are spatial, and the one that is not.
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
                      std::to_string(spatial.size()) + " of the " +
                          std::to_string(out.sizes.size()) + " axes (" + shape +
                          ") lie in space; three must, and at most one other axis is allowed",
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
    directions = readNrrdDirections(fields, out.sizes.size());
  sortAxes(fields, directions, out);
  out.encoding = encodingOf(fields);
  readByteOrder(fields, out);
  findData(fields, out);
  placeNrrd(fields, directions, options, out);
  return out;
}

}  // namespace palpate::vdb
