#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <assimp/Importer.hpp>
#include <bit>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <unordered_map>

#include "palpate/core/error.h"
#include "palpate/vdb/mesh.h"

namespace palpate::vdb {
namespace {

struct BitsHash {
  std::size_t operator()(const std::array<std::uint64_t, 3>& key) const noexcept {
    std::uint64_t hash = 0;
    for (const std::uint64_t word : key) {
      hash = (hash ^ word) * 0x9E3779B97F4A7C15U;
      hash ^= hash >> 32;
    }
    return hash;
  }
};

/// Gives equal positions one number.
class Welder {
 public:
  explicit Welder(std::vector<Vec3>& vertices) : vertices_(vertices) {}

  std::uint32_t add(const Vec3& p) {
    // Adding zero turns -0 into +0, which are one position.
    const std::array<std::uint64_t, 3> key{std::bit_cast<std::uint64_t>(p.x + 0.0),
                                           std::bit_cast<std::uint64_t>(p.y + 0.0),
                                           std::bit_cast<std::uint64_t>(p.z + 0.0)};
    const auto [entry, is_new] =
        numbers_.try_emplace(key, static_cast<std::uint32_t>(vertices_.size()));
    if (is_new) vertices_.push_back(p);
    return entry->second;
  }

 private:
  std::vector<Vec3>& vertices_;
  std::unordered_map<std::array<std::uint64_t, 3>, std::uint32_t, BitsHash> numbers_;
};

/// Collects the meshes of a scene graph, each under the transforms above it.
class Collector {
 public:
  Collector(const aiScene& scene, double metres_per_unit, Mesh& mesh)
      : scene_(scene), metres_per_unit_(metres_per_unit), mesh_(mesh), welder_(mesh.vertices) {}

  void collect(const aiNode& node, const aiMatrix4x4& above) {
    const aiMatrix4x4 transform = above * node.mTransformation;
    for (unsigned i = 0; i < node.mNumMeshes; ++i) add(*scene_.mMeshes[node.mMeshes[i]], transform);
    for (unsigned i = 0; i < node.mNumChildren; ++i) collect(*node.mChildren[i], transform);
  }

 private:
  void add(const aiMesh& part, const aiMatrix4x4& m) {
    std::vector<std::uint32_t> numbers(part.mNumVertices);
    for (unsigned i = 0; i < part.mNumVertices; ++i) {
      const aiVector3D& v = part.mVertices[i];
      const Vec3 p(v.x, v.y, v.z);
      const Vec3 placed(Vec3(m.a1, m.b1, m.c1) * p.x + Vec3(m.a2, m.b2, m.c2) * p.y +
                        Vec3(m.a3, m.b3, m.c3) * p.z + Vec3(m.a4, m.b4, m.c4));
      if (!isFinite(placed)) {
        throw inputError("mesh.not_finite",
                         "vertex " + std::to_string(i) +
                             " (from 0) of the mesh is not a finite "
                             "point",
                         "repair the file", mesh_.source);
      }
      numbers[i] = welder_.add(placed * metres_per_unit_);
    }
    const bool mirrored = m.Determinant() < 0.0F;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      if (face.mNumIndices != 3) continue;  // points and lines
      for (unsigned corner = 0; corner < 3; ++corner) {
        if (face.mIndices[corner] >= part.mNumVertices) {
          throw inputError("mesh.index",
                           "face " + std::to_string(i) + " (from 0) names vertex " +
                               std::to_string(face.mIndices[corner]) + ", but there are only " +
                               std::to_string(part.mNumVertices),
                           "repair the file", mesh_.source);
        }
      }
      std::array<std::uint32_t, 3> triangle{numbers[face.mIndices[0]], numbers[face.mIndices[1]],
                                            numbers[face.mIndices[2]]};
      if (mirrored) std::swap(triangle[1], triangle[2]);
      addTriangle(triangle);
    }
  }

  /// A triangle with two corners in one point has no area, and its other two sides cancel. One with
  /// three corners in a line has no area either, but without it its neighbours would not meet.
  void addTriangle(const std::array<std::uint32_t, 3>& t) {
    if (t[0] == t[1] || t[1] == t[2] || t[2] == t[0]) {
      ++mesh_.dropped_triangles;
    } else {
      mesh_.triangles.push_back(t);
    }
  }

  const aiScene& scene_;
  double metres_per_unit_;
  Mesh& mesh_;
  Welder welder_;
};

void requireFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw inputError("mesh.missing", "there is no such file", "", path);
  }
  if (std::filesystem::is_directory(status)) {
    throw inputError("mesh.unreadable", "this is a folder, not a mesh", "", path);
  }
  if (!std::ifstream(path)) {
    throw inputError("mesh.unreadable", "the file cannot be opened for reading", "", path);
  }
}

}  // namespace

Mesh readMesh(const std::string& path, double metres_per_unit) {
  requireFile(path);
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, aiProcess_Triangulate);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    throw inputError("mesh.unreadable",
                     std::string("not a mesh that can be read: ") + importer.GetErrorString(),
                     "STL, OBJ, PLY, glTF and GLB are read", path);
  }
  Mesh mesh;
  mesh.source = path;
  Collector(*scene, metres_per_unit, mesh).collect(*scene->mRootNode, aiMatrix4x4());
  if (mesh.triangles.empty()) {
    throw inputError("mesh.no_faces", "the mesh has no triangles with an area", "", path);
  }
  return mesh;
}

}  // namespace palpate::vdb
