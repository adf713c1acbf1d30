// Reading and checking meshes, good ones and bad ones.

#include "palpate/vdb/mesh.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <numbers>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "support/scan_folder.h"
#include "support/temp_file.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::testing::TempFolder;

/// The corner of a cube: four vertices, four faces, volume 1/6.
const std::vector<std::array<float, 3>> kCorners{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
const std::vector<std::array<int, 3>> kFaces{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}};

template <typename Type>
void put(std::string& bytes, Type value, bool swap = false) {
  char raw[sizeof value];
  std::memcpy(raw, &value, sizeof value);
  if (swap) std::reverse(raw, raw + sizeof raw);
  bytes.append(raw, sizeof raw);
}

std::string binaryStl(const std::string& header = "a header") {
  std::string bytes = header;
  bytes.resize(80, ' ');
  put(bytes, static_cast<std::uint32_t>(kFaces.size()));
  for (const auto& face : kFaces) {
    for (int i = 0; i < 3; ++i) put(bytes, 0.0F);
    for (const int corner : face) {
      for (const float x : kCorners[static_cast<std::size_t>(corner)]) put(bytes, x);
    }
    put(bytes, std::uint16_t{0});
  }
  return bytes;
}

std::string asciiStl(const std::string& second_vertex = "1 0 0") {
  const std::array<std::string, 4> points{"0 0 0", second_vertex, "0 1 0", "0 0 1.0e0"};
  std::string text = "solid corner of a cube\n";
  for (const auto& face : kFaces) {
    text += "facet normal 0 0 0\n outer loop\n";
    for (const int corner : face) {
      text += "  vertex " + points[static_cast<std::size_t>(corner)] + "\n";
    }
    text += " endloop\nendfacet\n";
  }
  return text + "endsolid corner of a cube\n";
}

std::string obj(const std::string& last_face = "f 3 1 4") {
  return "# a comment\nv 0 0 0\nv 1 0 0 0.5\nv 0 1 0\nvn 0 0 1\nv +0 0 1\ng part\n"
         "f 1 3 2\nf 1//1 2//1 4//1\nf -3 -2 -1\n" +
         last_face + "\n";
}

std::string plyHeader(const std::string& format, int vertices, int faces) {
  return "ply\nformat " + format + " 1.0\ncomment made by a test\nelement vertex " +
         std::to_string(vertices) +
         "\nproperty uchar red\nproperty float x\nproperty float y\nproperty double z\n"
         "element face " +
         std::to_string(faces) +
         "\nproperty list uchar int vertex_indices\nproperty list uchar float texcoord\n"
         "end_header\n";
}

std::string binaryPly(bool big_endian, int last_index = 3) {
  std::string bytes = plyHeader(big_endian ? "binary_big_endian" : "binary_little_endian", 4, 4);
  for (const auto& [x, y, z] : kCorners) {
    put(bytes, std::uint8_t{7});
    put(bytes, x, big_endian);
    put(bytes, y, big_endian);
    put(bytes, static_cast<double>(z), big_endian);
  }
  for (const auto& [a, b, c] : kFaces) {
    put(bytes, std::uint8_t{3});
    put(bytes, a, big_endian);
    put(bytes, b, big_endian);
    put(bytes, &c == &kFaces.back()[2] ? last_index : c, big_endian);
    put(bytes, std::uint8_t{1});
    put(bytes, 0.5F, big_endian);
  }
  return bytes;
}

std::string asciiPly(const std::string& second_vertex = "255 1 0 0",
                     const std::string& last_face = "3 2 0 3 0", int faces = 4) {
  return plyHeader("ascii", 4, faces) + "255 0 0 0\n" + second_vertex +
         "\n255 0 1 0\n255 0 0 1\n3 0 2 1 0\n3 0 1 3 0\n3 1 2 3 0\n" + last_face + "\n";
}

/// glTF of the corner, in one node; `node` holds further properties of the node.
std::string gltf(const std::string& node, int last_index = 3) {
  std::string bytes;
  for (const auto& [a, b, c] : kFaces) {
    put(bytes, static_cast<std::uint16_t>(a));
    put(bytes, static_cast<std::uint16_t>(b));
    put(bytes, static_cast<std::uint16_t>(&c == &kFaces.back()[2] ? last_index : c));
  }
  for (const auto& corner : kCorners) {
    for (const float x : corner) put(bytes, x);
  }
  const std::string letters = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string base64;
  for (std::size_t i = 0; i + 2 < bytes.size(); i += 3) {  // 72 bytes: no padding
    unsigned word = 0;
    for (std::size_t k = 0; k < 3; ++k) word = word << 8 | static_cast<std::uint8_t>(bytes[i + k]);
    for (int shift = 18; shift >= 0; shift -= 6) base64 += letters[word >> shift & 63U];
  }
  return R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0)" +
         node +
         R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":1},"indices":0}]}],)"
         R"("buffers":[{"byteLength":72,"uri":"data:application/octet-stream;base64,)" +
         base64 +
         R"("}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":24},)"
         R"({"buffer":0,"byteOffset":24,"byteLength":48}],"accessors":[)"
         R"({"bufferView":0,"componentType":5123,"count":12,"type":"SCALAR"},)"
         R"({"bufferView":1,"componentType":5126,"count":4,"type":"VEC3",)"
         R"("min":[0,0,0],"max":[1,1,1]}]})";
}

void expectCorner(const std::string& path, double scale = 1.0, const Vec3& at = Vec3(0.0)) {
  const Mesh mesh = readMesh(path, 1e-3);
  EXPECT_EQ(mesh.source, path);
  EXPECT_EQ(mesh.vertices.size(), 4U) << path;
  EXPECT_EQ(mesh.triangles.size(), 4U) << path;
  const MeshReport report = checkMesh(mesh);
  EXPECT_TRUE(report.isClosed()) << path;
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.flipped_edges, 0U);
  EXPECT_NEAR(report.volume, scale * scale * scale * 1e-9 / 6.0, 1e-15) << path;
  EXPECT_NEAR(glm::distance(report.bounds.lo, 1e-3 * at), 0.0, 1e-12) << path;
  EXPECT_NEAR(report.bounds.hi.x, 1e-3 * (at.x + scale), 1e-12) << path;
}

TEST(ReadMesh, EveryFormatGivesTheSameMesh) {
  const TempFolder folder;
  expectCorner(folder.file("a.stl", binaryStl()));
  expectCorner(folder.file("solid.stl", binaryStl("solid it says, but is binary")));
  expectCorner(folder.file("text.STL", asciiStl()));
  expectCorner(folder.file("a.obj", obj()));
  expectCorner(folder.file("little.ply", binaryPly(false)));
  expectCorner(folder.file("big.ply", binaryPly(true)));
  expectCorner(folder.file("text.ply", asciiPly()));
  expectCorner(folder.file("a.gltf", gltf("")));
}

TEST(ReadMesh, NodesPlaceTheirMeshes) {
  const TempFolder folder;
  expectCorner(folder.file("moved.gltf", gltf(R"(,"scale":[2,2,2],"translation":[10,20,30])")), 2.0,
               Vec3(10, 20, 30));
  // Mirrored: the triangles must be reversed, or the volume would be negative.
  const Mesh mesh = readMesh(folder.file("mirror.gltf", gltf(R"(,"scale":[-1,1,1])")), 1.0);
  EXPECT_NEAR(checkMesh(mesh).volume, 1.0 / 6.0, 1e-12);
}

TEST(ReadMesh, PolygonsAreCutIntoTriangles) {
  const TempFolder folder;
  // A cube of quads, and a prism over an L, whose faces are not convex.
  const Mesh cube = readMesh(
      folder.file("cube.obj",
                  "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nv 1 0 1\nv 1 1 1\nv 0 1 1\n"
                  "f 4 3 2 1\nf 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8\n"),
      1.0);
  EXPECT_EQ(cube.triangles.size(), 12U);
  EXPECT_DOUBLE_EQ(checkMesh(cube).volume, 1.0);
  EXPECT_TRUE(checkMesh(cube).isClosed());

  std::string text;
  const std::vector<std::array<int, 2>> outline{{0, 0}, {3, 0}, {3, 1}, {1, 1}, {1, 3}, {0, 3}};
  for (const int z : {0, 2}) {
    for (const auto& [x, y] : outline) {
      text += "v " + std::to_string(x) + " " + std::to_string(y) + " " + std::to_string(z) + "\n";
    }
  }
  // The caps begin at a corner from which a fan of triangles would leave the L.
  text += "f 3 2 1 6 5 4\nf 9 10 11 12 7 8\n";
  for (int i = 1; i <= 6; ++i) {
    const int next = i % 6 + 1;
    text += "f " + std::to_string(i) + " " + std::to_string(next) + " " + std::to_string(next + 6) +
            " " + std::to_string(i + 6) + "\n";
  }
  const Mesh prism = readMesh(folder.file("prism.obj", text), 1.0);
  EXPECT_EQ(prism.triangles.size(), 2U * 4U + 6U * 2U);
  EXPECT_TRUE(checkMesh(prism).isClosed());
  EXPECT_DOUBLE_EQ(checkMesh(prism).volume, 10.0);
  // Every triangle of a cap lies in it: their areas add up to that of the L.
  double cap = 0.0;
  for (const auto& [a, b, c] : prism.triangles) {
    const Vec3 normal =
        glm::cross(prism.vertices[b] - prism.vertices[a], prism.vertices[c] - prism.vertices[a]);
    if (normal.x == 0.0 && normal.y == 0.0) cap += 0.5 * glm::length(normal);
  }
  EXPECT_DOUBLE_EQ(cap, 2.0 * 5.0);
}

TEST(ReadMesh, VerticesAreWeldedAndEmptyTrianglesDropped) {
  const TempFolder folder;
  const Mesh mesh =
      readMesh(folder.file("a.obj", obj("f 3 1 4\nv -0.0 0 0\nv 0 0 0\nf 5 6 2\nf 4 4 1")), 1.0);
  EXPECT_EQ(mesh.vertices.size(), 4U);  // -0 and 0 are one place
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_EQ(mesh.dropped_triangles, 2U);
  EXPECT_TRUE(checkMesh(mesh).isClosed());
}

struct BadFile {
  std::string name, bytes, code, says;
  int line = 0;
};

TEST(ReadMesh, BadFilesAreNamedErrors) {
  const TempFolder folder;
  const std::string stl = binaryStl();
  std::string nan_stl = stl;
  const float not_a_number = std::nanf("");
  std::memcpy(nan_stl.data() + 84 + 12, &not_a_number, 4);
  const std::string text = asciiStl();
  const std::string ply = binaryPly(false);
  const std::vector<BadFile> files{
      {"empty.stl", "", "mesh.unreadable", "0 bytes"},
      {"short.stl", stl.substr(0, 60), "mesh.unreadable", "60 bytes"},
      {"cut.stl", stl.substr(0, stl.size() - 30), "mesh.truncated", "4 triangles"},
      {"long.stl", stl + "more", "mesh.truncated", "288 bytes"},
      {"no_faces.stl", std::string(84, '\0'), "mesh.no_faces", ""},
      {"nan.stl", nan_stl, "mesh.not_finite", "corner 0 of triangle 0"},
      {"nan_text.stl", asciiStl("nan 0 0"), "mesh.not_finite", "nan", 6},
      {"inf_text.stl", asciiStl("1e999 0 0"), "mesh.not_finite", "inf", 6},
      {"word.stl", asciiStl("1 O 0"), "mesh.unreadable", "'O' is not a number", 6},
      {"cut_text.stl", text.substr(0, text.size() / 2), "mesh.unreadable", "'fac'", 16},
      {"no_end.stl", text.substr(0, text.rfind("endsolid")), "mesh.unreadable", "cut short", 30},
      {"empty.obj", "", "mesh.no_faces", ""},
      {"text.obj", "this is\nno mesh\n", "mesh.no_faces", ""},
      {"points.obj", "v 0 0 0\nv 1 0 0\n", "mesh.no_faces", ""},
      {"index.obj", obj("f 3 1 5"), "mesh.index", "vertex 5, but 4", 11},
      {"zero.obj", obj("f 3 1 0"), "mesh.index", "vertex 0", 11},
      {"negative.obj", obj("f 3 1 -5"), "mesh.index", "vertex -5", 11},
      {"huge.obj", obj("f 3 1 99999999999999999999"), "mesh.index", "99999999999999999999", 11},
      {"word.obj", obj("f 3 1 x"), "mesh.unreadable", "'x'", 11},
      {"two.obj", obj("f 3 1"), "mesh.unreadable", "fewer than three corners", 11},
      {"nan.obj", "v 0 0 0\nv nan 0 0\n", "mesh.not_finite", "vertex 2", 2},
      {"inf.obj", "v 0 0 0\nv 0 -inf 0\n", "mesh.not_finite", "vertex 2", 2},
      {"short.obj", "v 0 0\n", "mesh.unreadable", "three coordinates", 1},
      {"empty.ply", "", "mesh.unreadable", "'ply'"},
      {"header.ply", ply.substr(0, 40), "mesh.truncated", "end_header", 3},
      {"cut.ply", ply.substr(0, ply.size() - 20), "mesh.truncated", "cut short"},
      {"index.ply", binaryPly(false, 4), "mesh.index", "face 3 (from 0) names vertex 4"},
      {"negative.ply", binaryPly(true, -1), "mesh.index", "vertex -1"},
      {"index_text.ply", asciiPly("255 1 0 0", "3 2 0 77 0"), "mesh.index", "vertex 77", 20},
      {"cut_text.ply", asciiPly("255 1 0 0", "3 2 0 3 0", 5), "mesh.truncated", "cut short", 21},
      {"nan.ply", asciiPly("255 nan 0 0"), "mesh.not_finite", "vertex 1", 14},
      {"word.ply", asciiPly("255 1 oops 0"), "mesh.unreadable", "'oops'", 14},
      {"no_faces.ply", plyHeader("ascii", 1, 0) + "0 0 0 0\n", "mesh.no_faces", ""},
      {"format.ply", "ply\nformat pdp11 1.0\nend_header\n", "mesh.unreadable", "'pdp11'", 2},
      {"index.gltf", gltf("", 77), "mesh.index", ""},
      {"broken.gltf", "{\"asset\":", "mesh.unreadable", ""},
      {"a.mesh_of_nobody", "0 0 0", "mesh.unreadable", ""},
  };
  for (const BadFile& bad : files) {
    const std::string path = folder.file(bad.name, bad.bytes);
    try {
      static_cast<void>(readMesh(path, 1.0));
      ADD_FAILURE() << bad.name << " was read";
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput) << bad.name;
      EXPECT_EQ(error.problem().code, bad.code) << bad.name << ": " << error.what();
      EXPECT_EQ(error.problem().file, path);
      EXPECT_NE(error.problem().message.find(bad.says), std::string::npos) << error.what();
      EXPECT_EQ(error.problem().line, bad.line) << error.what();
    }
  }
}

TEST(ReadMesh, MissingFileAndFolder) {
  const TempFolder folder;
  for (const char* name : {"no.stl", "no.obj", "no.ply", "no.glb"}) {
    try {
      static_cast<void>(readMesh(folder.path(name), 1.0));
      ADD_FAILURE() << name;
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "mesh.missing");
    }
  }
  std::filesystem::create_directory(folder.path("folder.stl"));
  EXPECT_THROW(static_cast<void>(readMesh(folder.path("folder.stl"), 1.0)), Error);
}

TEST(CheckMesh, CountsWhatIsThere) {
  const Mesh cube = boxMesh(Vec3(1.0, 2.0, 3.0), Vec3(2.0, 3.0, 4.0));
  const MeshReport report = checkMesh(cube);
  EXPECT_TRUE(report.isClosed());
  EXPECT_DOUBLE_EQ(report.volume, 24.0);
  EXPECT_EQ(report.components, 1U);
  EXPECT_EQ(report.non_manifold_edges, 0U);
  EXPECT_EQ(report.flipped_edges, 0U);
  EXPECT_EQ(report.degenerate_triangles, 0U);
  EXPECT_EQ(report.bounds.lo, Vec3(0.0, 0.5, 1.0));
  EXPECT_EQ(report.bounds.hi, Vec3(2.0, 3.5, 5.0));

  Mesh open = cube;
  open.triangles.pop_back();
  EXPECT_EQ(checkMesh(open).boundary_edges, 3U);
  const Vec3 where = checkMesh(open).first_boundary;
  EXPECT_DOUBLE_EQ(where.x, 2.0);  // on the face that lost a triangle

  Mesh flipped = cube;
  std::swap(flipped.triangles[0][1], flipped.triangles[0][2]);
  EXPECT_EQ(checkMesh(flipped).flipped_edges, 3U);
  EXPECT_TRUE(checkMesh(flipped).isClosed());

  Mesh inside_out = cube;
  for (auto& triangle : inside_out.triangles) std::swap(triangle[1], triangle[2]);
  EXPECT_DOUBLE_EQ(checkMesh(inside_out).volume, -24.0);
  EXPECT_EQ(checkMesh(inside_out).flipped_edges, 0U);

  // Two cubes that share an edge: that edge has four triangles.
  Mesh touching = cube;
  const Mesh other = boxMesh(Vec3(3.0, 5.0, 3.0), Vec3(2.0, 3.0, 4.0));
  touching = together(cube, other);
  EXPECT_EQ(checkMesh(touching).components, 2U);
  for (auto& triangle : touching.triangles) {
    for (auto& corner : triangle) {
      for (std::uint32_t v = 0; v < 8; ++v) {
        if (touching.vertices[v] == touching.vertices[corner]) corner = v;
      }
    }
  }
  EXPECT_EQ(checkMesh(touching).non_manifold_edges, 1U);
  EXPECT_EQ(checkMesh(touching).components, 1U);
  EXPECT_TRUE(checkMesh(touching).isClosed());

  Mesh sliver = cube;
  sliver.vertices.push_back(0.5 * (cube.vertices[0] + cube.vertices[1]));
  sliver.triangles.push_back({0, 8, 1});
  EXPECT_EQ(checkMesh(sliver).degenerate_triangles, 1U);
}

TEST(CheckMesh, VolumeOfABallConverges) {
  // A polyhedron with its corners on the sphere lacks a share of the volume that is proportional to
  // the square of the edge length: a quarter with each level.
  const double whole = 4.0 / 3.0 * std::numbers::pi * 1e-6;
  double before = 0.0;
  for (const int levels : {2, 3, 4}) {
    const double lacking = 1.0 - checkMesh(ballMesh(Vec3(0.5), 1e-2, levels)).volume / whole;
    EXPECT_GT(lacking, 0.0);
    if (before > 0.0) {
      EXPECT_NEAR(before / lacking, 4.0, 0.1);
    }
    before = lacking;
  }
}

TEST(ReadMesh, RealMeshesAreClosedOnceWelded) {
  const std::string folder = palpate::testing::scanPath("meshes");
  PALPATE_NEEDS_SCAN(folder);
  struct Known {
    const char* name;
    std::size_t triangles, components;
  };
  for (const Known& known : {Known{"brain_region.stl", 9600, 1},
                             {"brain_region2.stl", 7168, 1},
                             {"liver-smooth.obj", 4384, 1},
                             {"malleus.obj", 3748, 1},
                             {"tooth.obj", 8768, 2},
                             {"footbones.ply", 4204, 26}}) {
    const Mesh mesh = readMesh(folder + "/" + known.name, 1e-3);
    const MeshReport report = checkMesh(mesh);
    EXPECT_EQ(mesh.triangles.size(), known.triangles) << known.name;
    EXPECT_EQ(report.components, known.components) << known.name;
    EXPECT_TRUE(report.isClosed()) << known.name;
    EXPECT_EQ(report.flipped_edges, 0U) << known.name;
    EXPECT_GT(report.volume, 0.0) << known.name;
  }
}

TEST(ReadMesh, ObjLinesGoOnAfterABackslash) {
  const TempFolder folder;
  const std::string text =
      "v 0 0 \\\n0\nv 1 0 0\\\r\n\nv 0\\\n1 0\nv 0 0 1\n"
      "f 1 3 \\\n 2\nf 1 2\\\n4\nf 2 3 4\nf 3 1 \\ \n\\\n4\n";
  const Mesh mesh = readMesh(folder.file("a.obj", text), 1.0);
  EXPECT_EQ(mesh.vertices.size(), 4U);
  EXPECT_EQ(mesh.triangles.size(), 4U);
  EXPECT_TRUE(checkMesh(mesh).isClosed());
  EXPECT_NEAR(checkMesh(mesh).volume, 1.0 / 6.0, 1e-15);
  // Line numbers still count the lines of the file.
  try {
    (void)readMesh(folder.file("b.obj", "v 0 0 \\\n0\nv 1 0 x\n"), 1.0);
    ADD_FAILURE() << "no error";
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().line, 3);
  }
}

TEST(ReadMesh, TheUnitOfGltfIsPrescribed) {
  EXPECT_EQ(prescribedUnit("a/b.GLB"), "m");
  EXPECT_EQ(prescribedUnit("b.gltf"), "m");
  EXPECT_EQ(prescribedUnit("b.stl"), "");
  EXPECT_EQ(prescribedUnit("glb"), "");
}

}  // namespace
}  // namespace palpate::vdb
