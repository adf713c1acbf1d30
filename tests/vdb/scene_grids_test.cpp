// `grids` of a scene: formulas become grids where these are accurate enough and faster, and nowhere
// else.

#include <gtest/gtest.h>

#include <cmath>
#include <memory>

#include "palpate/core/error.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {
namespace {

constexpr double kTolerance = 20e-6;  // [m] as in the scenes below

class SceneGrids : public ::testing::Test {
 protected:
  ScenePtr sceneWith(const std::string& grids, const std::string& layers, const std::string& more) {
    grids_.clear();
    notes_.clear();
    registry_ = {};
    RegisterOptions options;
    options.on_grid = [this](const GridRecord& record) { grids_.push_back(record); };
    options.on_note = [this](const std::string& note) { notes_.push_back(note); };
    registerKinds(registry_, options);
    return compile(
        parseScene("palpate: 1\nlength: mm\n" + grids + layers + more, "test.yaml", registry_));
  }
  std::vector<GridRecord> grids_;
  std::vector<std::string> notes_;
  SceneRegistry registry_;
};

/// Thirty blended balls: far slower by formula than by grid.
std::string drops() {
  std::string text =
      "layers:\n  - name: drops\n    inside:\n      metaballs:\n        fall_off: "
      "inverse_square\n        iso: 6\n        balls:\n";
  for (int i = 0; i < 60; ++i) {
    text += "          - {center: [" + std::to_string(10.0 * std::sin(2.1 * i)) + ", " +
            std::to_string(10.0 * std::cos(1.3 * i)) + ", " +
            std::to_string(10.0 * std::sin(0.7 * i)) + "], radius: 6}\n";
  }
  return text;
}

TEST_F(SceneGrids, WhatIsSlowBecomesAGridWithinTheTolerance) {
  const ScenePtr formula = sceneWith("", drops(), "");
  EXPECT_TRUE(grids_.empty());
  const ScenePtr scene = sceneWith("grids: {tolerance: 0.02, voxel: 0.5}\n", drops(), "");
  ASSERT_EQ(grids_.size(), 1U) << (notes_.empty() ? "" : notes_.front());
  ASSERT_FALSE(notes_.empty()) << "a note tells the decision";
  const Field& grid = *scene->regions()[1].field;
  const Field& exact = *formula->regions()[1].field;
  // Both surfaces along rays from the middle, found by bisection.
  for (int i = 0; i < 200; ++i) {
    const double z = -1.0 + (2.0 * i + 1.0) / 200.0;
    const Vec3 u(std::sqrt(1.0 - z * z) * std::cos(2.4 * i),
                 std::sqrt(1.0 - z * z) * std::sin(2.4 * i), z);
    const auto surface = [&](const Field& field) {
      double inside = 0.0;
      double outside = 0.06;
      for (int k = 0; k < 50; ++k) {
        const double middle = 0.5 * (inside + outside);
        (field.value(middle * u) < 0.0 ? inside : outside) = middle;
      }
      return inside;
    };
    // Along a ray the distance between two surfaces is larger than the perpendicular one, by 1 /
    // cos of the angle.
    EXPECT_NEAR(surface(grid), surface(exact), 3.0 * kTolerance) << i;
  }
}

TEST_F(SceneGrids, WhatIsFastOrKeptOrOnAPortStaysAFormula) {
  const std::string ball =
      "layers: [{name: ball, inside: {sphere: {center: [0, 0, 0], radius: 20}}}]\n";
  (void)sceneWith("grids: {tolerance: 0.02}\n", ball, "");
  EXPECT_TRUE(grids_.empty()) << "nothing is faster than a sphere";
  (void)sceneWith("grids: {tolerance: 0.02, voxel: 0.5, keep: [\"dr*\"]}\n", drops(), "");
  EXPECT_TRUE(grids_.empty()) << "kept";
  (void)sceneWith("grids: {tolerance: 1e-9, voxel: 2}\n", drops(), "");
  EXPECT_TRUE(grids_.empty()) << "no grid is as exact";
  std::string named = drops();
  named.replace(0, named.find("metaballs"), "fields:\n  blob:\n    ");
  const std::string port =
      "layers: [{name: drops, inside: blob}]\nports: [{name: p, between: [outside, drops], on: "
      "blob}]\n";
  const ScenePtr scene = sceneWith("grids: {tolerance: 0.02, voxel: 0.5}\n", named, port);
  EXPECT_TRUE(grids_.empty()) << "a port is on it";
  EXPECT_FALSE(scene->ports()[0].on.empty());
}

TEST_F(SceneGrids, WithoutEndItStaysAFormulaWithANote) {
  const ScenePtr scene = sceneWith(
      "grids: {tolerance: 0.02}\n",
      "layers: [{name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}}]\n", "");
  EXPECT_TRUE(grids_.empty());
  ASSERT_EQ(notes_.size(), 1U);
  EXPECT_NE(notes_[0].find("floor stays a formula"), std::string::npos) << notes_[0];
  EXPECT_EQ(scene->regionAt({0.0, 0.0, -1.0}), 1);
}

}  // namespace
}  // namespace palpate::vdb
