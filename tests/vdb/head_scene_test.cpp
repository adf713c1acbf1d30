// The scanned head of data/scenes, region by region along the needle's path.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "folders/folders.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;

TEST(HeadScene, ANeedlePassesSkinBrainAndThalamusInThatOrder) {
  std::vector<GridRecord> grids;
  std::vector<std::string> notes;
  SceneRegistry registry;
  registerKinds(registry, {[&](const GridRecord& record) { grids.push_back(record); },
                           [&](const std::string& note) { notes.push_back(note); }});
  const ScenePtr scene =
      compile(readScene(palpate::test::sourceFolder() + "/data/scenes/head.yaml", registry));
  const auto naming = [&](const char* text) {
    return std::count_if(notes.begin(), notes.end(), [&](const std::string& note) {
      return note.find(text) != std::string::npos;
    });
  };
  EXPECT_EQ(naming("unit code 0"), 3) << "one for each file";
  EXPECT_EQ(naming("brain: "), 1) << "folds that bend within a voxel";
  EXPECT_EQ(notes.size(), 4U);
  EXPECT_GE(grids.size(), 3U);
  for (const GridRecord& grid : grids) {
    std::printf("  %-40s %9llu voxels, %6.1f MB, %.2f s\n", grid.what.c_str(),
                static_cast<unsigned long long>(grid.info.active_voxels),
                static_cast<double>(grid.info.memory) * 1e-6, grid.seconds);
  }

  const Vec3 from = Vec3(-100, -42, 60) * kMm;
  const Vec3 to = Vec3(-12, -18, 8) * kMm;
  const auto name_at = [&](const Vec3& p) { return scene->regions()[scene->regionAt(p)].name; };
  std::vector<std::string> order;
  for (int i = 0; i <= 1050; ++i) {
    const Vec3 p = from + (to - from) * (i / 1050.0);
    if (const std::string name = name_at(p); order.empty() || order.back() != name) {
      order.push_back(name);
      std::printf("  %s from %.1f mm\n", name.c_str(), glm::length(p - from) / kMm);
    }
  }
  EXPECT_EQ(order, (std::vector<std::string>{"outside", "skin", "brain", "thalamus"}));
  // The end is well inside: the tip does not touch the far wall.
  EXPECT_LT(scene->regions()[scene->regionNamed("thalamus")].field->value(to), -2 * kMm);

  // There and back at 50 mm/s: every port is open where the path crosses it, and no other wall is
  // passed.
  const std::unique_ptr<HapticRenderer> renderer = makeRenderer(scene);
  std::vector<std::string> felt;
  std::vector<std::string> passed;
  constexpr int kTicks = 2100;
  Vec3 last = from;
  for (int tick = 0; tick <= 2 * kTicks; ++tick) {
    const double share = 1.0 - std::abs(tick - kTicks) / static_cast<double>(kTicks);
    const Vec3 hip = from + share * (to - from);
    const TickResult result = renderer->update({hip, (hip - last) / 1e-3, 1e-3});
    last = hip;
    const std::string& name = scene->regions()[result.region].name;
    if (felt.empty() || felt.back() != name) felt.push_back(name);
    for (int e = 0; e < result.event_count; ++e) {
      passed.push_back(scene->ports()[result.events[static_cast<std::size_t>(e)]].name);
    }
    ASSERT_FALSE(result.contact) << "a wall is in the way at tick " << tick;
  }
  EXPECT_EQ(felt, (std::vector<std::string>{"outside", "skin", "brain", "thalamus", "brain", "skin",
                                            "outside"}));
  EXPECT_EQ(passed, (std::vector<std::string>{"incision", "opened_dura", "thalamus_surface",
                                              "thalamus_surface", "opened_dura", "incision"}));
}

}  // namespace
}  // namespace palpate::vdb
