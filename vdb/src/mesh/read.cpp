#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/DefaultLogger.hpp>
#include <assimp/Importer.hpp>
#include <assimp/LogStream.hpp>
#include <filesystem>
#include <fstream>
#include <mutex>
#include <system_error>

#include "child/child.h"
#include "mesh/builder.h"
#include "mesh/gltf_guard.h"
#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

/// Assimp drops faces whose indices are out of range and only writes that to its log, of which
/// there is one for the process.
class DroppedFaces final : public Assimp::LogStream {
 public:
  DroppedFaces() : lock_(mutex()), created_(Assimp::DefaultLogger::isNullLogger()) {
    if (created_) {
      Assimp::DefaultLogger::create(nullptr, Assimp::Logger::NORMAL, 0);
    }
    Assimp::DefaultLogger::get()->attachStream(this, Assimp::Logger::Warn | Assimp::Logger::Err);
  }
  ~DroppedFaces() override {
    Assimp::DefaultLogger::get()->detachStream(this, Assimp::Logger::Warn | Assimp::Logger::Err);
    if (created_) Assimp::DefaultLogger::kill();
  }
  DroppedFaces(const DroppedFaces&) = delete;
  DroppedFaces& operator=(const DroppedFaces&) = delete;

  void write(const char* message) override {
    if (std::string_view(message).find("out-of-range") != std::string_view::npos) seen_ = true;
  }
  [[nodiscard]] bool seen() const noexcept { return seen_; }

 private:
  static std::mutex& mutex() {
    static std::mutex one;
    return one;
  }

  std::lock_guard<std::mutex> lock_;
  bool created_;
  bool seen_ = false;
};

/// Collects the meshes of a scene graph, each with the transforms above it applied.
class Collector {
 public:
  Collector(const aiScene& scene, const std::string& path, MeshBuilder& builder)
      : scene_(scene), path_(path), builder_(builder) {}

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
      const auto where = [&] { return "vertex " + std::to_string(i) + " (from 0)"; };
      numbers[i] = builder_.addVertex(isFinite(p) ? placed : p, where);
    }
    const bool mirrored = m.Determinant() < 0.0F;
    for (unsigned i = 0; i < part.mNumFaces; ++i) {
      const aiFace& face = part.mFaces[i];
      std::vector<std::uint32_t> corners;
      for (unsigned corner = 0; corner < face.mNumIndices; ++corner) {
        if (face.mIndices[corner] >= part.mNumVertices) {
          refuseIndex(path_, i, face.mIndices[corner], part.mNumVertices);
        }
        corners.push_back(numbers[face.mIndices[corner]]);
      }
      if (mirrored) std::reverse(corners.begin(), corners.end());
      builder_.addPolygon(corners);
    }
  }

  const aiScene& scene_;
  const std::string& path_;
  MeshBuilder& builder_;
};

Mesh parseWithAssimp(const std::string& path, double meters_per_unit) {
  const DroppedFaces dropped;
  Assimp::Importer importer;
  const aiScene* scene = importer.ReadFile(path, 0);
  if (scene == nullptr || scene->mRootNode == nullptr) {
    const std::string reason = importer.GetErrorString();
    const bool index = reason.find("index") != std::string::npos;
    throw inputError(index ? "mesh.index" : "mesh.unreadable",
                     "not a mesh that can be read: " + reason,
                     index ? "the file is damaged or was written wrongly; export the mesh again"
                           : "STL, OBJ, PLY, VTK polydata, glTF and GLB are read",
                     path);
  }
  if (dropped.seen()) {
    throw inputError("mesh.index", "some faces name vertices that are not there",
                     "the file is damaged or was written wrongly; export the mesh again", path);
  }
  MeshBuilder builder(path, meters_per_unit);
  Collector(*scene, path, builder).collect(*scene->mRootNode, aiMatrix4x4());
  return builder.take();
}

void put(ChildWriter& out, const Mesh& mesh) {
  out.put(mesh.source);
  out.put(mesh.vertices);
  out.put(mesh.triangles);
  out.put(mesh.dropped_triangles);
}

Mesh takeMesh(ChildReader& in) {
  Mesh mesh;
  mesh.source = in.takeText();
  mesh.vertices = in.takeAll<Vec3>();
  mesh.triangles = in.takeAll<std::array<std::uint32_t, 3>>();
  mesh.dropped_triangles = in.take<std::size_t>();
  return mesh;
}

Mesh readWithAssimp(const std::string& path, double meters_per_unit) {
  if (!libraryLimits().in_child) return parseWithAssimp(path, meters_per_unit);
  const ChildTask task{std::filesystem::file_size(path), "mesh.unreadable", "Assimp",
                       "the file may be damaged; export the mesh again, as STL, OBJ or PLY", path};
  ChildReader result =
      runInChild(task, [&](ChildWriter& out) { put(out, parseWithAssimp(path, meters_per_unit)); });
  return takeMesh(result);
}

std::ifstream openFile(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status)) {
    throw inputError("mesh.missing", "there is no such file", "", path);
  }
  if (std::filesystem::is_directory(status)) {
    throw inputError("mesh.unreadable", "this is a folder, not a mesh", "", path);
  }
  if (!std::filesystem::is_regular_file(status)) {  // a pipe has no length
    throw inputError("mesh.unreadable", "this is not a file", "write the mesh to a file first",
                     path);
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw inputError("mesh.unreadable", "the file cannot be opened for reading", "", path);
  }
  return stream;
}

}  // namespace

std::string readBytes(const std::string& path) {
  std::ifstream stream = openFile(path);
  std::string bytes(std::filesystem::file_size(path), '\0');
  stream.read(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  if (!stream) throw inputError("mesh.unreadable", "the file cannot be read to its end", "", path);
  return bytes;
}

namespace {

// STL, OBJ and PLY are read by our own code: Assimp 5.2.5 accepts some files that were cut short,
// crashes on others, and cannot say which line is wrong.
Mesh readAsItIs(const std::string& path, double meters_per_unit) {
  const std::string extension = extensionOf(path);
  if (extension == ".stl") return readStl(path, meters_per_unit);
  if (extension == ".ply") return readPly(path, meters_per_unit);
  if (extension == ".obj") return readObj(path, meters_per_unit);
  if (extension == ".vtk") return readVtk(path, meters_per_unit);
  openFile(path);
  if (extension == ".gltf" || extension == ".glb") checkGltf(readBytes(path), extension, path);
  return readWithAssimp(path, meters_per_unit);
}

}  // namespace

std::string prescribedUnit(const std::string& path) {
  const std::string extension = extensionOf(path);
  return extension == ".gltf" || extension == ".glb" ? "m" : "";
}

Mesh readMesh(const std::string& path, double meters_per_unit, Space space) {
  Mesh mesh = readAsItIs(path, meters_per_unit);
  const Space stated = statedSpace(path);
  mesh.space_is_stated = space == Space::kStated && stated != Space::kStated;
  mesh.space = space != Space::kStated ? space : stated == Space::kLps ? stated : Space::kRas;
  if (mesh.space == Space::kLps) {
    for (Vec3& v : mesh.vertices) v = {-v.x, -v.y, v.z};
  }
  return mesh;
}

}  // namespace palpate::vdb
