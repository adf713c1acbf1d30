// Shells of random solids, a thousandth of a millimeter thin: no hand passes through, slow or fast.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/drive.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/random_hand.h"
#include "support/random_scene.h"

namespace palpate::test {
namespace {

struct Passage {
  int scenes = 0;
  int crossed = 0;
  long contacts = 0;
  std::string list;
};

/// [m] Within a nanometer of the surface the side is remembered, not measured.
constexpr double kOnSide = 1e-9;

/// [m] Signed distance of the proxy: positive outside the solid, negative in its hollow.
using Side = std::function<double(const Vec3&)>;

/// Flies around the solid at `speed` [m/s], with rests now and then; true if the proxy came to the
/// other side.
bool crosses(const ScenePtr& scene, const Side& side, const Vec3& start, double speed,
             double thickness, std::uint64_t seed, int ticks, long& contacts) {
  Random random(seed);
  Drive drive(scene);
  (void)drive.to(start);
  const bool was_outside = side(start) > 0.0;
  const double step = speed * Drive::kTick;
  Vec3 p = start;
  Vec3 goal = random.in({Vec3(-0.012), Vec3(0.012)});
  int resting = 0;
  for (int i = 0; i < ticks; ++i) {
    const Vec3 way = goal - p;
    const double left = glm::length(way);
    if (resting > 0) {
      --resting;
    } else if (left <= step) {
      p = goal;
      goal = random.in({Vec3(-0.018), Vec3(0.018)});
      resting = random.uniform(0.0, 1.0) < 0.2 ? 5 : 0;
    } else {
      p += (step / left) * way;
    }
    const TickResult& out = drive.to(p);
    contacts += out.contact ? 1 : 0;
    const double value = side(out.proxy);
    if (was_outside ? value < -kOnSide : value > kOnSide - thickness) return true;
  }
  return false;
}

Passage feelShells(double thickness_mm, double speed, int scenes, int ticks, std::uint64_t first) {
  Passage out;
  RandomSceneOptions hollow;
  hollow.shell = thickness_mm;
  for (std::uint64_t number = first; out.scenes < scenes; ++number) {
    const RandomScene scene = randomScene(number, hollow);
    SceneDescription description = scene.description();
    description.start_region = "outside";
    const ScenePtr compiled = compile(description);
    const testing::RegionTree tree(*compiled, kOutside);
    const auto start = roomyPoint(tree, number);
    if (!start) continue;
    // The solid whose surface the shell covers: positive outside, negative in the hollow.
    const FieldPtr solid = randomScene(number, hollow).solid();
    const Side side = [&](const Vec3& p) { return solid->value(p); };
    ++out.scenes;
    if (crosses(compiled, side, *start, speed, 1e-3 * thickness_mm, number, ticks, out.contacts)) {
      ++out.crossed;
      if (out.crossed <= 20) out.list += " " + std::to_string(number);
    }
  }
  return out;
}

void expectNonePasses(double thickness_mm, double speed, int ticks) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const Passage out = feelShells(thickness_mm, speed, slow ? 20'000 : 250, ticks, 1);
  std::printf("%d shells of %g mm at %g m/s, %ld ticks in contact: %d crossed%s\n", out.scenes,
              thickness_mm, speed, out.contacts, out.crossed, out.list.c_str());
  EXPECT_EQ(out.crossed, 0) << "scenes" << out.list;
  EXPECT_GT(out.contacts, out.scenes);
}

TEST(ThinCsgShells, OneMicrometerSlowly) { expectNonePasses(1e-3, 0.1, 200); }
TEST(ThinCsgShells, OneMicrometerFast) { expectNonePasses(1e-3, 5.0, 60); }
TEST(ThinCsgShells, ATenthOfAMillimeterFast) { expectNonePasses(0.1, 5.0, 60); }

TEST(ThinCsgShells, HollowToriFast) {
  // The shell must be thin everywhere, and enclose a hollow.
  int crossed = 0;
  for (std::uint64_t seed = 1; seed <= 200; ++seed) {
    Random random(seed);
    const Vec3 axis = random.direction();
    const FieldPtr ring =
        torus(Vec3(0.0), axis, random.uniform(0.008, 0.014), random.uniform(0.002, 0.006));
    SceneDescription description;
    LayerDescription layer;
    layer.name = "ring";
    layer.inside = std::make_shared<FieldSource>(shell(ring, 1e-6));
    description.layers.push_back(layer);
    const ScenePtr scene = compile(description);
    const testing::RegionTree tree(*scene, kOutside);
    const auto start = roomyPoint(tree, seed);
    ASSERT_TRUE(start);
    long contacts = 0;
    const Side side = [&](const Vec3& p) { return ring->value(p); };
    crossed += crosses(scene, side, *start, 5.0, 1e-6, seed, 100, contacts) ? 1 : 0;
  }
  EXPECT_EQ(crossed, 0) << "of 200";
}

}  // namespace
}  // namespace palpate::test
