// Baking of fields whose value is not a distance: every voxel gets the distance to the surface,
// with few queries of the field, and a hand feels the grid as it would feel the surface.

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ostream>
#include <string>
#include <vector>

#include "lib/render/hard_judge.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/foot_point.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/grid_error.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/counted_field.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using palpate::test::Drive;
using palpate::test::kDefaultK;
using palpate::test::sceneOfSolid;
using test::Counted;
using test::voxels;

constexpr double kMm = 1e-3;

struct Shape {
  std::string name;
  FieldPtr field;
  std::optional<Box3> box;
  /// The box in which a hand touches the shape: inside, for an unbounded shape.
  Box3 touched;
};

void PrintTo(const Shape& shape, std::ostream* out) { *out << shape.name; }

/// The surfaces of two balls, of 30 and 45 mm, merge in a saddle; with voxels of 2 mm a medial axis
/// is within the band.
FieldPtr twoBalls() {
  return metaballs({{Vec3(-14 * kMm, 0.3 * kMm, 0.0), 30 * kMm, 1.0},
                    {Vec3(16 * kMm, 0.0, -0.2 * kMm), 45 * kMm, 1.0}},
                   FallOff::kWyvill, 0.4);
}

std::vector<Shape> shapes() {
  QuadricCoefficients egg;
  egg.xx = 1.0 / (25 * kMm * 25 * kMm);
  egg.yy = 1.0 / (18 * kMm * 18 * kMm);
  egg.zz = 1.0 / (15 * kMm * 15 * kMm);
  egg.xy = 0.3 * std::sqrt(egg.xx * egg.yy);
  egg.constant = -1.0;
  const Vec3 off(0.31 * kMm, -0.17 * kMm, 0.23 * kMm);
  const Box3 block{Vec3(-31 * kMm), Vec3(31 * kMm)};
  std::vector<Shape> all = {{"heart", heart(off, 30 * kMm), {}, {}},
                            {"metaballs", twoBalls(), {}, {}},
                            {"gyroid", gyroid(off, 40 * kMm), block, block.grownBy(-15 * kMm)},
                            {"quadric", quadric(off, egg), {}, {}}};
  for (Shape& shape : all) {
    if (shape.touched.isEmpty()) shape.touched = shape.field->bounds();
  }
  return all;
}

/// Descends along the gradient to the surface; nothing if that fails.
std::optional<Vec3> onSurface(const Field& field, Vec3 p) {
  for (int i = 0; i < 60; ++i) {
    const FieldSample s = field.sample(p);
    const double square = glm::dot(s.gradient, s.gradient);
    if (!(square > 1e-12)) return {};
    const Vec3 by = (s.value / square) * s.gradient;
    if (!(glm::length(by) < 10 * kMm)) return {};
    p -= by;
    if (glm::length(by) < 1e-12) return p;
  }
  return {};
}

class BakeImplicit : public ::testing::TestWithParam<Shape> {};
INSTANTIATE_TEST_SUITE_P(Shapes, BakeImplicit, ::testing::ValuesIn(shapes()),
                         [](const auto& with) { return with.param.name; });

BakeOptions optionsOf(const Shape& shape, double voxel) {
  BakeOptions options = voxels(voxel, kCubicHalfWidth);
  options.box = shape.box;
  return options;
}

TEST_P(BakeImplicit, VoxelsHoldTrueDistances) {
  const Shape& shape = GetParam();
  const LevelSet grid = bake(*shape.field, optionsOf(shape, 1 * kMm));
  // A tenth of the error of the cubic sampler for a radius of curvature of 8 voxels, 0.037 / 8^3.
  // The heart curves within a voxel, where points are found by small steps: its tolerance is the
  // stated error of a grid even where it is smooth.
  const double tolerance = (shape.name == "heart" ? 2e-2 : 1e-5) * kMm;
  std::uint64_t compared = 0;
  std::uint64_t nearer = 0;
  double worst = 0.0;
  double worst_far = 0.0;
  for (auto value = grid.impl().grid->cbeginValueOn(); value; ++value) {
    const openvdb::Coord at = value.getCoord();
    if ((at.x() + 3 * at.y() + 5 * at.z()) % 7 != 0) continue;
    const Vec3 p = Vec3(at.x(), at.y(), at.z()) * (1 * kMm);
    // Nearer to a cutting face than to the surface, the value is the distance to the face.
    if (shape.box && !shape.box->grownBy(-6.1 * kMm).contains(p)) continue;
    const auto foot = footPoint(*shape.field, p);
    if (!foot) continue;
    ++compared;
    const double more = std::fabs(*value) * kMm - std::fabs(foot->distance);
    // footPoint() misses a part of the surface that is nearer by up to a hundredth.
    if (more < -tolerance && more > -0.011 * std::fabs(foot->distance)) {
      ++nearer;
    } else {
      (std::fabs(foot->distance) < 4 * kMm ? worst : worst_far) =
          std::max(std::fabs(foot->distance) < 4 * kMm ? worst : worst_far, std::fabs(more));
    }
  }
  std::printf("%s at 1 mm: %llu voxels, off by at most %.1e mm\n", shape.name.c_str(),
              static_cast<unsigned long long>(compared), worst / kMm);
  EXPECT_GT(compared, 3000U);
  EXPECT_LE(nearer, compared / 100);
  EXPECT_LE(worst, tolerance);
  // Beside a medial axis or a center of curvature: there a voxel knows a nearer part of the surface
  // only through its neighbors' points.
  EXPECT_LE(worst_far, 0.13 * kMm);
}

TEST_P(BakeImplicit, NoVoxelIsFartherThanTheSurfaceNorLeftOut) {
  // Starting from points of the surface: every voxel within the band exists, and its value is at
  // most the distance to that point.
  const Shape& shape = GetParam();
  for (const double voxel : {2 * kMm, 0.7 * kMm}) {
    const LevelSet grid = bake(*shape.field, optionsOf(shape, voxel));
    const auto accessor = grid.impl().grid->getConstAccessor();
    palpate::test::Random random(3);
    int points = 0;
    for (int i = 0; i < 4000; ++i) {
      const auto on = onSurface(*shape.field, random.in(shape.touched));
      if (!on || (shape.box && !shape.touched.contains(*on))) continue;
      const Vec3 p = *on + 5.5 * voxel * std::cbrt(random.uniform(0.0, 1.0)) * random.direction();
      const Vec3 q = glm::round(p / voxel);
      const openvdb::Coord at(static_cast<int>(q.x), static_cast<int>(q.y), static_cast<int>(q.z));
      const double way = glm::length(q * voxel - *on);
      if (way > 5.9 * voxel) continue;
      ++points;
      float value = 0.0F;
      ASSERT_TRUE(accessor.probeValue(at, value)) << voxel << " " << way / voxel;
      // A closest point found by small steps across a kink is off along the kink by hundredths of a
      // voxel.
      ASSERT_LE(std::fabs(value) * kMm, way + 0.03 * voxel) << way / voxel;
    }
    EXPECT_GT(points, 500);
  }
}

TEST_P(BakeImplicit, TakesAtMostFiveLooksAVoxel) {
  const Shape& shape = GetParam();
  for (const double voxel : {2 * kMm, 1 * kMm, 0.5 * kMm}) {
    const Counted counted(shape.field);
    const LevelSet grid = bake(counted, optionsOf(shape, voxel));
    const double each = counted.looks() / static_cast<double>(grid.info().active_voxels);
    std::printf("%s at %.1f mm: %.2f looks a voxel\n", shape.name.c_str(), voxel / kMm, each);
    EXPECT_LE(each, 5.0);
  }
}

TEST_P(BakeImplicit, DoesNotDependOnThreads) {
  const Shape& shape = GetParam();
  const LevelSet many = bake(*shape.field, optionsOf(shape, 2 * kMm));
  const tbb::global_control one(tbb::global_control::max_allowed_parallelism, 1);
  const LevelSet alone = bake(*shape.field, optionsOf(shape, 2 * kMm));
  ASSERT_EQ(many.info().active_voxels, alone.info().active_voxels);
  const auto accessor = alone.impl().grid->getConstAccessor();
  for (auto value = many.impl().grid->cbeginValueOn(); value; ++value) {
    ASSERT_EQ(*value, accessor.getValue(value.getCoord()));
  }
}

TEST_P(BakeImplicit, LipschitzBoundIsThatOfADistance) {
  // The bound was 9 to 19 when S / |grad S| stood for the distance far from the surface.
  const Shape& shape = GetParam();
  for (const double voxel : {2 * kMm, 1 * kMm, 0.5 * kMm}) {
    const FieldPtr made = gridField(bake(*shape.field, optionsOf(shape, voxel)));
    std::printf("%s at %.1f mm: slopes up to %.3f\n", shape.name.c_str(), voxel / kMm,
                made->lipschitz());
    // Slopes are 1 except where distances to several sides meet, which the spline rounds off. There
    // the bound from the control values of its cells is 2.6: at a crease along the diagonal and at
    // the tip of a cone.
    EXPECT_LE(made->lipschitz(), 3.0);
  }
}

/// Statistics of a hand that presses 1 mm into the surface at random points, compared with the true
/// surface.
struct Touched {
  int points = 0;
  int smooth = 0;  // of these, points where the surface is smooth over four voxels
  int without_force = 0;
  double worst_force = 0.0;  // [N] error of |force| against K times the true depth
  // [N] Error of the force against K times the vector to the true surface
  double worst_smooth = 0.0;
  double strongest = 0.0;  // [N]
};

/// Whether the radius of curvature of the true surface is at least `least_radius` everywhere within
/// `reach` of the point.
bool isSmooth(const Field& field, const Vec3& on, double reach, double least_radius) {
  const auto bends_enough = [&](const Vec3& p) {
    const auto foot = footPoint(field, p);
    if (!foot) return false;
    const double sum = std::fabs(foot->curvature_sum);
    const double spread = std::sqrt(std::max(0.0, sum * sum - 4.0 * foot->curvature_product));
    return 0.5 * (sum + spread) * least_radius < 1.0;
  };
  if (!bends_enough(on)) return false;
  const Vec3 normal = glm::normalize(field.sample(on).gradient);
  palpate::test::Random random(1);
  for (int i = 0; i < 60; ++i) {
    const Vec3 direction = random.direction();
    const Vec3 along = direction - glm::dot(direction, normal) * normal;
    const auto there = onSurface(field, on + reach * along);
    if (!there || !bends_enough(*there)) return false;
    // A cusp is too small to be hit itself, but on a line that passes it the normal turns by more
    // than on such a bend.
    const double turn =
        std::acos(std::min(1.0, glm::dot(normal, glm::normalize(field.sample(*there).gradient))));
    if (turn * least_radius > reach) return false;
  }
  return true;
}

Touched touched(const Shape& shape, const FieldPtr& made, double voxel) {
  const double depth = 1 * kMm;
  Touched out;
  const ScenePtr scene = sceneOfSolid(made);
  palpate::test::Random random(11);
  const int wanted = std::getenv("PALPATE_SLOW_TESTS") != nullptr ? 2000 : 300;
  for (int i = 0; out.points < wanted && i < 20 * wanted; ++i) {
    const auto on = onSurface(*shape.field, random.in(shape.touched));
    if (!on || !shape.touched.contains(*on)) continue;
    const Vec3 normal = glm::normalize(shape.field->sample(*on).gradient);
    const Vec3 hip = *on - depth * normal;
    const auto foot = footPoint(*shape.field, hip);
    // Beyond a medial axis the hand is nearer to another side of the surface: such points are
    // skipped.
    if (!foot || glm::length(foot->point - *on) > 1e-3 * depth) continue;
    ++out.points;
    Drive drive(scene);
    (void)drive.to(*on + 2 * kMm * normal);
    (void)drive.walk(hip);
    TickResult tick;
    for (int n = 0; n < 20; ++n) tick = drive.to(hip);
    const double force = glm::length(tick.force);
    out.without_force += force == 0.0 ? 1 : 0;
    out.strongest = std::max(out.strongest, force);
    const Vec3 due = kDefaultK * (foot->point - hip);
    out.worst_force = std::max(out.worst_force, std::fabs(force - glm::length(due)));
    if (!isSmooth(*shape.field, *on, 4.0 * voxel, std::max(6.0 * voxel, 3.0 * depth))) continue;
    ++out.smooth;
    out.worst_smooth = std::max(out.worst_smooth, glm::length(tick.force - due));
  }
  return out;
}

TEST_P(BakeImplicit, TouchedEverywhereItGivesTheForceOfTheTrueSurface) {
  // An earlier version gave 43.9 N instead of 1 N for metaballs at 2 mm, and for a heart no force
  // in 1117 of 1549 ticks of contact.
  const Shape& shape = GetParam();
  for (const double voxel : {2 * kMm, 1 * kMm, 0.5 * kMm}) {
    const LevelSet grid = bake(*shape.field, optionsOf(shape, voxel));
    const FieldPtr made = gridField(grid);
    const GridError stated = gridError(*shape.field, grid, *made, shape.touched);
    const GridError smooth = smoothGridError(Sampler::kCubic, voxel);
    const Touched t = touched(shape, made, voxel);
    std::printf(
        "%s at %.1f mm, stated to be off by %.1e mm: %d points, %d without force, up to %.2f N, "
        "off by %.1e N; by %.1e N at %d smooth points\n",
        shape.name.c_str(), voxel / kMm, stated.off / kMm, t.points, t.without_force, t.strongest,
        t.worst_force, t.worst_smooth, t.smooth);
    EXPECT_GT(t.points, 100);
    // No part of a heart 15 voxels wide is smooth over eight of them, nor of a gyroid with a period
    // of 20.
    const bool is_tight = shape.name == "heart" || shape.name == "gyroid";
    EXPECT_GT(t.smooth, is_tight && voxel > 1.5 * kMm ? -1 : 0);
    EXPECT_EQ(t.without_force, 0);
    // The force is K times the vector to the surface, so that its error is at most that of the
    // surface. This error was measured at one point per voxel, and can be a little larger between
    // them.
    EXPECT_LE(t.worst_force, 1.25 * kDefaultK * stated.off);
    // Where the surface is smooth over the reach of the spline, the stated errors of every grid
    // hold: 0.02 voxel for the surface, and 1 degree, of 1 N, for the normal.
    EXPECT_LE(t.worst_smooth, kDefaultK * (smooth.off + 1 * kMm * smooth.turn));
  }
}

TEST_P(BakeImplicit, AStrokeAllOverItNeverLosesTheSurfaceNorThrowsTheHand) {
  // Also where the surface curves within a voxel: tips, dimple, saddle.
  const Shape& shape = GetParam();
  const double voxel = 2 * kMm;
  const double depth = 1 * kMm;
  Drive drive(sceneOfSolid(gridField(bake(*shape.field, optionsOf(shape, voxel)))));
  palpate::test::Random random(5);
  std::optional<Vec3> on;
  while (!on || !shape.touched.contains(*on))
    on = onSurface(*shape.field, random.in(shape.touched));
  Vec3 normal = glm::normalize(shape.field->sample(*on).gradient);
  (void)drive.to(*on + 2 * kMm * normal);
  (void)drive.walk(*on - depth * normal);
  Vec3 along = glm::normalize(glm::cross(normal, random.direction()));
  int lost = 0;
  double strongest = 0.0;
  double jump = 0.0;
  Vec3 before = drive.last().force;
  constexpr int kTicks = 8000;
  for (int i = 0; i < kTicks; ++i) {
    const auto next = onSurface(*shape.field, *on + 0.2 * kMm * along);
    if (!next || !shape.touched.contains(*next) || glm::length(*next - *on) > 0.5 * kMm) {
      along = glm::normalize(glm::cross(normal, random.direction()));
      continue;
    }
    on = next;
    normal = glm::normalize(shape.field->sample(*on).gradient);
    along = glm::normalize(along - glm::dot(along, normal) * normal);
    const TickResult tick = drive.to(*on - depth * normal);
    lost += glm::length(tick.force) == 0.0 ? 1 : 0;
    strongest = std::max(strongest, glm::length(tick.force));
    jump = std::max(jump, glm::length(tick.force - before));
    before = tick.force;
  }
  std::printf("%s at 2 mm: %d of %d ticks without force, up to %.2f N, by %.2f N in a tick\n",
              shape.name.c_str(), lost, kTicks, strongest, jump);
  EXPECT_EQ(lost, 0);
  // The stated error of a heart at 2 mm is 0.53 mm, at its cusps; along a stroke it is far less.
  EXPECT_LE(strongest, 1.2 * kDefaultK * depth);
}

TEST(BakeImplicitEdges, WhatIsCutFromAnImplicitFieldHasItsEdgesAndWalls) {
  // A ball cut out of half a maze: every voxel's value is at most what the distances to the two
  // surfaces allow.
  const FieldPtr maze = gyroid(Vec3(0.1 * kMm), 40 * kMm);
  const FieldPtr ball = sphere(Vec3(0.0), 30 * kMm);
  const FieldPtr both = intersect({maze, ball});
  const double voxel = 1 * kMm;
  const LevelSet grid = bake(*both, voxels(voxel, kCubicHalfWidth));
  std::uint64_t wrong_side = 0;
  double farthest = 0.0;
  for (auto value = grid.impl().grid->cbeginValueOn(); value; ++value) {
    const openvdb::Coord at = value.getCoord();
    const Vec3 p = Vec3(at.x(), at.y(), at.z()) * voxel;
    wrong_side += (*value < 0.0F) != (both->value(p) < 0.0) ? 1 : 0;
    // Inside, the distance is at most that to the ball's surface, where this is part of the
    // surface.
    const Vec3 on_ball = glm::length(p) > 0.0 ? 30 * kMm * glm::normalize(p) : Vec3(0.0);
    if (*value < 0.0F && maze->value(on_ball) < 0.0) {
      farthest = std::max(farthest, -*value * kMm - (30 * kMm - glm::length(p)));
    }
  }
  EXPECT_EQ(wrong_side, 0U);
  // Beside a medial axis a voxel knows the other side only through the closest points of its
  // neighbors, up to a voxel away: its distance is up to 1 / (2 d) too large, at some three voxels.
  EXPECT_LE(farthest, 0.17 * voxel);
  EXPECT_LE(gridField(grid)->lipschitz(), 3.0);
}

TEST(BakeImplicitEdges, NothingIsLeftBeyondTheFacesThatCutIt) {
  // The maze continues beyond the faces, and closest points are searched some distance beyond them.
  const Shape maze = shapes()[2];
  for (const double voxel : {2 * kMm, 1 * kMm, 0.7 * kMm}) {
    const LevelSet grid = bake(*maze.field, optionsOf(maze, voxel));
    const Box3 band = maze.box->grownBy(kCubicHalfWidth * voxel);
    std::uint64_t beyond = 0;
    for (auto value = grid.impl().grid->cbeginValueAll(); value; ++value) {
      if (!value.isValueOn() && *value > 0.0F) continue;
      const openvdb::CoordBBox at = value.getBoundingBox();
      const Vec3 lo = Vec3(at.min().x(), at.min().y(), at.min().z()) * voxel;
      const Vec3 hi = Vec3(at.max().x(), at.max().y(), at.max().z()) * voxel;
      beyond += band.contains(lo) && band.contains(hi) ? 0 : 1;
    }
    EXPECT_EQ(beyond, 0U) << voxel;
  }
}

}  // namespace
}  // namespace palpate::vdb
