#include "vdb/debian_scans.h"

#include <zlib.h>

#include <cstdlib>
#include <cstring>
#include <map>
#include <stdexcept>

#include "palpate/vdb/mesh.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb::test {
namespace {

const char* const kProject = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";

/// The file in a tar archive whose name ends in `name`; each file is preceded by a block of 512
/// bytes with its name, and its size in octal digits.
std::string fileOf(const std::string& tar, const std::string& name) {
  constexpr std::size_t kBlock = 512;
  for (std::size_t at = 0; at + kBlock <= tar.size() && tar[at] != '\0';) {
    const std::string entry = tar.substr(at, strnlen(tar.data() + at, 100));
    const std::size_t size = std::stoul(tar.substr(at + 124, 12), nullptr, 8);
    if (entry.ends_with("/" + name)) return tar.substr(at + kBlock, size);
    at += kBlock + (size + kBlock - 1) / kBlock * kBlock;
  }
  throw std::runtime_error(std::string(kProject) + " holds no " + name);
}

/// The numbers under `key` in a property list, up to the next key.
std::vector<double> numbersOf(const std::string& plist, const std::string& key) {
  const std::size_t from = plist.find("<key>" + key + "</key>");
  if (from == std::string::npos) throw std::runtime_error("no " + key + " in " + kProject);
  const std::size_t to = plist.find("<key>", from + 1);
  std::vector<double> numbers;
  for (std::size_t at = from; (at = plist.find('>', at + 1)) < to;) {
    const char* const text = plist.c_str() + at + 1;
    char* end = nullptr;
    const double number = std::strtod(text, &end);
    if (end != text && *end == '<') numbers.push_back(number);
  }
  return numbers;
}

}  // namespace

std::string mricron(const std::string& name) { return "/usr/share/mricron/templates/" + name; }

HeadCt readHeadCt() {
  const gzFile file = gzopen(kProject, "rb");
  if (file == nullptr) {
    throw std::runtime_error(std::string(kProject) +
                             " is absent; Debian's invesalius-examples has it");
  }
  std::string tar;
  std::vector<char> chunk(std::size_t{1} << 20);
  for (int got = 0; (got = gzread(file, chunk.data(), static_cast<unsigned>(chunk.size()))) > 0;) {
    tar.append(chunk.data(), static_cast<std::size_t>(got));
  }
  gzclose(file);

  HeadCt ct;
  const std::string main = fileOf(tar, "main.plist");
  const std::vector<double> shape = numbersOf(main, "shape");  // slices first
  const std::vector<double> spacing = numbersOf(main, "spacing");
  if (shape.size() != 3 || spacing.size() != 3) throw std::runtime_error("not three dimensions");
  for (std::size_t a = 0; a < 3; ++a) {
    ct.size[a] = static_cast<int>(shape[2 - a]);
    ct.spacing[a] = spacing[a];
  }
  const std::string voxels = fileOf(tar, "matrix.dat");
  ct.values.resize(voxels.size() / 2);
  std::memcpy(ct.values.data(), voxels.data(),
              voxels.size());  // the file is little endian, and so are the machines this runs on
  if (ct.values.size() != ct.index(0, 0, ct.size[2])) throw std::runtime_error("not all voxels");

  // A mask has one more voxel along each axis, at the front, for the program's own use.
  const std::string mask = fileOf(tar, "mask_0.dat");
  const std::size_t nx = static_cast<std::size_t>(ct.size[0]) + 1;
  const std::size_t ny = static_cast<std::size_t>(ct.size[1]) + 1;
  for (std::size_t k = 1; k <= static_cast<std::size_t>(ct.size[2]); ++k) {
    for (std::size_t j = 1; j < ny; ++j) {
      for (std::size_t i = 1; i < nx; ++i) {
        ct.mask.push_back(static_cast<std::uint8_t>(mask.at(i + nx * (j + ny * k))));
      }
    }
  }
  ct.lowest = numbersOf(fileOf(tar, "mask_0.plist"), "threshold_range").at(0);
  ct.surface_volume = numbersOf(fileOf(tar, "surface_0.plist"), "volume").at(0);
  return ct;
}

std::string writePart(const HeadCt& ct, const std::array<int, 3>& lo, const std::array<int, 3>& hi,
                      const palpate::testing::TempFolder& folder) {
  std::string raw;
  const std::array<int, 3> size = {hi[0] - lo[0] + 1, hi[1] - lo[1] + 1, hi[2] - lo[2] + 1};
  for (int k = lo[2]; k <= hi[2]; ++k) {
    for (int j = lo[1]; j <= hi[1]; ++j) {
      raw.append(reinterpret_cast<const char*>(&ct.values[ct.index(lo[0], j, k)]),
                 2 * static_cast<std::size_t>(size[0]));
    }
  }
  (void)folder.file("head.raw", raw);
  const auto three = [](const auto& numbers) {
    std::string text;
    for (const auto number : numbers) text += " " + std::to_string(number);
    return text;
  };
  return folder.file(
      "head.mhd",
      "ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = False\n"
      "CompressedData = False\nTransformMatrix = 1 0 0 0 1 0 0 0 1\nOffset = 0 0 0\n"
      "ElementSpacing =" +
          three(ct.spacing) + "\nDimSize =" + three(size) +
          "\nElementType = MET_SHORT\nElementDataFile = head.raw\n");
}

Image cropped(const Image& image, const std::array<int, 3>& lo, const std::array<int, 3>& hi) {
  Image part;
  part.source = image.source;
  part.axes = image.axes;
  part.origin = image.toWorld(Vec3(lo[0], lo[1], lo[2]));
  part.labels = image.labels;
  for (std::size_t a = 0; a < 3; ++a) part.size[a] = hi[a] - lo[a] + 1;
  for (int k = lo[2]; k <= hi[2]; ++k) {
    for (int j = lo[1]; j <= hi[1]; ++j) {
      for (int i = lo[0]; i <= hi[0]; ++i) part.values.push_back(image.at(i, j, k));
    }
  }
  return part;
}

Image deepBrain() {
  Image part = cropped(readImage(mricron("aal.nii.gz")), {55, 87, 60}, {90, 128, 90});
  std::map<float, int> voxels;
  for (const float label : part.values) ++voxels[label];
  for (float& label : part.values) label = voxels[label] < 100 ? 0.0F : label;
  return part;
}

Mesh nucleusMesh(int label) {
  return surfaceMesh(surfaceFromLabels(deepBrain(), {.values = {label}}, {}));
}

}  // namespace palpate::vdb::test
