// States with wrong bytes in them are refused, or used without harm.

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <cstring>
#include <random>

#include "lib/render/drive.h"
#include "palpate/render/haptic_renderer.h"
#include "support/field_contract.h"
#include "support/stored_trace.h"

namespace palpate::test {
namespace {

using Bytes = std::array<unsigned char, sizeof(RendererState)>;

RendererState damaged(const RendererState& state, std::mt19937& random) {
  Bytes bytes{};
  std::memcpy(bytes.data(), &state, sizeof state);
  const unsigned count = 1 + random() % 4;
  for (unsigned i = 0; i < count; ++i) {
    // Most of the numbers that stand for parts of the scene are at the front, and at the end,
    // behind those of the needle.
    const std::size_t at = random() % (random() % 2 == 0 ? 600 : bytes.size());
    unsigned char& byte = bytes[at];
    const unsigned how = random() % 4;
    const unsigned filled = how == 2 ? 255U : 0U;
    byte = static_cast<unsigned char>(how < 2 ? byte ^ (1U << (random() % 8)) : filled);
  }
  RendererState out;
  std::memcpy(static_cast<void*>(&out), bytes.data(), sizeof out);
  return out;
}

TEST(DamagedState, IsRefusedOrGoneOnFromWithoutHarm) {
  std::mt19937 random(19);
  int refused = 0;
  int taken = 0;
  for (const char* name : {"container", "csg", "slab", "valve_tube"}) {
    for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
      SCOPED_TRACE(name);
      const ScenePtr scene = sceneNamed(name);
      RendererSettings settings;
      settings.kind = kind;
      std::unique_ptr<HapticRenderer> hand;
      try {
        hand = makeRenderer(scene, settings);
      } catch (const Error&) {
        continue;  // not supported by the paper's renderer
      }
      const auto other = makeRenderer(scene, settings);
      int ticks = 0;
      for (const Vec3& p : pathThrough(*scene)) {
        (void)hand->update({p, Vec3(0.0)});
        if (++ticks % 50 != 0) continue;
        const RendererState state = hand->state();
        for (int i = 0; i < 40; ++i) {
          const RendererState wrong = damaged(state, random);
          (void)carryState(wrong, kind, *scene, *scene);
          if (!other->setState(wrong)) {
            ++refused;
            continue;
          }
          ++taken;
          for (int n = 0; n < 3; ++n) {
            const TickResult now = other->update({p - Vec3(0.0, 0.0, 1e-4 * n), Vec3(0.0)});
            ASSERT_TRUE(isFinite(now.force) && isFinite(now.proxy));
            ASSERT_LT(now.region, scene->regions().size());
          }
        }
      }
    }
  }
  std::printf("  %d states refused, %d taken\n", refused, taken);
  EXPECT_GT(refused, 100);
  EXPECT_GT(taken, 100);
}

}  // namespace
}  // namespace palpate::test
