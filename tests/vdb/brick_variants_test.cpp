// The same bricks with every instruction set and from several threads.

#include <gtest/gtest.h>

#include <array>
#include <cstdlib>
#include <thread>
#include <vector>

#include "brick/brick_field.h"
#include "palpate/core/error.h"
#include "support/field_contract.h"
#include "vdb/noise_grid.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using openvdb::Coord;
using palpate::test::Random;

constexpr double kVoxel = kNoiseVoxel;

TEST(Bricks, AllInstructionSetsAgree) {
  const LevelSet grid = noiseGrid({Coord(0)}, 14);
  for (const Sampler sampler : {Sampler::kCubic, Sampler::kTrilinear}) {
    const BrickField base(grid, sampler, InstructionSet::kBase);
    for (const InstructionSet set : instructionSets()) {
      const BrickField other(grid, sampler, set);
      Random random(7);
      for (int i = 0; i < 2000; ++i) {
        const Vec3 p = kVoxel * random.in({Vec3(-25.0), Vec3(25.0)});
        const FieldJet a = base.jet(p);
        const FieldJet b = other.jet(p);
        ASSERT_EQ(a.in_band, b.in_band);
        ASSERT_NEAR(a.value / kVoxel, b.value / kVoxel, 1e-12);  // sums of 64 doubles
        ASSERT_LE(glm::distance(a.gradient, b.gradient), 1e-12);
        ASSERT_NEAR(other.sample(p).value / kVoxel, b.value / kVoxel, 1e-13);
        if (sampler == Sampler::kTrilinear) continue;  // its Hessian is a difference of gradients
        for (int n = 0; n < 3; ++n) {
          ASSERT_LE(glm::distance(a.hessian[n], b.hessian[n]) * kVoxel, 1e-12);
        }
      }
    }
  }
}

TEST(Bricks, TheEnvironmentChoosesTheInstructionSet) {
  ASSERT_EQ(setenv("PALPATE_INSTRUCTION_SET", "base", 1), 0);
  EXPECT_EQ(chosenInstructionSet(), InstructionSet::kBase);
  ASSERT_EQ(setenv("PALPATE_INSTRUCTION_SET", "sse9", 1), 0);
  try {
    static_cast<void>(chosenInstructionSet());
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "bricks.instruction_set");
    EXPECT_NE(error.problem().message.find("sse9"), std::string::npos);
  }
  ASSERT_EQ(unsetenv("PALPATE_INSTRUCTION_SET"), 0);
  EXPECT_EQ(chosenInstructionSet(), instructionSets().back()) << "the best there is";
}

TEST(Bricks, TwoThreadsGetWhatOneGets) {
  const FieldPtr field = gridField(bake(*torus(10e-3, 4e-3), voxels(kVoxel)));
  std::vector<Vec3> points;
  Random random(8);
  for (int i = 0; i < 20000; ++i) points.push_back(random.in(field->bounds().grownBy(3e-3)));
  const auto run = [&](std::vector<double>& values) {
    for (const Vec3& p : points) values.push_back(field->sample(p).value + field->jet(p).value);
  };
  std::vector<double> alone;
  std::array<std::vector<double>, 2> together;
  run(alone);
  std::thread first([&] { run(together[0]); });
  std::thread second([&] { run(together[1]); });
  first.join();
  second.join();
  EXPECT_EQ(alone, together[0]);
  EXPECT_EQ(alone, together[1]);
}

}  // namespace
}  // namespace palpate::vdb
