// The results of findDefects(): closed forms, known defects, and self-intersections compared with
// separating axes in integers.

#include "palpate/vdb/mesh_defects.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <filesystem>
#include <numbers>
#include <random>
#include <vector>

#include "mesh/exact_side.h"
#include "mesh/triangles_meet.h"
#include "support/error_of.h"
#include "support/scan_folder.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

void turn(std::array<std::uint32_t, 3>& triangle) { std::swap(triangle[1], triangle[2]); }

TEST(FindDefects, ASoundMeshHasNone) {
  const Mesh ball = ballMesh(Vec3(0.01, -0.02, 0.03), 0.01, 4);
  const MeshDefects d = findDefects(ball);
  EXPECT_EQ(d.doubled_triangles + d.degenerate_triangles + d.boundary_edges + d.holes.size(), 0U);
  EXPECT_EQ(d.non_manifold_edges + d.turned_triangles + d.crossings + d.inside_out_parts, 0U);
  EXPECT_EQ(d.parts, 1U);
  EXPECT_EQ(d.hollow_parts, 0U);
  // 5120 triangles are some 1e-3 of the radius below the ball.
  EXPECT_NEAR(d.volume, 4.0 / 3.0 * std::numbers::pi * 1e-6, 0.005 * 4.2e-6);
  EXPECT_NEAR(d.area, 4.0 * std::numbers::pi * 1e-4, 0.005 * 1.26e-3);
  EXPECT_NEAR(d.bounds.size().x, 0.02, 1e-4);
}

TEST(FindDefects, HolesAreToldWithTheLengthOfTheirBorders) {
  Mesh box = boxMesh(Vec3(0.0), Vec3(2.0, 4.0, 6.0));
  EXPECT_DOUBLE_EQ(findDefects(box).volume, 48.0);
  EXPECT_DOUBLE_EQ(findDefects(box).area, 2.0 * (8.0 + 12.0 + 24.0));
  // The face at z = 3 and one triangle of the face at x = -1.
  std::erase_if(box.triangles, [&](const auto& t) {
    return box.vertices[t[0]].z + box.vertices[t[1]].z + box.vertices[t[2]].z > 8.9;
  });
  ASSERT_EQ(box.triangles.size(), 10U);
  MeshDefects d = findDefects(box);
  EXPECT_EQ(d.boundary_edges, 4U);
  ASSERT_EQ(d.holes.size(), 1U);
  EXPECT_EQ(d.holes[0].edges, 4U);
  EXPECT_DOUBLE_EQ(d.holes[0].length, 12.0);
  EXPECT_NEAR(glm::distance(d.holes[0].middle, Vec3(0.0, 0.0, 3.0)), 0.0, 1e-12);
  const Mesh other = ballMesh(Vec3(20.0, 0.0, 0.0), 1.0, 1);
  Mesh both = together(other, box);
  both.triangles.erase(both.triangles.begin());
  d = findDefects(both);
  ASSERT_EQ(d.holes.size(), 2U);
  EXPECT_GT(d.holes[0].length, d.holes[1].length);
  EXPECT_EQ(d.holes[1].edges, 3U);
}

TEST(FindDefects, TurnedTrianglesAndPartsInsideOut) {
  Mesh ball = ballMesh(Vec3(0.0), 0.01, 3);
  for (const std::size_t t : {3U, 100U, 101U}) turn(ball.triangles[t]);
  MeshDefects d = findDefects(ball);
  EXPECT_EQ(d.turned_triangles, 3U);
  EXPECT_EQ(d.inside_out_parts, 0U);
  for (const std::size_t t : {3U, 100U, 101U}) turn(ball.triangles[t]);
  for (auto& t : ball.triangles) turn(t);
  d = findDefects(ball);
  EXPECT_EQ(d.turned_triangles, 0U);
  EXPECT_EQ(d.inside_out_parts, 1U);
  EXPECT_GT(d.volume, 0.0);
}

TEST(FindDefects, PartsWithinOthers) {
  const Mesh large = ballMesh(Vec3(0.0), 0.01, 3);
  const Mesh small = ballMesh(Vec3(0.001, 0.002, 0.0), 0.005, 3);
  const double v_large = findDefects(large).volume;
  const double v_small = findDefects(small).volume;
  MeshDefects d = findDefects(together(large, small, /*inside_out=*/true));
  EXPECT_EQ(d.parts, 2U);
  EXPECT_EQ(d.hollow_parts, 1U);
  EXPECT_EQ(d.inside_out_parts, 0U);
  EXPECT_NEAR(d.volume, v_large - v_small, 1e-15);
  d = findDefects(together(large, small));
  EXPECT_EQ(d.hollow_parts, 0U);
  EXPECT_NEAR(d.volume, v_large, 1e-15);
  d = findDefects(
      together(together(large, small, true), ballMesh(Vec3(0.05, 0.0, 0.0), 0.005, 3), true));
  EXPECT_EQ(d.hollow_parts, 1U);
  EXPECT_EQ(d.inside_out_parts, 1U);
  EXPECT_EQ(d.crossings, 0U);
  // A part that sticks out of another one is not inside it.
  d = findDefects(together(large, ballMesh(Vec3(0.009, 0.0, 0.0), 0.005, 3)));
  EXPECT_NEAR(d.volume, v_large + v_small, 1e-15);
  EXPECT_GT(d.crossings, 0U);
}

TEST(FindDefects, DoubledDegenerateAndNonManifold) {
  Mesh box = boxMesh(Vec3(0.0), Vec3(1.0));
  box.triangles.push_back(box.triangles[0]);
  box.triangles.push_back(box.triangles[5]);
  turn(box.triangles.back());
  MeshDefects d = findDefects(box);
  EXPECT_EQ(d.doubled_triangles, 2U);
  EXPECT_EQ(d.non_manifold_edges, 0U);
  EXPECT_EQ(d.boundary_edges, 0U);
  // A fin on an edge, and a triangle whose corners are in line.
  const auto [a, b, c] = box.triangles[0];
  box.vertices.push_back(4.0 * box.vertices[a] - 1.5 * (box.vertices[b] + box.vertices[c]));
  box.vertices.push_back(2.0 * box.vertices[a] - box.vertices[b]);
  const auto fin = static_cast<std::uint32_t>(box.vertices.size() - 2);
  box.triangles.push_back({a, b, fin});
  box.triangles.push_back({a, b, fin + 1});
  d = findDefects(box);
  EXPECT_EQ(d.non_manifold_edges, 1U);
  EXPECT_EQ(d.degenerate_triangles, 1U);
}

TEST(FindDefects, SelfIntersectionsAreCountedWithAPlace) {
  // Two boxes with their edges across each other: four edges of each pass through a face of the
  // other.
  const Mesh crossed = together(boxMesh(Vec3(0.0), Vec3(4.0, 1.0, 1.0)),
                                boxMesh(Vec3(0.25, 0.25, 0.125), Vec3(1.0, 4.0, 1.0)));
  MeshDefects d = findDefects(crossed);
  EXPECT_GT(d.crossings, 8U);
  const Vec3 apart = glm::abs(d.first_crossing - Vec3(0.25, 0.25, 0.125));
  EXPECT_LE(std::max({apart.x, apart.y, apart.z}), 0.8);
  // Folded over along a common side.
  Mesh folded;
  folded.vertices = {Vec3(0, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0.25, 0.5, 0)};
  folded.triangles = {{0, 1, 2}, {1, 0, 3}};
  EXPECT_EQ(findDefects(folded).crossings, 1U);
  folded.vertices[3].z = 1e-300;
  EXPECT_EQ(findDefects(folded).crossings, 0U);
  folded.vertices[3] = Vec3(0.25, -0.5, 0);
  EXPECT_EQ(findDefects(folded).crossings, 0U);
}

using Int = std::int64_t;
using Point = std::array<Int, 3>;

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Point cross(const Point& a, const Point& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
Int dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }

/// Whether the hulls of two or three points each have a point in common: true if none of the
/// directions that could separate them does. Exact.
bool hullsMeet(const std::vector<Point>& a, const std::vector<Point>& b) {
  std::vector<Point> edges;
  for (const auto& hull : {a, b}) {
    for (std::size_t i = 0; i < hull.size(); ++i)
      edges.push_back(minus(hull[(i + 1) % hull.size()], hull[i]));
  }
  std::vector<Point> directions = edges;
  for (const Point& e : edges) {
    for (const Point& f : edges) {
      const Point n = cross(e, f);
      directions.push_back(n);
      for (const Point& g : edges) directions.push_back(cross(n, g));
    }
  }
  for (const Point& n : directions) {
    Int lo_a = dot(n, a[0]);
    Int hi_a = lo_a;
    Int lo_b = dot(n, b[0]);
    Int hi_b = lo_b;
    for (const Point& p : a) lo_a = std::min(lo_a, dot(n, p)), hi_a = std::max(hi_a, dot(n, p));
    for (const Point& p : b) lo_b = std::min(lo_b, dot(n, p)), hi_b = std::max(hi_b, dot(n, p));
    if (hi_a < lo_b || hi_b < lo_a) return false;
  }
  return true;
}

Vec3 toVec(const Point& p) {
  return {static_cast<double>(p[0]), static_cast<double>(p[1]), static_cast<double>(p[2])};
}

bool isFlat(const Point& a, const Point& b, const Point& c) {
  return cross(minus(b, a), minus(c, a)) == Point{0, 0, 0};
}

TEST(TrianglesMeet, AsSeparatingAxesInWholeNumbersSay) {
  std::mt19937 random(11);
  int met = 0;
  int asked = 0;
  for (int round = 0; round < 60000; ++round) {
    // Few places, so that corners often lie on sides, in planes and in line with others.
    const Int size = round % 3 == 0 ? 2 : (round % 3 == 1 ? 4 : 40);
    const Int thick = round % 4 == 0 ? 0 : size;
    const auto any = [&](Int most) {
      return static_cast<Int>(random() % static_cast<unsigned>(2 * most + 1)) - most;
    };
    std::vector<Point> p;
    for (int n = 0; n < 6; ++n) p.push_back({any(size), any(size), any(thick)});
    if (isFlat(p[0], p[1], p[2]) || isFlat(p[3], p[4], p[5])) continue;
    const int shared = round % 5 == 0 ? 1 : (round % 5 == 1 ? 2 : 0);
    std::vector<Vec3> vertices;
    for (const Point& q : p) vertices.push_back(toVec(q));
    std::array<std::uint32_t, 3> one{0, 1, 2};
    std::array<std::uint32_t, 3> other{3, 4, 5};
    bool truth = false;
    if (shared == 0) {
      truth = hullsMeet({p[0], p[1], p[2]}, {p[3], p[4], p[5]});
    } else if (shared == 1) {
      if (isFlat(p[0], p[4], p[5])) continue;
      other = {4, 0, 5};
      truth = hullsMeet({p[1], p[2]}, {p[0], p[4], p[5]}) ||
              hullsMeet({p[4], p[5]}, {p[0], p[1], p[2]});
    } else {
      if (isFlat(p[0], p[1], p[5])) continue;
      other = {1, 5, 0};
      // They meet beyond the common side only if both lie in one plane, on one side of it.
      const Point n = cross(minus(p[1], p[0]), minus(p[2], p[0]));
      truth =
          dot(n, minus(p[5], p[0])) == 0 && dot(cross(minus(p[1], p[0]), minus(p[5], p[0])), n) > 0;
    }
    std::shuffle(one.begin(), one.end(), random);
    std::shuffle(other.begin(), other.end(), random);
    const auto place = trianglesMeet(vertices, one, other);
    ASSERT_EQ(place.has_value(), truth) << round << " shared " << shared;
    ASSERT_EQ(trianglesMeet(vertices, other, one).has_value(), truth);
    ++asked;
    met += truth ? 1 : 0;
    if (!place) continue;
    for (int axis = 0; axis < 3; ++axis) {  // inside both boxes
      ASSERT_GE((*place)[axis],
                std::min({vertices[one[0]][axis], vertices[one[1]][axis], vertices[one[2]][axis]}) -
                    1e-9);
      ASSERT_LE((*place)[axis],
                std::max({vertices[one[0]][axis], vertices[one[1]][axis], vertices[one[2]][axis]}) +
                    1e-9);
    }
  }
  EXPECT_GT(met, asked / 10);
  EXPECT_LT(met, asked * 9 / 10);
}

__extension__ using Wide = __int128;

TEST(ExactSide, OfPointsAlmostInAPlaneAndInALine) {
  std::mt19937_64 random(5);
  int zero = 0;
  for (int round = 0; round < 20000; ++round) {
    // 36 bits: products of three differences fit in 127 bits, but not in a long double.
    std::array<std::array<Int, 3>, 4> p{};
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t axis = 0; axis < 3; ++axis)
        p[n][axis] = static_cast<Int>(random() >> 28) - (Int{1} << 35);
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
      p[3][axis] = p[0][axis] + p[1][axis] - p[2][axis] +
                   (round % 2 == 0 ? static_cast<Int>(random() % 3) - 1 : 0);
    }
    std::array<std::array<Wide, 3>, 3> row{};
    for (std::size_t n = 0; n < 3; ++n) {
      for (std::size_t axis = 0; axis < 3; ++axis) row[n][axis] = Wide{p[n][axis]} - p[3][axis];
    }
    const auto& [a, b, c] = row;
    const Wide volume = a[0] * (b[1] * c[2] - b[2] * c[1]) + a[1] * (b[2] * c[0] - b[0] * c[2]) +
                        a[2] * (b[0] * c[1] - b[1] * c[0]);
    const int truth = volume > 0 ? 1 : (volume < 0 ? -1 : 0);
    ASSERT_EQ(sideOfPlane(toVec(p[0]), toVec(p[1]), toVec(p[2]), toVec(p[3])), truth) << round;
    zero += truth == 0 ? 1 : 0;
  }
  EXPECT_GE(zero, 10000);
  // One unit in the last place off the line.
  const Vec3 p(0.1, 0.1, 0.0);
  const Vec3 q(0.3, 0.3, 0.0);
  EXPECT_EQ(sideOfLine(p, q, Vec3(0.2, 0.2, 0.0), 2), 0);
  EXPECT_EQ(sideOfLine(p, q, Vec3(0.2, std::nextafter(0.2, 1.0), 0.0), 2), 1);
  EXPECT_EQ(sideOfLine(p, q, Vec3(std::nextafter(0.2, 1.0), 0.2, 0.0), 2), -1);
}

TEST(FindDefects, RealMeshes) {
  const std::string folder = palpate::testing::scanPath("meshes/");
  PALPATE_NEEDS_SCAN(folder);
  // The numbers of parts are those in the folder's list.
  const std::pair<const char*, std::size_t> meshes[] = {
      {"liver-smooth.obj", 1}, {"malleus.obj", 1},       {"tooth.obj", 2},
      {"brain_region.stl", 1}, {"brain_region2.stl", 1}, {"footbones.ply", 26}};
  for (const auto& [name, parts] : meshes) {
    const MeshDefects d = findDefects(readMesh(folder + name, 1e-3));
    EXPECT_EQ(d.parts, parts) << name;
    EXPECT_EQ(d.boundary_edges, 0U) << name;
    EXPECT_EQ(d.turned_triangles, 0U) << name;
  }
}

TEST(FindDefects, CanBeStopped) {
  const Mesh ball = ballMesh(Vec3(0.0), 0.01, 3);
  const Error error = errorOf([&] {
    static_cast<void>(
        findDefects(ball, [](std::string_view, double share) { return share < 0.2; }));
  });
  EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
}

}  // namespace
}  // namespace palpate::vdb
