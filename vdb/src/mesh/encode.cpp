#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cstring>
#include <limits>
#include <string_view>
#include <unordered_map>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/vdb/mesh.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

static_assert(std::endian::native == std::endian::little, "all formats here are little endian");

class Bytes {
 public:
  template <typename T>
  void add(T value) {
    out_.append(reinterpret_cast<const char*>(&value), sizeof value);
  }
  void text(std::string_view text) { out_.append(text); }
  /// Writes as few digits as read back exactly.
  void number(double value) {
    char digits[32];
    const auto end = std::to_chars(digits, digits + sizeof digits, value);
    out_.append(digits, end.ptr);
  }
  void reserve(std::size_t size) { out_.reserve(size); }
  [[nodiscard]] std::size_t size() const { return out_.size(); }
  [[nodiscard]] std::string take() { return std::move(out_); }

 private:
  std::string out_;
};

/// The mesh as a file of floats holds it: vertices that coincide as floats become one, and
/// triangles with two corners at one place are left out. When a side shrinks to a point both its
/// triangles go, so that a closed mesh stays closed.
Mesh inFloats(const Mesh& mesh, double per_unit) {
  struct Hash {
    std::size_t operator()(const std::array<std::uint32_t, 3>& bits) const noexcept {
      std::uint64_t hash = 0;
      for (const std::uint32_t word : bits) {
        hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
        hash ^= hash >> 32;
      }
      return hash;
    }
  };
  Mesh out;
  out.source = mesh.source;
  std::unordered_map<std::array<std::uint32_t, 3>, std::uint32_t, Hash> numbers;
  numbers.reserve(mesh.vertices.size());
  std::vector<std::uint32_t> name;
  name.reserve(mesh.vertices.size());
  for (const Vec3& v : mesh.vertices) {
    std::array<std::uint32_t, 3> bits{};
    Vec3 place(0.0);
    for (int axis = 0; axis < 3; ++axis) {
      const float value = static_cast<float>(v[axis] / per_unit) + 0.0F;  // -0 and 0 are one place
      bits[static_cast<std::size_t>(axis)] = std::bit_cast<std::uint32_t>(value);
      place[axis] = value;
    }
    const auto number = static_cast<std::uint32_t>(out.vertices.size());
    const auto [at, is_new] = numbers.try_emplace(bits, number);
    if (is_new) out.vertices.push_back(place);
    name.push_back(at->second);
  }
  out.triangles.reserve(mesh.triangles.size());
  for (const auto& [i, j, k] : mesh.triangles) {
    const std::uint32_t a = name[i], b = name[j], c = name[k];
    if (a != b && b != c && c != a) out.triangles.push_back({a, b, c});
  }
  return out;
}

Vec3 corner(const Mesh& mesh, std::size_t triangle, std::size_t n) {
  return mesh.vertices[mesh.triangles[triangle][n]];
}

void addFloats(Bytes& out, const Vec3& v) {
  for (int axis = 0; axis < 3; ++axis) out.add(static_cast<float>(v[axis]));
}

std::string encodeStl(const Mesh& exact, double per_unit) {
  const Mesh mesh = inFloats(exact, per_unit);
  Bytes out;
  out.reserve(84 + 50 * mesh.triangles.size());
  std::string header = "palpate";  // must not begin with "solid", as ASCII files do
  header.resize(80, ' ');
  out.text(header);
  out.add(static_cast<std::uint32_t>(mesh.triangles.size()));
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    const Vec3 a = corner(mesh, t, 0), b = corner(mesh, t, 1), c = corner(mesh, t, 2);
    const Vec3 normal = glm::cross(b - a, c - a);
    const double length = glm::length(normal);
    addFloats(out, length > 0.0 ? normal / length : Vec3(0.0));
    for (const Vec3& v : {a, b, c}) addFloats(out, v);
    out.add(std::uint16_t{0});
  }
  return out.take();
}

std::string encodeObj(const Mesh& mesh, double per_unit) {
  Bytes out;
  out.text("# palpate\n");
  for (const Vec3& v : mesh.vertices) {
    out.text("v");
    for (int axis = 0; axis < 3; ++axis) {
      out.text(" ");
      out.number(v[axis] / per_unit);
    }
    out.text("\n");
  }
  for (const auto& triangle : mesh.triangles) {
    out.text("f");
    for (const std::uint32_t index : triangle) out.text(" " + std::to_string(index + 1));
    out.text("\n");
  }
  return out.take();
}

std::string encodePly(const Mesh& mesh, double per_unit) {
  Bytes out;
  out.text("ply\nformat binary_little_endian 1.0\ncomment palpate\nelement vertex " +
           std::to_string(mesh.vertices.size()) +
           "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
           std::to_string(mesh.triangles.size()) +
           "\nproperty list uchar int vertex_indices\nend_header\n");
  for (const Vec3& v : mesh.vertices) {
    for (int axis = 0; axis < 3; ++axis) out.add(v[axis] / per_unit);
  }
  for (const auto& triangle : mesh.triangles) {
    out.add(std::uint8_t{3});
    for (const std::uint32_t index : triangle) out.add(static_cast<std::int32_t>(index));
  }
  return out.take();
}

/// glTF 2.0, section 4.4 (binary): a header, a chunk of JSON padded with blanks, a chunk of data.
std::string encodeGlb(const Mesh& exact) {
  const Mesh mesh = inFloats(exact, 1.0);
  Vec3 lo(std::numeric_limits<double>::infinity()), hi = -lo;
  for (const Vec3& v : mesh.vertices) {
    // The bounds must be those of the written floats, to the last bit.
    for (int axis = 0; axis < 3; ++axis) {
      const double written = static_cast<float>(v[axis]);
      lo[axis] = std::min(lo[axis], written);
      hi[axis] = std::max(hi[axis], written);
    }
  }
  const std::string points = std::to_string(mesh.vertices.size());
  const std::string index_bytes = std::to_string(12 * mesh.triangles.size());
  const std::string point_bytes = std::to_string(12 * mesh.vertices.size());
  Bytes json;
  const auto vector = [&](const Vec3& v) {
    json.text("[");
    for (int axis = 0; axis < 3; ++axis) {
      if (axis > 0) json.text(",");
      json.number(v[axis]);
    }
    json.text("]");
  };
  json.text(
      R"({"asset":{"version":"2.0","generator":"palpate"},"scene":0,"scenes":[{"nodes":[0]}],)"
      R"("nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"indices":1}]}],)"
      R"("buffers":[{"byteLength":)");
  json.text(std::to_string(12 * (mesh.triangles.size() + mesh.vertices.size())));
  json.text(R"(}],"bufferViews":[{"buffer":0,"byteLength":)" + point_bytes +
            R"(,"target":34962},{"buffer":0,"byteOffset":)" + point_bytes + R"(,"byteLength":)" +
            index_bytes +
            R"(,"target":34963}],"accessors":[{"bufferView":0,"componentType":5126,)");
  json.text(R"("count":)" + points + R"(,"type":"VEC3","min":)");
  vector(lo);
  json.text(R"(,"max":)");
  vector(hi);
  json.text(R"(},{"bufferView":1,"componentType":5125,"type":"SCALAR","count":)" +
            std::to_string(3 * mesh.triangles.size()) + "}]}");
  std::string text = json.take();
  text.resize((text.size() + 3) / 4 * 4, ' ');

  const std::size_t data = 12 * (mesh.triangles.size() + mesh.vertices.size());
  Bytes out;
  out.reserve(28 + text.size() + data);
  out.text("glTF");
  out.add(std::uint32_t{2});
  out.add(static_cast<std::uint32_t>(28 + text.size() + data));
  out.add(static_cast<std::uint32_t>(text.size()));
  out.text("JSON");
  out.text(text);
  out.add(static_cast<std::uint32_t>(data));
  out.text(std::string_view("BIN\0", 4));
  for (const Vec3& v : mesh.vertices) addFloats(out, v);
  for (const auto& triangle : mesh.triangles) {
    for (const std::uint32_t index : triangle) out.add(index);
  }
  return out.take();
}

}  // namespace

MeshFormat meshFormat(const std::string& path) {
  const std::string extension = extensionOf(path);
  if (extension == ".stl") return MeshFormat::kStl;
  if (extension == ".obj") return MeshFormat::kObj;
  if (extension == ".ply") return MeshFormat::kPly;
  if (extension == ".glb") return MeshFormat::kGlb;
  throw inputError("mesh.format", "no mesh format is called " + extension,
                   "meshes are written as .stl, .obj, .ply or .glb", path);
}

std::string encodeMesh(const Mesh& mesh, MeshFormat format, double meters_per_unit) {
  if (mesh.triangles.empty()) {
    throw inputError("mesh.no_faces", "there is no triangle to write", "", mesh.source);
  }
  constexpr std::size_t kMost = std::numeric_limits<std::uint32_t>::max() / 64;
  if (mesh.triangles.size() > kMost || mesh.vertices.size() > kMost) {
    throw inputError(
        "mesh.too_large", "a mesh of " + std::to_string(mesh.triangles.size()) + " triangles",
        "at most " + std::to_string(kMost) + " are written; take larger voxels", mesh.source);
  }
  switch (format) {
    case MeshFormat::kStl:
      return encodeStl(mesh, meters_per_unit);
    case MeshFormat::kObj:
      return encodeObj(mesh, meters_per_unit);
    case MeshFormat::kPly:
      return encodePly(mesh, meters_per_unit);
    case MeshFormat::kGlb:
      break;
  }
  return encodeGlb(mesh);
}

}  // namespace palpate::vdb
