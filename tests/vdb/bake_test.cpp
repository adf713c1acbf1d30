// The voxels that a bake produces, examined one by one.

#include "palpate/vdb/bake.h"

#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include <cmath>
#include <ostream>
#include <string>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/openvdb_access.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using openvdb::CoordBBox;
using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

struct BakeCase {
  std::string name;
  FieldPtr field;
  double voxel;  // [m]
  /// The expected values of voxels, computed independently of the bake; the field's own value if
  /// empty.
  std::function<double(const Vec3&)> expected = {};
  std::optional<Box3> box = {};
  double half_width = 3.5;
};

void PrintTo(const BakeCase& bake_case, std::ostream* out) { *out << bake_case.name; }

std::vector<BakeCase> cases() {
  const FieldPtr ball = sphere(Vec3(0.3e-3, -0.2e-3, 0.1e-3), 9e-3);
  const FieldPtr ring = torus(10e-3, 3e-3);
  const FieldPtr brick = box(Vec3(2e-3, 1e-3, -3e-3), Vec3(21e-3, 9e-3, 13e-3));
  // A wedge of 20 degrees: beyond its tip the maximum of the two distances stays far below the
  // distance to the tip, so that the band would extend far beyond the bounds.
  const double s = std::sin(0.17), c = std::cos(0.17);
  const FieldPtr wedge =
      intersect({halfSpace(Vec3(0.0), Vec3(-s, c, 0.0)), halfSpace(Vec3(0.0), Vec3(-s, -c, 0.0)),
                 box(Vec3(10e-3, 0.0, 0.0), Vec3(20e-3, 20e-3, 10e-3))});
  const Box3 corner{Vec3(-4e-3, -20e-3, -20e-3), Vec3(20e-3, 5e-3, 20e-3)};
  const auto signed_box = [](const Box3& b, const Vec3& p) {
    const Vec3 q = glm::max(b.lo - p, p - b.hi);
    return glm::length(glm::max(q, Vec3(0.0))) + std::min(std::max({q.x, q.y, q.z}), 0.0);
  };
  return {
      {"ball", ball, 0.5e-3},
      {"ball_fine", ball, 0.17e-3},
      {"wide_band", ball, 0.5e-3, {}, {}, 9.0},
      {"ring", ring, 0.4e-3},
      {"brick", brick, 0.5e-3},
      {"far_from_origin", sphere(Vec3(1.2345, -0.7, 3.3), 4e-3), 0.5e-3},
      {"holes", subtract({brick, ball, ring}), 0.4e-3,
       [=](const Vec3& p) {
         const double own = std::max({brick->value(p), -ball->value(p), -ring->value(p)});
         return brick->bounds().contains(p) ? own : std::max(own, brick->bounds().distanceTo(p));
       }},
      {"wedge", wedge, 0.5e-3,
       [=](const Vec3& p) {
         const double own = wedge->value(p);
         return wedge->bounds().contains(p) ? own : std::max(own, wedge->bounds().distanceTo(p));
       }},
      {"implicit", implicitBall(8e-3), 0.4e-3,
       // With true distances the band ends by itself; no value outside the bounds is raised.
       [](const Vec3& p) { return glm::length(p) - 8e-3; }},
      {"cut_by_a_box", ball, 0.5e-3,
       [=](const Vec3& p) {
         const Box3 domain = corner.intersectedWith(ball->bounds());
         return std::max(ball->value(p), signed_box(domain, p));
       },
       corner},
      {"unbounded", halfSpace(Vec3(0.1e-3), Vec3(1.0, 2.0, 3.0)), 0.5e-3,
       [=](const Vec3& p) {
         const Vec3 n = glm::normalize(Vec3(1.0, 2.0, 3.0));
         return std::max(glm::dot(p - Vec3(0.1e-3), n), signed_box(corner, p));
       },
       corner},
      {"inside_out", complement(ball), 0.5e-3,
       [=](const Vec3& p) {
         return std::max(-ball->value(p), signed_box({Vec3(-12e-3), Vec3(12e-3)}, p));
       },
       Box3{Vec3(-12e-3), Vec3(12e-3)}},
  };
}

class BakeField : public testing::TestWithParam<BakeCase> {};

// Compares every voxel of a block much larger than the shape, in the band or not, with the
// definition. This shows that culling misses no voxel of the band, and that tiles and background
// have the right sign.
TEST_P(BakeField, EveryVoxelHoldsWhatItShould) {
  const BakeCase& given = GetParam();
  BakeOptions options = voxels(given.voxel, given.half_width);
  options.box = given.box;
  const LevelSet set = bake(*given.field, options);
  const openvdb::FloatGrid& grid = *set.impl().grid;
  const float background = grid.background();
  ASSERT_FLOAT_EQ(background, static_cast<float>(given.half_width * given.voxel * 1e3));
  CoordBBox block = grid.evalActiveVoxelBoundingBox();
  block.expand(12);
  auto accessor = grid.getConstAccessor();
  std::size_t active = 0, negative = 0, checked = 0;
  for (auto at = block.begin(); at; ++at) {
    const Vec3 p = Vec3((*at).x(), (*at).y(), (*at).z()) * given.voxel;
    const double expected = 1e3 * (given.expected ? given.expected(p) : given.field->value(p));
    float value = 0.0F;
    const bool is_active = accessor.probeValue(*at, value);
    active += is_active ? 1 : 0;
    negative += value < 0.0F ? 1 : 0;
    ++checked;
    // Half a unit in the last place of a float, plus the effect of another order of operations on
    // positions: a few units in the last place of a double. A closest point is refined until the
    // error is a millionth of a voxel.
    const double left = given.field->metric() == Metric::kExact ? 0.0 : 1e-6 * 1e3 * given.voxel;
    const double rounding =
        0.5 * std::ldexp(std::abs(expected), -23) + 1e3 * 1e-15 * (glm::length(p) + 1e-3) + left;
    // May be active or not
    if (std::abs(std::abs(expected) - background) <= 2.0 * rounding) continue;
    ASSERT_EQ(is_active, std::abs(expected) < background) << *at << " " << expected;
    if (is_active) {
      ASSERT_NEAR(value, expected, 1.01 * rounding) << *at;
    } else {
      ASSERT_EQ(value, expected < 0.0 ? -background : background) << *at << " " << expected;
    }
  }
  EXPECT_EQ(active, grid.activeVoxelCount());
  EXPECT_EQ(active, set.info().active_voxels);
  EXPECT_GT(negative, 0U);
  EXPECT_LT(negative, checked);
}

INSTANTIATE_TEST_SUITE_P(Shapes, BakeField, testing::ValuesIn(cases()),
                         [](const auto& with) { return with.param.name; });

std::vector<std::pair<Coord, float>> activeVoxels(const LevelSet& set) {
  std::vector<std::pair<Coord, float>> all;
  for (auto value = set.impl().grid->cbeginValueOn(); value; ++value) {
    all.emplace_back(value.getCoord(), *value);
  }
  return all;
}

TEST(BakeField, DoesNotDependOnThreads) {
  const FieldPtr shape = subtract({sphere(Vec3(0.0), 12e-3), torus(10e-3, 3e-3)});
  std::vector<LevelSet> results;
  for (const std::size_t threads : {1U, 2U, 4U}) {
    const tbb::global_control limit(tbb::global_control::max_allowed_parallelism, threads);
    results.push_back(bake(*shape, voxels(0.3e-3)));
  }
  // With a progress function the work is divided into other pieces.
  results.push_back(bake(*shape, voxels(0.3e-3), [](std::string_view, double) { return true; }));
  const auto first = activeVoxels(results.front());
  for (const LevelSet& other : results) {
    EXPECT_TRUE(results.front().impl().grid->tree().hasSameTopology(other.impl().grid->tree()));
    EXPECT_TRUE(first == activeVoxels(other));
  }
}

TEST(BakeField, GridSaysWhatItIs) {
  BakeOptions options = voxels(0.25e-3, 3.0);
  options.name = "skin/surface";
  options.metadata = {{"layer", "skin"}, {"source", "a test"}, {"frame", "RAS"}};
  const LevelSet set = bake(*sphere(Vec3(0.0), 5e-3), options);
  const openvdb::FloatGrid& grid = *set.impl().grid;
  EXPECT_EQ(grid.getName(), "skin/surface");
  EXPECT_EQ(grid.getGridClass(), openvdb::GRID_LEVEL_SET);
  EXPECT_EQ(grid.metaValue<std::string>("length_unit"), "mm");
  EXPECT_EQ(grid.metaValue<std::string>("frame"), "RAS");
  EXPECT_EQ(grid.metaValue<std::string>("layer"), "skin");
  EXPECT_FALSE(grid.metaValue<std::string>("palpate:version").empty());
  EXPECT_EQ(grid.voxelSize(), openvdb::Vec3d(0.25));
  EXPECT_EQ(grid.indexToWorld(Coord(0)), openvdb::Vec3d(0.0));

  const LevelSetInfo& info = set.info();
  EXPECT_EQ(info.name, "skin/surface");
  EXPECT_EQ(info.voxel_size, 0.25e-3);
  EXPECT_EQ(info.half_width, 3.0);
  EXPECT_EQ(info.length_unit, "mm");
  EXPECT_EQ(info.metadata.at("source"), "a test");
  EXPECT_GT(info.memory, info.active_voxels * sizeof(float));
  // The band ends less than a voxel before 5 + 3 * 0.25 mm.
  EXPECT_NEAR(info.bounds.hi.x, 5.5e-3, 1e-12);
  EXPECT_NEAR(info.bounds.lo.z, -5.5e-3, 1e-12);

  const LevelSet renamed = set.named("bone/surface", {{"layer", "bone"}});
  EXPECT_EQ(renamed.info().name, "bone/surface");
  EXPECT_EQ(renamed.info().metadata.at("layer"), "bone");
  EXPECT_EQ(renamed.impl().grid->getName(), "bone/surface");
  EXPECT_EQ(&renamed.impl().grid->tree(), &grid.tree());
  EXPECT_EQ(grid.getName(), "skin/surface");
}

TEST(BakeField, OtherLengthUnitsHoldTheSameShape) {
  const FieldPtr ball = sphere(Vec3(0.0), 5e-3);
  BakeOptions options = voxels(0.25e-3);
  const auto in_mm = activeVoxels(bake(*ball, options));
  options.length_unit = "m";
  const LevelSet set = bake(*ball, options);
  const auto in_m = activeVoxels(set);
  EXPECT_DOUBLE_EQ(set.impl().grid->voxelSize().x(), 0.25e-3);
  EXPECT_EQ(set.info().voxel_size, 0.25e-3);
  ASSERT_EQ(in_mm.size(), in_m.size());
  for (std::size_t i = 0; i < in_m.size(); ++i) {
    ASSERT_EQ(in_mm[i].first, in_m[i].first);
    ASSERT_FLOAT_EQ(in_mm[i].second, 1000.0F * in_m[i].second);
  }
}

// A grid baked again, finer and wider: where the first grid knows only a bound of the distance, the
// second has no active voxel.
TEST(BakeField, GridBakedAgainKeepsToWhatItKnew) {
  const LevelSet coarse = bake(*sphere(Vec3(0.0), 8e-3), voxels(0.5e-3, 4.0));
  const FieldPtr known = gridField(coarse);
  const LevelSet fine = bake(*known, voxels(0.2e-3, 12.0));
  EXPECT_GT(fine.info().active_voxels, coarse.info().active_voxels);
  for (const auto& [at, value] : activeVoxels(fine)) {
    const Vec3 p = Vec3(at.x(), at.y(), at.z()) * 0.2e-3;
    // S / |grad S| of a trilinear cell: its gradient differs from the true direction by the turn
    // over half a voxel, 0.5 / 2 / 6 of a radian at the inner end of the band.
    ASSERT_NEAR(value * 1e-3, glm::length(p) - 8e-3, 0.04 * std::abs(value) * 1e-3 + 0.02e-3);
  }
}

}  // namespace
}  // namespace palpate::vdb
