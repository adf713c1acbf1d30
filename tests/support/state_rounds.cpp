#include "support/state_rounds.h"

#include <algorithm>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/render/tick_state.h"
#include "support/field_contract.h"
#include "support/stored_trace.h"

namespace palpate::test {
namespace {

constexpr std::size_t kOn = 500;  // ticks

/// The result of one tick, including parts that the force does not show.
struct Felt {
  TickResult result;
  double source_work = 0.0;          // [J]
  Vec3 point{0.0};                   // [m]
  std::vector<Vec3> crossings = {};  // [m]
};

bool isSame(const Vec3& a, const Vec3& b) { return std::memcmp(&a, &b, sizeof a) == 0; }

bool isSame(const Felt& a, const Felt& b) {
  const TickResult& x = a.result;
  const TickResult& y = b.result;
  const auto are_same = [](const Vec3& p, const Vec3& q) { return isSame(p, q); };
  return isSame(x.force, y.force) && isSame(x.proxy, y.proxy) && x.region == y.region &&
         x.contact == y.contact && x.settled == y.settled && x.event_count == y.event_count &&
         std::equal(x.events.begin(), x.events.begin() + x.event_count, y.events.begin()) &&
         std::memcmp(&a.source_work, &b.source_work, sizeof a.source_work) == 0 &&
         isSame(a.point, b.point) &&
         std::equal(a.crossings.begin(), a.crossings.end(), b.crossings.begin(), b.crossings.end(),
                    are_same);
}

std::vector<HipState> motionOf(const std::vector<Vec3>& path) {
  std::vector<HipState> out;
  for (std::size_t i = 0; i < path.size(); ++i) {
    out.push_back({path[i], i > 0 ? (path[i] - path[i - 1]) / 1e-3 : Vec3(0.0)});
  }
  return out;
}

Felt feel(HapticRenderer& renderer, const HipState& hip) {
  Felt out;
  out.result = renderer.update(hip);
  out.source_work = renderer.sourceWork();
  out.point = TickState::of(renderer.state()).place.point;
  for (const PortCrossing& crossing : renderer.crossings()) out.crossings.push_back(crossing.point);
  return out;
}

std::vector<Felt> feel(HapticRenderer& renderer, const std::vector<HipState>& motion,
                       std::size_t from) {
  std::vector<Felt> out;
  for (std::size_t i = from; i < std::min(motion.size(), from + kOn); ++i) {
    out.push_back(feel(renderer, motion[i]));
  }
  return out;
}

::testing::AssertionResult compare(const std::vector<Felt>& then, const std::vector<Felt>& now,
                                   std::size_t from, const char* who) {
  for (std::size_t i = 0; i < then.size(); ++i) {
    if (isSame(then[i], now[i])) continue;
    return ::testing::AssertionFailure()
           << who << ", from tick " << from << ", at " << from + i << ": the force is "
           << glm::length(then[i].result.force - now[i].result.force) << " N off, the proxy "
           << glm::length(then[i].result.proxy - now[i].result.proxy) << " m";
  }
  return ::testing::AssertionSuccess();
}

/// Null if the scene is refused. The growth of the force is limited, so that these limits are part
/// of the state too.
std::unique_ptr<HapticRenderer> rendererOf(const ScenePtr& scene, RendererKind kind) {
  RendererSettings settings;
  settings.kind = kind;
  settings.limits = {20.0, 500.0, 0.05};
  try {
    return makeRenderer(scene, settings);
  } catch (const Error&) {
    return nullptr;
  }
}

}  // namespace

bool runsSlowTests() { return std::getenv("PALPATE_SLOW_TESTS") != nullptr; }

::testing::AssertionResult goesOnFromItsStates(const ScenePtr& scene, RendererKind kind,
                                               int states) {
  const auto renderer = rendererOf(scene, kind);
  const auto other = rendererOf(scene, kind);
  if (!renderer) return ::testing::AssertionSuccess();
  const std::vector<HipState> motion = motionOf(pathThrough(*scene));
  Random random(19);
  std::vector<std::size_t> places;
  for (int i = 0; i < states; ++i) {
    places.push_back(
        static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(motion.size() - kOn))));
  }
  std::sort(places.begin(), places.end());
  std::size_t at = 0;
  for (const std::size_t place : places) {
    for (; at < place; ++at) (void)renderer->update(motion[at]);
    const RendererState state = renderer->checkpoint();
    const std::vector<Felt> first = feel(*renderer, motion, place);
    for (HapticRenderer* const again : {renderer.get(), other.get()}) {
      if (!again->setState(state)) {
        return ::testing::AssertionFailure() << "the state of tick " << place << " is refused";
      }
      const auto result = compare(first, feel(*again, motion, place), place,
                                  again == other.get() ? "another renderer" : "the same renderer");
      if (!result) return result;
    }
    (void)renderer->setState(state);
  }
  return ::testing::AssertionSuccess();
}

::testing::AssertionResult areApart(const ScenePtr& scene, RendererKind kind) {
  const std::vector<Vec3> path = pathThrough(*scene);
  const std::vector<HipState> there = motionOf(path);
  const std::vector<HipState> back = motionOf({path.rbegin(), path.rend()});
  const auto one = rendererOf(scene, kind);
  const auto two = rendererOf(scene, kind);
  if (!one) return ::testing::AssertionSuccess();
  std::vector<Felt> by_one;
  std::vector<Felt> by_two;
  for (std::size_t i = 0; i < path.size(); ++i) {
    by_one.push_back(feel(*one, there[i]));
    by_two.push_back(feel(*two, back[i]));
  }
  for (const auto& [motion, felt] : {std::pair(&there, &by_one), {&back, &by_two}}) {
    const auto alone = rendererOf(scene, kind);
    std::vector<Felt> wanted;
    for (const HipState& hip : *motion) wanted.push_back(feel(*alone, hip));
    const auto result =
        compare(wanted, *felt, 0, motion == &there ? "there, in turns" : "back, in turns");
    if (!result) return result;
  }
  return ::testing::AssertionSuccess();
}

}  // namespace palpate::test
