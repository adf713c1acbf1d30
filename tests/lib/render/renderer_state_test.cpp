// All that a tick leaves for the next is one value: another renderer of the scene that is given it
// goes on in the same way.

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "lib/render/drive.h"
#include "palpate/render/tick_state.h"
#include "support/alloc_guard.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

/// A hand's path in and out of the scene's bounds, with rests, jumps and slow stretches.
std::vector<HipState> wander(const Scene& scene, std::uint64_t seed, int ticks) {
  Box3 box = scene.bounds();
  if (!box.isBounded()) box = {Vec3(-0.04), Vec3(0.04)};
  Random random(seed);
  const auto place = [&] {
    return box.center() + 0.65 * box.size() * random.in({Vec3(-1.0), Vec3(1.0)});
  };
  std::vector<HipState> out;
  Vec3 from = place();
  Vec3 last = from;
  while (static_cast<int>(out.size()) < ticks) {
    const Vec3 to = place();
    const int leg = static_cast<int>(random.uniform(1.0, 120.0));
    for (int i = 1; i <= leg; ++i) {
      const Vec3 p = glm::mix(from, to, static_cast<double>(i) / leg);
      out.push_back({p, (p - last) / 1e-3});
      last = p;
    }
    const int rest = static_cast<int>(random.uniform(0.0, 20.0));
    for (int i = 0; i < rest; ++i) out.push_back({to, Vec3(0.0)});
    from = to;
  }
  out.resize(static_cast<std::size_t>(ticks));
  return out;
}

bool isSame(const Vec3& a, const Vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

struct Case {
  const char* scene;
  RendererKind kind;
};

class RendererStates : public ::testing::TestWithParam<Case> {};

TEST_P(RendererStates, GivenToAnotherRendererGoOnTheSame) {
  const ScenePtr scene = sceneNamed(GetParam().scene);
  RendererSettings settings;
  settings.kind = GetParam().kind;
  settings.limits = {20.0, 500.0, 0.05};
  constexpr int kTicks = 1500;
  const std::vector<HipState> path = wander(*scene, 77, kTicks);
  const auto first = makeRenderer(scene, settings);
  std::vector<RendererState> states;
  std::vector<TickResult> felt;
  for (const HipState& hip : path) {
    states.push_back(first->state());
    felt.push_back(first->update(hip));
  }
  // A renderer that has been elsewhere before must not remember it.
  const auto second = makeRenderer(scene, settings);
  for (const HipState& hip : wander(*scene, 78, 200)) (void)second->update(hip);
  for (std::size_t at = 0; at < path.size(); at += 149) {
    {
      const testing::AllocGuard guard;
      ASSERT_TRUE(second->setState(states[at]));
      EXPECT_TRUE(second->crossings().empty());
      EXPECT_EQ(guard.violations(), 0);
    }
    for (std::size_t i = at; i < std::min(at + 300, path.size()); ++i) {
      const TickResult again = second->update(path[i]);
      // Rounding of coordinates of 0.1 m is 1e-17 m; a corner of 1 degree amplifies that by 60, and
      // 1 kN/m turns it into 1e-12 N.
      ASSERT_LE(glm::length(again.force - felt[i].force), 1e-11)
          << "from tick " << at << ", at " << i;
      ASSERT_LE(glm::length(again.proxy - felt[i].proxy), 1e-14)
          << "from tick " << at << ", at " << i;
      ASSERT_EQ(again.region, felt[i].region);
      ASSERT_EQ(again.contact, felt[i].contact);
      ASSERT_EQ(again.settled, felt[i].settled);
      ASSERT_EQ(again.event_count, felt[i].event_count);
    }
    EXPECT_NEAR(
        second->sourceWork(),
        at + 300 < path.size() ? TickState::of(states[at + 300]).source.work : first->sourceWork(),
        1e-12);
  }
}

TEST_P(RendererStates, OfANewRendererAreThoseAfterReset) {
  const ScenePtr scene = sceneNamed(GetParam().scene);
  RendererSettings settings;
  settings.kind = GetParam().kind;
  const auto renderer = makeRenderer(scene, settings);
  const std::vector<HipState> path = wander(*scene, 5, 300);
  std::vector<TickResult> felt;
  for (const HipState& hip : path) felt.push_back(renderer->update(hip));
  renderer->reset();
  EXPECT_FALSE(TickState::of(renderer->state()).has_begun);
  for (std::size_t i = 0; i < path.size(); ++i) {
    ASSERT_TRUE(isSame(renderer->update(path[i]).force, felt[i].force)) << i;
  }
}

std::string nameOfCase(const ::testing::TestParamInfo<Case>& made) {
  return std::string(made.param.scene) +
         (made.param.kind == RendererKind::kPaper ? "_paper" : "_constraint");
}

constexpr RendererKind kConstraint = RendererKind::kConstraint;
constexpr RendererKind kPaper = RendererKind::kPaper;
INSTANTIATE_TEST_SUITE_P(
    Examples, RendererStates,
    ::testing::Values(Case{"container", kConstraint}, Case{"container", kPaper},
                      Case{"composite_tube", kConstraint}, Case{"composite_tube", kPaper},
                      Case{"csg", kConstraint}, Case{"csg", kPaper}, Case{"cup", kConstraint},
                      Case{"flag", kConstraint}, Case{"heart", kConstraint},
                      Case{"lattice", kConstraint}, Case{"lattice", kPaper},
                      Case{"lump", kConstraint}, Case{"metaballs", kConstraint},
                      Case{"metaballs", kPaper}, Case{"slab", kConstraint},
                      Case{"sponge", kConstraint}, Case{"valve_tube", kConstraint},
                      Case{"valve_tube", kPaper}),
    nameOfCase);

TEST(RendererState, ThatIsNotOfTheSceneIsRefusedAndNothingChanges) {
  const auto tube = makeRenderer(sceneNamed("composite_tube"));
  const auto slab = makeRenderer(sceneNamed("slab"));
  for (const HipState& hip : wander(*sceneNamed("slab"), 1, 100)) (void)slab->update(hip);
  for (const HipState& hip : wander(*sceneNamed("composite_tube"), 1, 100)) (void)tube->update(hip);
  const TickState before = TickState::of(slab->state());
  EXPECT_FALSE(slab->setState(tube->state())) << "other leaves";
  TickState bad = before;
  bad.place.region = 400;
  EXPECT_FALSE(slab->setState(bad.sealed()));
  bad = before;
  bad.place.point.y = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(slab->setState(bad.sealed()));
  bad = before;
  bad.pressed = 1000;
  EXPECT_FALSE(slab->setState(bad.sealed()));
  bad = before;
  bad.relaxation.material = -2;
  EXPECT_FALSE(slab->setState(bad.sealed()));
  const TickState after = TickState::of(slab->state());
  EXPECT_EQ(after.place.region, before.place.region);
  EXPECT_EQ(after.place.point, before.place.point);
  EXPECT_EQ(after.pressed, before.pressed);
  EXPECT_TRUE(slab->setState(before.sealed()));
}

}  // namespace
}  // namespace palpate::test
