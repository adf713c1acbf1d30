// Bakes that are refused, and how a bake is stopped.

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <thread>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "support/error_of.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)

Error bakeError(const FieldPtr& field, const BakeOptions& options) {
  return errorOf([&] { static_cast<void>(bake(*field, options)); });
}

TEST(BakeLimits, OptionsAreChecked) {
  const FieldPtr ball = sphere(Vec3(0.0), 5e-3);
  for (const double bad : {0.0, -1e-3, std::nan(""), kInfinity}) {
    EXPECT_EQ(bakeError(ball, voxels(bad)).problem().code, "bake.voxel_size");
  }
  for (const double bad : {1.9, -4.0, std::nan(""), 1e9}) {
    EXPECT_EQ(bakeError(ball, voxels(1e-3, bad)).problem().code, "bake.half_width");
  }
  BakeOptions options = voxels(1e-3);
  options.length_unit = "furlong";
  EXPECT_EQ(bakeError(ball, options).problem().code, "unit.unknown");
  options = voxels(1e-3);
  options.box = Box3{};
  EXPECT_EQ(bakeError(ball, options).problem().code, "bake.box");
}

TEST(BakeLimits, UnboundedNeedsABox) {
  const Error error = bakeError(halfSpace(Vec3(0.0), Vec3(0.0, 0.0, 1.0)), voxels(1e-3));
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "bake.unbounded");
  EXPECT_NE(error.problem().hint.find("box"), std::string::npos);
}

TEST(BakeLimits, ShapeThinnerThanVoxelsIsRefused) {
  // A plate of a tenth of a voxel, between two layers of voxels.
  const Error error =
      bakeError(box(Vec3(0.0, 0.0, 0.5e-3), Vec3(20e-3, 20e-3, 0.1e-3)), voxels(1e-3));
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  EXPECT_EQ(error.problem().code, "bake.empty");
  EXPECT_NE(error.problem().message.find("1 mm"), std::string::npos);
  EXPECT_NE(error.problem().hint.find("third"), std::string::npos);
}

TEST(BakeLimits, NothingInTheBoxIsRefused) {
  BakeOptions options = voxels(1e-3);
  options.box = Box3{Vec3(0.1), Vec3(0.2)};
  EXPECT_EQ(bakeError(sphere(Vec3(0.0), 5e-3), options).problem().code, "bake.empty");
}

TEST(BakeLimits, FieldThatIsNoNumberIsRefused) {
  const auto function = [](const Vec3& p) {
    const double value = glm::length(p) - 5e-3;
    return FieldSample{p.x > 4.6e-3 ? std::nan("") : value, p, true};
  };
  const FunctionField field(function, {{Vec3(-5e-3), Vec3(5e-3)}});
  const Error error = errorOf([&] { static_cast<void>(bake(field, voxels(0.5e-3))); });
  EXPECT_EQ(error.problem().code, "bake.not_finite");
}

TEST(BakeLimits, MemoryIsRefusedBeforeItIsTaken) {
  // A million voxels across: some 10^13 voxels in the band.
  const Error error = bakeError(sphere(Vec3(0.0), 50e-3), voxels(0.1e-6));
  EXPECT_EQ(error.kind(), ErrorKind::kOperation);
  EXPECT_EQ(error.problem().code, "bake.memory");
  EXPECT_NE(error.problem().message.find("0.0001 mm"), std::string::npos);
  // No lattice has numbers for such voxels: however large the memory, the given size is wrong.
  EXPECT_EQ(bakeError(sphere(Vec3(0.0), 50e-3), voxels(1e-12)).kind(), ErrorKind::kInput);
}

TEST(BakeLimits, SuggestedVoxelSizeFits) {
  const FieldPtr ball = sphere(Vec3(0.0), 20e-3);
  for (const std::uint64_t limit : {20'000'000U, 100'000'000U}) {
    BakeOptions options = voxels(0.01e-3);
    options.max_memory = limit;
    const Error error = bakeError(ball, options);
    ASSERT_EQ(error.problem().code, "bake.memory");
    const std::string& hint = error.problem().hint;
    ASSERT_TRUE(hint.starts_with("voxels of "));
    const double suggested = std::stod(hint.substr(10)) * 1e-3;
    options.voxel_size = suggested;
    const LevelSet set = bake(*ball, options);
    EXPECT_LE(set.info().memory, limit);
    // The suggestion is not wastefully large either: half that size would take four times the
    // memory.
    options.voxel_size = suggested / 2.0;
    EXPECT_EQ(bakeError(ball, options).problem().code, "bake.memory");
  }
}

// The estimate in advance is close to the memory that is taken, so that a limit refuses neither too
// much nor too little.
TEST(BakeLimits, TheEstimateIsCloseToWhatIsTaken) {
  const FieldPtr ball = sphere(Vec3(0.0), 20e-3);
  const FieldPtr holes = subtract({ball, torus(15e-3, 6e-3), sphere(Vec3(0.0), 8e-3)});
  for (const FieldPtr& shape : {ball, holes}) {
    for (const double half_width : {3.0, 6.0}) {
      BakeOptions options = voxels(0.2e-3, half_width);
      const auto taken = static_cast<double>(bake(*shape, options).info().memory);
      // The eight upper nodes of the tree, of 0.3 MB each, are counted however small the grid is.
      options.max_memory = static_cast<std::uint64_t>(1.25 * taken + 2.4e6);
      EXPECT_NO_THROW(static_cast<void>(bake(*shape, options)));
      options.max_memory = static_cast<std::uint64_t>(0.95 * taken);
      EXPECT_EQ(bakeError(shape, options).problem().code, "bake.memory");
    }
  }
}

TEST(BakeLimits, NoVoxelSizeFitsIntoNothing) {
  BakeOptions options = voxels(1e-3);
  options.max_memory = 1000;
  const Error error = bakeError(sphere(Vec3(0.0), 20e-3), options);
  EXPECT_EQ(error.problem().code, "bake.memory");
  EXPECT_TRUE(error.problem().hint.starts_with("allow more than 0.0")) << error.what();
}

TEST(BakeLimits, ProgressComesOnTheCallingThread) {
  double last = -1.0;
  int calls = 0;
  const auto here = std::this_thread::get_id();
  const LevelSet set =
      bake(*sphere(Vec3(0.0), 20e-3), voxels(0.3e-3), [&](std::string_view what, double fraction) {
        EXPECT_EQ(std::this_thread::get_id(), here);
        EXPECT_FALSE(what.empty());
        EXPECT_LE(fraction, 1.0);
        EXPECT_GE(fraction, last);
        last = fraction;
        ++calls;
        return true;
      });
  EXPECT_GT(calls, 4);
  EXPECT_EQ(last, 1.0);
}

TEST(BakeLimits, CanBeStoppedAtAnyReport) {
  const FieldPtr ball = sphere(Vec3(0.0), 10e-3);
  int reports = 0;
  static_cast<void>(bake(*ball, voxels(0.3e-3), [&](std::string_view, double) {
    ++reports;
    return true;
  }));
  for (const int stop_at : {0, 1, reports / 2}) {
    int calls = 0;
    const Error error = errorOf([&] {
      static_cast<void>(
          bake(*ball, voxels(0.3e-3), [&](std::string_view, double) { return calls++ < stop_at; }));
    });
    EXPECT_EQ(error.kind(), ErrorKind::kCancelled);
    EXPECT_EQ(calls, stop_at + 1);
  }
}

}  // namespace
}  // namespace palpate::vdb
