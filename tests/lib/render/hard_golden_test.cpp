// In any scene, two runs of a long mixed trajectory agree bit for bit, and no tick allocates, locks
// or throws.

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "lib/render/hard_judge.h"
#include "lib/render/shake.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "support/alloc_guard.h"

namespace palpate::test {
namespace {

struct Golden {
  const char* name;
  ScenePtr scene;
};

ScenePtr sheetAndPlate() {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "plate";
  layer.inside = std::make_shared<FieldSource>(box(mm(0, 0, 20), mm(80, 80, 0.1)));
  description.layers.push_back(layer);
  SheetDescription sheet;
  sheet.name = "leaf";
  sheet.on = std::make_shared<FieldSource>(sphere(mm(0, 0, -20), 0.04));
  sheet.where = std::make_shared<FieldSource>(halfSpace(Vec3(0.0), Vec3(0, 0, -1)));
  description.sheets.push_back(sheet);
  return compile(description);
}

std::vector<Golden> goldens() {
  Material rough;
  rough.stiffness = 800.0;
  rough.damping = 2.0;
  rough.friction = {0.4, 0.3};
  rough.texture = {0.1e-3, 2e-3};
  rough.shading = 1e-3;
  QuadricCoefficients waist;
  waist.xx = waist.yy = 1.0;
  waist.zz = -1.0;
  waist.constant = -0.02 * 0.02;
  std::vector<FieldPtr> balls;
  Random random(1);
  for (int i = 0; i < 100; ++i)
    balls.push_back(sphere(random.in({Vec3(-0.04), Vec3(0.04)}), 0.006));
  const FieldPtr saddle =
      metaballs({{mm(-15, 0, 0), 0.04, 1.0}, {mm(15, 0, 0), 0.04, 1.0}}, FallOff::kWyvill, 0.6);
  return {{"container", sceneNamed("container")},
          {"ball", sceneOfSolid(sphere(Vec3(0.0), 0.03), false, rough)},
          {"room", sceneOfSolid(box(Vec3(0.0), mm(60, 40, 20)), true, rough)},
          {"torus", sceneOfSolid(torus(Vec3(0.0), Vec3(0, 0, 1), 0.03, 0.01))},
          {"cone", sceneOfSolid(cone(mm(0, 0, -20), Vec3(0, 0, 1), 0.02, 0.04), true)},
          {"heart", sceneOfSolid(heart(Vec3(0.0), 0.06))},
          {"metaballs", sceneOfSolid(saddle, false, rough)},
          {"waist", sceneOfSolid(quadric(Vec3(0.0), waist, 0.2))},
          {"gyroid",
           sceneOfSolid(intersect({gyroidWall(Vec3(0.0), 0.04, 0.004), sphere(Vec3(0.0), 0.03)}))},
          {"blend", sceneOfSolid(smoothUnite(
                        {box(Vec3(0.0), mm(40, 40, 10)), sphere(mm(0, 0, 10), 0.012)}, 0.005))},
          {"hundred balls", sceneOfSolid(unite(balls))},
          {"sheet and plate", sheetAndPlate()}};
}

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

/// Walks, presses, jumps and rests around the scene; now and then a broken position, or a reset.
std::vector<Vec3> mixed(const Scene& scene, int ticks) {
  Box3 box = scene.bounds();
  if (!box.isBounded()) box = {Vec3(-0.04), Vec3(0.04)};
  Hand hand(91, box.grownBy(0.01));
  std::vector<Vec3> path;
  path.reserve(static_cast<std::size_t>(ticks));
  for (int i = 0; i < ticks; ++i) path.push_back(i % 997 == 996 ? Vec3(kNan) : hand.next());
  return path;
}

std::array<std::uint64_t, 6> bitsOf(const TickResult& r) {
  return {std::bit_cast<std::uint64_t>(r.force.x), std::bit_cast<std::uint64_t>(r.force.y),
          std::bit_cast<std::uint64_t>(r.force.z), std::bit_cast<std::uint64_t>(r.proxy.x),
          std::bit_cast<std::uint64_t>(r.proxy.y), std::bit_cast<std::uint64_t>(r.proxy.z)};
}

TEST(HardGolden, TwoRunsAreBitEqualAndNoTickAllocates) {
  const std::vector<Golden> once = goldens();
  const std::vector<Golden> again = goldens();  // compiled anew: addresses must not matter
  for (std::size_t s = 0; s < once.size(); ++s) {
    SCOPED_TRACE(once[s].name);
    const std::vector<Vec3> path = mixed(*once[s].scene, kTicks / 25);
    RendererSettings settings;
    settings.limits = {20.0, 1e4, 0.1};
    const auto a = makeRenderer(once[s].scene, settings);
    const auto b = makeRenderer(again[s].scene, settings);
    int contacts = 0;
    int different = 0;
    Vec3 last = path[0];
    const testing::AllocGuard guard;
    for (const Vec3& p : path) {
      const Vec3 velocity = isFinite(p) ? 1e3 * (p - last) : Vec3(0.0);
      if (isFinite(p)) last = p;
      const TickResult first = a->update({p, velocity});
      const TickResult second = b->update({p, velocity});
      contacts += first.contact ? 1 : 0;
      const bool same = bitsOf(first) == bitsOf(second) && first.region == second.region &&
                        first.contact == second.contact && first.events == second.events &&
                        first.event_count == second.event_count;
      different += same ? 0 : 1;
    }
    EXPECT_EQ(guard.violations(), 0);
    EXPECT_EQ(different, 0);
    EXPECT_GT(contacts, static_cast<int>(path.size()) / 20);
  }
}

TEST(HardGolden, ForcesStayFiniteCappedAndOutsideWalls) {
  for (const Golden& golden : goldens()) {
    SCOPED_TRACE(golden.name);
    const std::vector<Vec3> path = mixed(*golden.scene, kTicks / 25);
    RendererSettings settings;
    settings.limits.max_force = 8.0;
    const auto renderer = makeRenderer(golden.scene, settings);
    int astray = 0;
    for (const Vec3& p : path) {
      const TickResult out = renderer->update({p, Vec3(0.0)});
      ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy));
      ASSERT_LE(glm::length(out.force), 8.0 * (1.0 + 1e-12));
      astray += isAt(*golden.scene, out.region, out.proxy, 2e-8) ? 0 : 1;
    }
    EXPECT_EQ(astray, 0);
  }
}

}  // namespace
}  // namespace palpate::test
