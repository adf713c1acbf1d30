#include <cstring>
#include <optional>
#include <string_view>

#include "mesh/builder.h"
#include "mesh/scanner.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kHeaderBytes = 80 + 4;
constexpr std::size_t kTriangleBytes = 50;

Mesh readBinary(const std::string& bytes, const std::string& path, double meters_per_unit) {
  MeshBuilder builder(path, meters_per_unit);
  for (std::size_t at = kHeaderBytes; at < bytes.size(); at += kTriangleBytes) {
    std::array<std::uint32_t, 3> corners{};
    for (std::size_t corner = 0; corner < 3; ++corner) {
      float p[3];  // the normal before them is ignored: the corners give it more accurately
      std::memcpy(p, bytes.data() + at + 12 * (corner + 1), sizeof p);
      corners[corner] = builder.addVertex(Vec3(p[0], p[1], p[2]), [&] {
        return "corner " + std::to_string(corner) + " of triangle " +
               std::to_string((at - kHeaderBytes) / kTriangleBytes) + " (from 0)";
      });
    }
    builder.addPolygon(corners);
  }
  return builder.take();
}

class AsciiStl {
 public:
  AsciiStl(std::string_view text, const std::string& path, double meters_per_unit)
      : scanner_{text}, path_(path), builder_(path, meters_per_unit) {}

  Mesh read() {
    std::vector<std::uint32_t> corners;
    bool in_solid = false;
    for (std::string_view word = scanner_.word(); !word.empty(); word = scanner_.word()) {
      if (word == "solid") {
        in_solid = true;
        scanner_.skipLine();
      } else if (word == "endsolid") {
        in_solid = false;
        scanner_.skipLine();
      } else if (word == "facet") {
        corners.clear();
        scanner_.skipLine();
      } else if (word == "vertex") {
        corners.push_back(readVertex());
      } else if (word == "endfacet") {
        if (corners.size() != 3) {
          refuse("a facet has " + std::to_string(corners.size()) + " vertices");
        }
        builder_.addPolygon(corners);
      } else if (word != "outer" && word != "loop" && word != "endloop") {
        refuse("'" + std::string(word.substr(0, 40)) + "' means nothing in an STL file");
      }
    }
    if (in_solid) refuse("the file ends before 'endsolid'; it was cut short");
    return builder_.take();
  }

 private:
  [[noreturn]] void refuse(const std::string& what) const {
    throw Error(ErrorKind::kInput,
                {"mesh.unreadable", what, "export the mesh again", path_, scanner_.line});
  }

  std::uint32_t readVertex() {
    Vec3 p(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const std::string_view word = scanner_.word();
      if (word.empty()) refuse("the file ends within a vertex; it was cut short");
      const std::optional<double> value = numberOf(word);
      if (!value) refuse("'" + std::string(word.substr(0, 40)) + "' is not a number");
      // Coordinates of STL are single precision; printed digits beyond that are noise, which would
      // keep equal corners from being welded.
      p[axis] = static_cast<double>(static_cast<float>(*value));
    }
    return builder_.addVertex(
        p, [] { return "a vertex"; }, scanner_.line);
  }

  Scanner scanner_;
  const std::string& path_;
  MeshBuilder builder_;
};

}  // namespace

Mesh readStl(const std::string& path, double meters_per_unit) {
  const std::string bytes = readBytes(path);
  std::uint32_t count = 0;
  if (bytes.size() >= kHeaderBytes) std::memcpy(&count, bytes.data() + 80, sizeof count);
  const std::size_t wanted = kHeaderBytes + kTriangleBytes * static_cast<std::size_t>(count);
  if (bytes.size() >= kHeaderBytes && bytes.size() == wanted) {
    return readBinary(bytes, path, meters_per_unit);
  }
  const std::size_t word = bytes.find_first_not_of(" \t\r\n");
  const bool is_text = word != std::string::npos && bytes.compare(word, 5, "solid") == 0 &&
                       bytes.find('\0') == std::string::npos;
  if (is_text) return AsciiStl(bytes, path, meters_per_unit).read();
  if (bytes.size() < kHeaderBytes) {
    throw inputError("mesh.unreadable",
                     "this is not an STL file: it has " + std::to_string(bytes.size()) +
                         " bytes and does not begin with 'solid'",
                     "", path);
  }
  throw inputError("mesh.truncated",
                   "the file has " + std::to_string(bytes.size()) + " bytes, but " +
                       std::to_string(count) + " triangles of a binary STL file take " +
                       std::to_string(wanted),
                   "it was cut short or is not an STL file; copy or export it again", path);
}

}  // namespace palpate::vdb
