// Meshes of few flat faces: felt as the solid between their planes, with exact edges and corners.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"
#include "support/temp_file.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::test::Drive;
using palpate::test::Judge;
using palpate::test::kDegree;
using palpate::test::sceneOfSolid;

constexpr double kMm = 1e-3;

/// Splits polygons, whose corners count from 0, into triangles.
Mesh meshOf(const std::vector<Vec3>& vertices, const std::vector<std::vector<int>>& polygons) {
  std::string text;
  for (const Vec3& v : vertices) {
    char line[96];
    std::snprintf(line, sizeof line, "v %.17g %.17g %.17g\n", v.x, v.y, v.z);
    text += line;
  }
  for (const auto& polygon : polygons) {
    text += "f";
    for (const int v : polygon) text += " " + std::to_string(v + 1);
    text += "\n";
  }
  const palpate::testing::TempFolder folder;
  return readMesh(folder.file("polygons.obj", text), 1.0);
}

/// A prism between two heights; corners are counterclockwise.
Mesh prism(const std::vector<glm::dvec2>& corners, double low, double high) {
  std::vector<Vec3> vertices;
  const int n = static_cast<int>(corners.size());
  for (const auto& c : corners) vertices.emplace_back(c.x, c.y, low);
  for (const auto& c : corners) vertices.emplace_back(c.x, c.y, high);
  std::vector<std::vector<int>> polygons(2);
  for (int i = 0; i < n; ++i) {
    polygons[0].push_back(n - 1 - i);
    polygons[1].push_back(n + i);
    polygons.push_back({i, (i + 1) % n, n + (i + 1) % n, n + i});
  }
  return meshOf(vertices, polygons);
}

Mesh star() {
  std::vector<glm::dvec2> corners;
  for (int i = 0; i < 10; ++i) {
    const double r = (i % 2 == 0 ? 30.0 : 12.0) * kMm;
    const double a = i * 36.0 * kDegree + 0.1;
    corners.emplace_back(r * std::cos(a), r * std::sin(a));
  }
  return prism(corners, -8 * kMm, 8 * kMm);
}

Mesh wedgeMesh() {
  return prism({{-20 * kMm, -10 * kMm}, {20 * kMm, -10 * kMm}, {-20 * kMm, 4 * kMm}}, -15 * kMm,
               15 * kMm);
}

Mesh coneMesh(int sides) {
  std::vector<Vec3> vertices{Vec3(0.0, 0.0, 20 * kMm)};
  std::vector<std::vector<int>> polygons(1);
  for (int i = 0; i < sides; ++i) {
    const double a = 2.0 * std::numbers::pi * i / sides;
    vertices.emplace_back(20 * kMm * std::cos(a), 20 * kMm * std::sin(a), -20 * kMm);
    polygons[0].insert(polygons[0].begin(), i + 1);
    polygons.push_back({0, i + 1, (i + 1) % sides + 1});
  }
  return meshOf(vertices, polygons);
}

/// A letter E: two pockets; its middle bar is shorter.
Mesh letterE() {
  std::vector<glm::dvec2> corners{{0, 0},   {20, 0}, {20, 6}, {6, 6},   {6, 12},  {14, 12},
                                  {14, 18}, {6, 18}, {6, 24}, {20, 24}, {20, 30}, {0, 30}};
  for (auto& c : corners) c *= kMm;
  return prism(corners, 0.0, 10 * kMm);
}

/// A U with a pillar in its pocket: a solid within a pocket within a hull.
Mesh pillarInAPocket() {
  std::vector<glm::dvec2> corners{{0, 0},   {30, 0},  {30, 20}, {25, 20}, {25, 5}, {18, 5},
                                  {18, 14}, {12, 14}, {12, 5},  {5, 5},   {5, 20}, {0, 20}};
  for (auto& c : corners) c *= kMm;
  return prism(corners, 0.0, 10 * kMm);
}

/// A cube of 20 mm without one of its eight smaller cubes: a hollow corner.
Mesh cubeWithoutACorner() {
  std::vector<Vec3> v;
  for (int n = 0; n < 27; ++n) v.push_back(10 * kMm * Vec3(n % 3, n / 3 % 3, n / 9));
  const auto at = [](int x, int y, int z) { return x + 3 * y + 9 * z; };
  return meshOf(v, {{at(0, 0, 0), at(0, 2, 0), at(2, 2, 0), at(2, 0, 0)},
                    {at(0, 0, 0), at(2, 0, 0), at(2, 0, 2), at(0, 0, 2)},
                    {at(0, 0, 0), at(0, 0, 2), at(0, 2, 2), at(0, 2, 0)},
                    {at(0, 0, 2), at(2, 0, 2), at(2, 1, 2), at(1, 1, 2), at(1, 2, 2), at(0, 2, 2)},
                    {at(0, 2, 0), at(0, 2, 2), at(1, 2, 2), at(1, 2, 1), at(2, 2, 1), at(2, 2, 0)},
                    {at(2, 0, 0), at(2, 2, 0), at(2, 2, 1), at(2, 1, 1), at(2, 1, 2), at(2, 0, 2)},
                    {at(1, 1, 1), at(1, 2, 1), at(1, 2, 2), at(1, 1, 2)},
                    {at(1, 1, 1), at(1, 1, 2), at(2, 1, 2), at(2, 1, 1)},
                    {at(1, 1, 1), at(2, 1, 1), at(2, 2, 1), at(1, 2, 1)}});
}

/// Whether a ray from p in an irregular direction crosses a closed mesh an odd number of times.
bool isInside(const Mesh& mesh, const Vec3& p) {
  const Vec3 way = glm::normalize(Vec3(0.321, 0.527, 0.786));
  int walls = 0;
  for (const auto& [i, j, k] : mesh.triangles) {
    const Vec3 a = mesh.vertices[i] - p;
    const Vec3 b = mesh.vertices[j] - p;
    const Vec3 c = mesh.vertices[k] - p;
    const double u = glm::dot(way, glm::cross(a, b));
    const double v = glm::dot(way, glm::cross(b, c));
    const double w = glm::dot(way, glm::cross(c, a));
    const bool is_met = (u > 0.0 && v > 0.0 && w > 0.0) || (u < 0.0 && v < 0.0 && w < 0.0);
    const Vec3 normal = glm::cross(b - a, c - a);
    if (is_met && glm::dot(normal, a) / glm::dot(normal, way) > 0.0) ++walls;
  }
  return walls % 2 == 1;
}

/// The field is zero on the mesh, has the mesh's inside, and never exceeds the distance (its slope
/// is 1).
void expectSolid(const Mesh& mesh) {
  const FieldPtr field = polyhedronField(mesh);
  ASSERT_TRUE(field);
  Box3 box;
  for (const auto& t : mesh.triangles) {
    Vec3 middle(0.0);
    for (const std::uint32_t v : t) {
      box.include(mesh.vertices[v]);
      middle += mesh.vertices[v] / 3.0;
      EXPECT_NEAR(field->value(mesh.vertices[v]), 0.0, 1e-12);
    }
    EXPECT_NEAR(field->value(middle), 0.0, 1e-12);
  }
  EXPECT_LE(glm::distance(field->bounds().lo, box.lo), 1e-5 * glm::length(box.size()));
  std::mt19937 random(5);
  std::uniform_real_distribution<double> any(-0.3, 1.3);
  for (int n = 0; n < 20000; ++n) {
    const Vec3 p = box.lo + Vec3(any(random), any(random), any(random)) * box.size();
    const FieldSample here = field->sample(p);
    ASSERT_EQ(here.value < 0.0, isInside(mesh, p)) << p.x << " " << p.y << " " << p.z;
    ASSERT_NEAR(glm::length(here.gradient), 1.0, 1e-12);
    const Vec3 q = p + 1e-4 * Vec3(any(random), any(random), any(random));
    ASSERT_LE(std::abs(field->value(q) - here.value), glm::distance(p, q) + 1e-15);
  }
}

TEST(Polyhedron, Cube) { expectSolid(boxMesh(Vec3(1, 2, 3) * kMm, Vec3(20 * kMm))); }
TEST(Polyhedron, Wedge) { expectSolid(wedgeMesh()); }
TEST(Polyhedron, Cone) { expectSolid(coneMesh(40)); }
TEST(Polyhedron, Star) { expectSolid(star()); }
TEST(Polyhedron, LetterE) { expectSolid(letterE()); }
TEST(Polyhedron, PillarInAPocket) { expectSolid(pillarInAPocket()); }
TEST(Polyhedron, CubeWithoutACorner) { expectSolid(cubeWithoutACorner()); }

TEST(Polyhedron, TwoCubesThatOverlap) {
  const Mesh one = boxMesh(Vec3(0.0), Vec3(20 * kMm));
  const Mesh other = boxMesh(Vec3(9 * kMm, 7 * kMm, 3 * kMm), Vec3(20 * kMm));
  const FieldPtr field = polyhedronField(together(one, other));
  ASSERT_TRUE(field);
  EXPECT_LT(field->value(Vec3(4.5 * kMm, 3.5 * kMm, 0.0)), -4 * kMm);
  EXPECT_NEAR(field->value(Vec3(-10 * kMm, 0.0, 0.0)), 0.0, 1e-12);
}

TEST(Polyhedron, InsideOutIsTheSameSolid) {
  Mesh mesh = star();
  for (auto& t : mesh.triangles) std::swap(t[1], t[2]);
  const FieldPtr field = polyhedronField(mesh);
  ASSERT_TRUE(field);
  EXPECT_LT(field->value(Vec3(0.0)), -7 * kMm);
}

TEST(Polyhedron, FacesOfManyTrianglesAreOneFace) {
  // Each triangle is divided into four, three times, in floats: as in an STL file.
  Mesh mesh = boxMesh(Vec3(1, 2, 3) * kMm, Vec3(20 * kMm));
  const Mat3 turn = rotationAbout(Vec3(1, 2, 3), 0.7);
  for (Vec3& v : mesh.vertices) v = turn * v;
  for (int level = 0; level < 3; ++level) {
    std::vector<std::array<std::uint32_t, 3>> finer;
    for (const auto& [a, b, c] : mesh.triangles) {
      const auto middle = [&](std::uint32_t i, std::uint32_t j) {
        mesh.vertices.push_back(0.5 * (mesh.vertices[i] + mesh.vertices[j]));
        return static_cast<std::uint32_t>(mesh.vertices.size() - 1);
      };
      const std::uint32_t ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {ab, b, bc}, {ca, bc, c}, {ab, bc, ca}});
    }
    mesh.triangles = finer;
  }
  for (Vec3& v : mesh.vertices) v = Vec3(glm::vec3(v));
  const FieldPtr field = polyhedronField(mesh, 6);
  ASSERT_TRUE(field);
  // The rounding of a float of 30 mm is 2e-9.
  EXPECT_NEAR(field->value(turn * (Vec3(11, 2, 3) * kMm)), 0.0, 1e-8);
}

TEST(Polyhedron, WhatIsNoneIsLeftToTheGrid) {
  EXPECT_FALSE(polyhedronField(ballMesh(Vec3(0.0), 20 * kMm, 3)));
  Mesh open = boxMesh(Vec3(0.0), Vec3(20 * kMm));
  open.triangles.pop_back();
  EXPECT_FALSE(polyhedronField(open));
  const Mesh hollow =
      together(boxMesh(Vec3(0.0), Vec3(20 * kMm)), boxMesh(Vec3(0.0), Vec3(10 * kMm)), true);
  EXPECT_FALSE(polyhedronField(hollow));
  EXPECT_FALSE(polyhedronField(star(), 11));  // the star has twelve faces
}

/// A hand goes from face to face, and now and then out. All ticks are compared with the oracle,
/// which projects onto the true solid.
void feelsTrue(const Mesh& mesh, bool from_within, const Vec3& free, double reach, int seed) {
  const FieldPtr field = polyhedronField(mesh);
  ASSERT_TRUE(field);
  Judge judge(field, from_within);
  judge.stepOracleBy(200e-6);
  judgeWalk(judge, free, {Vec3(-reach), Vec3(reach)}, 0.5, seed, 800);
}

TEST(PolyhedronContact, CubeFeelsLikeTheBox) {
  // The same hand on both: no tick differs by more than rounding.
  const Vec3 size(60 * kMm, 40 * kMm, 20 * kMm);
  const FieldPtr field = polyhedronField(boxMesh(Vec3(0.0), size));
  ASSERT_TRUE(field);
  Drive mesh(sceneOfSolid(field));
  Drive truth(sceneOfSolid(box(Vec3(0.0), size)));
  palpate::test::Random random(3);
  Vec3 p(0.0, 0.0, 30 * kMm);
  Vec3 goal = p;
  int contacts = 0;
  for (int n = 0; n < 20000; ++n) {
    if (glm::distance(p, goal) < 1e-3) {
      goal = random.in({Vec3(-33, -23, -13) * kMm, Vec3(33, 23, 13) * kMm});
      if (n % 7 == 0) goal.z = 30 * kMm;
    }
    p += 0.2e-3 * unitOr(goal - p, Vec3(0.0, 0.0, 1.0));
    const Vec3 wanted = truth.to(p).force;
    const TickResult got = mesh.to(p);
    if (got.contact) ++contacts;
    ASSERT_NEAR(glm::distance(got.force, wanted), 0.0, 1e-9) << "tick " << n;
  }
  EXPECT_GT(contacts, 5000);
}

TEST(PolyhedronContact, Wedge) {
  feelsTrue(wedgeMesh(), false, Vec3(30, 30, 20) * kMm, 22 * kMm, 11);
}
TEST(PolyhedronContact, Cone) {
  feelsTrue(coneMesh(24), false, Vec3(30, 30, 20) * kMm, 22 * kMm, 12);
}
TEST(PolyhedronContact, Star) { feelsTrue(star(), false, Vec3(0, 0, 25) * kMm, 30 * kMm, 13); }
TEST(PolyhedronContact, WithinAStar) { feelsTrue(star(), true, Vec3(0.0), 30 * kMm, 14); }
TEST(PolyhedronContact, HollowCorner) {
  feelsTrue(cubeWithoutACorner(), false, Vec3(30, 30, 30) * kMm, 25 * kMm, 15);
}

TEST(PolyhedronContact, AnEdgeIsFeltWhereItIs) {
  const double half = 15 * kMm;
  const Mesh mesh = boxMesh(Vec3(0.0), Vec3(2.0 * half));
  const FieldPtr bricks = gridField(bakeMesh(mesh, voxels(0.5 * kMm)));
  const FieldPtr exact = polyhedronField(mesh);
  ASSERT_TRUE(exact);
  // On the edge itself, and a tenth of a voxel outside each adjacent face.
  double rounded = 0.0;
  double turned = 0.0;
  for (int n = 0; n <= 100; ++n) {
    const Vec3 at(half, (0.01 * n - 0.5) * half, half);
    EXPECT_NEAR(exact->value(at), 0.0, 1e-15);
    rounded = std::max(rounded, std::abs(bricks->value(at)));
    for (const Vec3& out : {Vec3(1, 0, 0), Vec3(0, 0, 1)}) {
      const Vec3 in = Vec3(1, 0, 1) - out;
      const Vec3 beside = at + 0.05 * kMm * out - 0.06 * kMm * in;
      EXPECT_EQ(exact->sample(beside).gradient, out);
      const double cosine = glm::dot(unitOr(bricks->sample(beside).gradient, in), out);
      turned = std::max(turned, std::acos(std::min(1.0, cosine)) / kDegree);
    }
  }
  std::printf("an edge at voxels of 0.5 mm: bricks are off by %.3f mm and %.0f degrees\n",
              rounded * 1e3, turned);
  EXPECT_GT(turned, 10.0);  // the path must turn the force this much, or the test shows nothing
}

}  // namespace
}  // namespace palpate::vdb
