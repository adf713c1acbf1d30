// The grid's field compared with OpenVDB's own samplers, and rules that it must keep while
// sampling.

#include <gtest/gtest.h>
#include <openvdb/math/Stencils.h>
#include <openvdb/tools/Interpolation.h>

#include <cmath>
#include <random>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/openvdb_access.h"
#include "support/alloc_guard.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

std::vector<Vec3> pointsIn(double half_size, int count) {
  std::mt19937_64 engine(17);
  std::uniform_real_distribution<double> coordinate(-half_size, half_size);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) {
    const double x = coordinate(engine), y = coordinate(engine);
    points.emplace_back(x, y, coordinate(engine));
  }
  return points;
}

class GridRivals : public ::testing::TestWithParam<Sampler> {};
INSTANTIATE_TEST_SUITE_P(Trilinear, GridRivals,
                         ::testing::Values(Sampler::kAccessor, Sampler::kTrilinear));

TEST_P(GridRivals, SameAsOpenVdbsTrilinearStencil) {
  const LevelSet set =
      bake(*subtract({sphere(Vec3(0.0), 10e-3), torus(9e-3, 3e-3)}), voxels(0.5e-3));
  const FieldPtr field = gridField(set, GetParam());
  const openvdb::FloatGrid& grid = *set.impl().grid;
  openvdb::math::BoxStencil<openvdb::FloatGrid> stencil(grid);
  int checked = 0;
  for (const Vec3& p : pointsIn(14e-3, 20000)) {
    const FieldSample sample = field->sample(p);
    if (!sample.in_band) continue;
    ++checked;
    const openvdb::Vec3d at(p.x / 0.5e-3, p.y / 0.5e-3, p.z / 0.5e-3);
    stencil.moveTo(openvdb::Coord::floor(at));
    // OpenVDB interpolates in floats: errors are a few units in the last place of the band's 2 mm.
    const openvdb::Vec3f where(at);
    ASSERT_NEAR(sample.value * 1e3, stencil.interpolation(where), 1e-5);
    const openvdb::Vec3f gradient = stencil.gradient(where);
    ASSERT_NEAR(sample.gradient.x, gradient.x(), 1e-4);
    ASSERT_NEAR(sample.gradient.y, gradient.y(), 1e-4);
    ASSERT_NEAR(sample.gradient.z, gradient.z(), 1e-4);
    ASSERT_NEAR(sample.value * 1e3, openvdb::tools::BoxSampler::sample(grid.tree(), at), 1e-5);
  }
  EXPECT_GT(checked, 4000);
}

TEST(GridRivalsAll, SamplingAllocatesNothing) {
  const LevelSet set = bake(*sphere(Vec3(0.0), 10e-3), voxels(0.5e-3));
  const std::vector<FieldPtr> fields{gridField(set), gridField(set, Sampler::kTrilinear),
                                     gridField(set, Sampler::kAccessor)};
  const std::vector<Vec3> points = pointsIn(15e-3, 1000);
  double sum = 0.0;
  std::int64_t violations = -1;
  {
    const palpate::testing::AllocGuard guard;
    for (const FieldPtr& grid : fields) {
      for (const Vec3& p : points) sum += grid->sample(p).value + grid->jet(p).value;
    }
    violations = guard.violations();
  }
  EXPECT_EQ(violations, 0);
  EXPECT_TRUE(std::isfinite(sum));
}

}  // namespace
}  // namespace palpate::vdb
