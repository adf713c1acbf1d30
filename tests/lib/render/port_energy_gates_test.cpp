// Every key of a port: over closed paths of the hand, random ones and ones found by a search,
// through walls that rupture and holes that are used again, no energy is given beyond counted
// sources.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <tuple>

#include "lib/render/energy_loop.h"
#include "support/sanitized.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

/// A port between outside, `skin` and, within that, `flesh`; `left` is where x < 0.
struct Key {
  const char* name;
  const char* ports;
};

const Key kKeys[] = {
    {"between", "{name: p, between: [outside, skin]}, {name: q, between: [skin, flesh]}"},
    {"where",
     "{name: p, between: [outside, skin], where: left}, {name: q, between: [skin, flesh], where: "
     "{complement: left}}"},
    {"direction",
     "{name: p, between: [outside, skin], direction: in, where: left}, {name: q, between: [skin, "
     "flesh]}, {name: r, between: [outside, skin], direction: out, where: {complement: left}}"},
    {"after",
     "{name: p, between: [outside, skin], opens_at: 0.3 N, back: 0 N}, {name: q, between: [skin, "
     "flesh], after: [p], where: left}, {name: r, between: [skin, flesh], after: [{port: q, times: "
     "1}], opens_at: 0.2 N}"},
    {"opens_at",
     "{name: p, between: [outside, skin], opens_at: 0.6 N}, {name: q, between: [skin, flesh], "
     "opens_at: 0.3 N}"},
    {"opens_at of the inner wall alone",
     "{name: p, between: [outside, skin]}, {name: q, between: [skin, flesh], opens_at: 0.4 N}"},
    {"opens_at and direction",
     "{name: p, between: [outside, skin], opens_at: 0.6 N, direction: in}, {name: q, between: "
     "[skin, flesh], opens_at: 0.3 N}, {name: r, between: [outside, skin], direction: out}"},
    {"back",
     "{name: p, between: [outside, skin], opens_at: 0.6 N, back: 0.1 N}, {name: q, between: [skin, "
     "flesh], opens_at: 0.2 N, back: 0.5 N}"},
    {"hole",
     "{name: p, between: [outside, skin], opens_at: 0.6 N, hole: {radius: 0.4, reopens_at: 0.1 "
     "N}}, "
     "{name: q, between: [skin, flesh], opens_at: 0.3 N, hole: {radius: 0.2}}"},
    {"rate",
     "{name: p, between: [outside, skin], opens_at: 0.5 N, rate: {ratio: 2, speed: 3 mm/s}}, "
     "{name: q, between: [skin, flesh], opens_at: 0.5 N, rate: {ratio: 0.3, speed: 3 mm/s}}"},
    {"rearm",
     "{name: p, between: [outside, skin], opens_at: 0.5 N, rearm: 0.4 mm}, {name: q, between: "
     "[skin, flesh], opens_at: 0.3 N, rearm: 0.3 mm}"},
    {"all of them",
     "{name: p, between: [outside, skin], opens_at: 0.5 N, back: 0.2 N, hole: {radius: 0.3, "
     "reopens_at: 0.1 N}, rearm: 0.2 mm, rate: {ratio: 2, speed: 3 mm/s}}, {name: q, between: "
     "[skin, flesh], where: left, opens_at: 0.3 N, hole: {radius: 0.3}}, {name: r, between: "
     "[skin, flesh], after: [q], direction: out}"},
};

struct Place {
  const char* name;
  const char* fields;
};

const Place kPlaces[] = {
    {"floor",
     "skin: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, flesh: {half_space: {point: [0, "
     "0, "
     "-0.6], normal: [0.1, 0, 1]}}"},
    {"ball",
     "skin: {sphere: {center: [0, 0, -5], radius: 5}}, flesh: {sphere: {center: [0.1, 0, -5], "
     "radius: 4.4}}"},
    {"edge",
     "skin: {intersection: [{half_space: {point: [0, 0, 0], normal: [1, 0, 1]}}, {half_space: "
     "{point: [0, 0, 0], normal: [-1, 0, 2]}}]}, flesh: {half_space: {point: [0, 0, -0.6], normal: "
     "[0, 0, 1]}}"},
    {"groove",
     "skin: {union: [{half_space: {point: [0, 0, 0], normal: [1, 0, 1]}}, {half_space: {point: [0, "
     "0, 0], normal: [-1, 0, 2]}}]}, flesh: {half_space: {point: [0, 0, -0.6], normal: [0, 0, "
     "1]}}"},
};

constexpr double kSkin = 1000.0;   // [N/m]
constexpr double kFlesh = 1700.0;  // [N/m]
const Vec3 kStart = mm(0, 0, 8);

ScenePtr sceneOf(const char* ports, const Place& place) {
  return test::sceneOf(
      std::string("palpate: 1\nlength: mm\nfields: {left: {half_space: {point: [0.05, 0, 0], "
                  "normal: [1, 0, 0]}}, ") +
      place.fields + "}\nmaterials: {skin: {stiffness: " + std::to_string(kSkin) +
      " N/m}, flesh: {stiffness: " + std::to_string(kFlesh) +
      " N/m}}\nlayers:\n  - {name: skin, inside: skin, wall: skin}\n"
      "  - {name: flesh, inside: flesh, wall: flesh}\nports: [" +
      ports + "]\n");
}

/// A hand that goes around. The sum of the energy given to it, minus counted sources, and the
/// energy that the walls hold must never rise.
class Laps {
 public:
  Laps(const ScenePtr& scene, const EnergyLoop& loop, int steps) : renderer_(makeRenderer(scene)) {
    now_ = renderer_->update({kStart, Vec3(0.0), kTick});
    for (int i = 1; i <= 500; ++i) goTo(glm::mix(kStart, loop.at(0.0), i / 500.0), kTick, 0);
    lowest_ = sum();
    constexpr int kLaps = 3;
    // A lap in 3 s: about the speed of `rate`.
    for (int i = 1; i <= kLaps * steps; ++i) {
      goTo(loop.at(1.0 * (i % steps) / steps), 3.0 / steps, kHalvings);
      const double now = sum();
      lowest_ = std::min(lowest_, now);
      most_ = std::max(most_, now - lowest_);
    }
  }
  /// [J] The most by which the sum ever rose.
  [[nodiscard]] double most() const { return most_; }
  [[nodiscard]] long entries() const { return entries_; }

 private:
  static constexpr double kTick = 1e-3;     // [s]
  static constexpr double kStepped = 0.01;  // [N]

  /// [J] Half the force times its way, valid if one linear spring is pressed.
  [[nodiscard]] double stored() const {
    const StoredState held = TickState::of(renderer_->state()).source.stored;
    if (held.leaves.count > 0) return held.energy;
    return 0.5 * glm::length(now_.force) * glm::length(now_.proxy - last_);
  }
  [[nodiscard]] double sum() const { return work_ + stored() - renderer_->sourceWork(); }
  void goTo(const Vec3& to, double dt, int halvings) {
    const Vec3 from = last_;
    const RendererState before = renderer_->state();
    const TickResult next = renderer_->update({to, (to - from) / dt, dt});
    if (halvings > 0 && glm::length(next.force - now_.force) > kStepped &&
        renderer_->setState(before)) {
      goTo(0.5 * (from + to), 0.5 * dt, halvings - 1);
      goTo(to, 0.5 * dt, halvings - 1);
      return;
    }
    entries_ += static_cast<long>(renderer_->entries().size());
    work_ += 0.5 * glm::dot(now_.force + next.force, to - from);
    now_ = next;
    last_ = to;
  }

  std::unique_ptr<HapticRenderer> renderer_;
  TickResult now_;
  Vec3 last_ = kStart;
  double work_ = 0.0;
  double lowest_ = 0.0;
  double most_ = 0.0;
  long entries_ = 0;
};

class PortEnergyGates : public ::testing::TestWithParam<std::tuple<std::size_t, std::size_t>> {};

void expectNothingGiven(const ScenePtr& scene, const char* name, const char* place) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int loops = slow ? 10 : kSanitized ? 1 : 2;
  const int tries = slow ? 40 : kSanitized ? 1 : 5;
  Random random(29);
  double worst = -kInfinity;
  long entries = 0;
  for (int i = 0; i < loops; ++i) {
    EnergyLoop loop = randomLoop(random, mm(0, 0, random.uniform(-1.2, 0.2)), 0.2e-3, 0.9e-3);
    double most = -kInfinity;
    for (int k = 0; k < tries; ++k) {
      EnergyLoop next = loop;
      if (k > 0) {
        next.center += 0.2e-3 * random.direction();
        for (Vec3& each : next.wave) each += 0.2e-3 * random.direction();
      }
      const double given = Laps(scene, next, 1000).most();
      if (given <= most) continue;
      most = given;
      loop = next;
    }
    int steps = 2000;
    Laps coarse(scene, loop, steps);
    double given = coarse.most();
    double change = kInfinity;
    entries += coarse.entries();
    while (change > 1e-10 && given > 1e-9 && steps < 64'000) {
      steps *= 2;
      const double finer = Laps(scene, loop, steps).most();
      change = std::fabs(finer - given);
      given = finer;
    }
    worst = std::max(worst, given);
    EXPECT_LE(given, 1e-9) << name << ", " << place << ", loop " << i << ", last halving "
                           << change;
  }
  std::printf("  %-34s %-8s %10.3g J, %ld regions entered\n", name, place, worst, entries);
  // A single loop without a search, as under the sanitizers, enters perhaps once.
  EXPECT_GE(entries, kSanitized ? 1 : loops + 1) << name << ", " << place;
}

TEST_P(PortEnergyGates, TheKeyGivesNoEnergyThere) {
  const Key& key = kKeys[std::get<0>(GetParam())];
  const Place& place = kPlaces[std::get<1>(GetParam())];
  expectNothingGiven(sceneOf(key.ports, place), key.name, place.name);
}

TEST(PortEnergyGatesOfMaps, AForceThatVariesGivesNone) {
  for (const Place& place : kPlaces) {
    SceneDescription varying = parseScene(
        "palpate: 1\nlength: mm\nfields: {" + std::string(place.fields) +
            "}\nmaterials: {skin: {stiffness: 1000 N/m}, flesh: {stiffness: 1700 N/m}}\n"
            "layers:\n  - {name: skin, inside: skin, wall: skin}\n  - {name: flesh, inside: flesh, "
            "wall: flesh}\nports: [{name: p, between: [outside, skin], opens_at: 0.5 N, hole: "
            "{radius: 0.2, reopens_at: 0.1 N}}, {name: q, between: [skin, flesh], opens_at: 0.3 "
            "N}]\n",
        "test.yaml");
    varying.ports[0].opens_at = testing::linearMap(0.5, Vec3(200.0, 100.0, 0.0), {0.1, 0.9});
    varying.ports[0].back = testing::linearMap(0.2, Vec3(0.0, 200.0, 0.0), {0.0, 0.9});
    varying.ports[0].reopens_at = testing::linearMap(0.1, Vec3(50.0, 0.0, 0.0), {0.0, 0.3});
    expectNothingGiven(compile(varying), "maps", place.name);
  }
}

/// A plate with an opening that ruptures, over a floor.
TEST(PortEnergyGatesOfSheets, AnOpeningInASheetGivesNone) {
  for (const char* keys : {"", ", opens_at: 0.5 N",
                           ", opens_at: 0.5 N, back: 0.1 N, hole: {radius: "
                           "0.2}, rearm: 0.1 mm"}) {
    const ScenePtr scene = test::sceneOf(
        std::string(
            "palpate: 1\nlength: mm\nfields: {plate: {half_space: {point: [0, 0, 0], "
            "normal: [0, 0, 1]}}}\nlayers: [{name: floor, inside: {half_space: {point: [0, "
            "0, -0.8], normal: [0, 0.2, 1]}}}]\nsheets: [{name: s, on: plate, where: "
            "{sphere: {center: [0, 0, 0], radius: 3}}}]\nports: [{name: p, sheet: s, where: "
            "{sphere: {center: [0.2, 0, 0], radius: 0.7}}") +
        keys + "}]\n");
    Random random(31);
    for (int i = 0; i < 4; ++i) {
      const EnergyLoop loop = randomLoop(random, mm(0, 0, -0.3), 0.2e-3, 0.9e-3);
      EXPECT_LE(Laps(scene, loop, 8000).most(), 1e-9) << keys << ", loop " << i;
    }
  }
}

std::string nameOf(const ::testing::TestParamInfo<std::tuple<std::size_t, std::size_t>>& info) {
  std::string out = std::string(kKeys[std::get<0>(info.param)].name) + "_" +
                    kPlaces[std::get<1>(info.param)].name;
  std::replace(out.begin(), out.end(), ' ', '_');
  return out;
}

INSTANTIATE_TEST_SUITE_P(EveryKey, PortEnergyGates,
                         ::testing::Combine(::testing::Range(std::size_t{0}, std::size(kKeys)),
                                            ::testing::Range(std::size_t{0}, std::size(kPlaces))),
                         nameOf);

}  // namespace
}  // namespace palpate::test
