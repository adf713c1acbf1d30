// Random constructive solid geometry: at every tick the proxy is where an oracle comes to rest that
// starts from the proxy of the previous tick.
//
// To run one scene by its number: PALPATE_CSG_FIRST=14 PALPATE_CSG_SCENES=1; for more ticks:
// PALPATE_CSG_CONTACTS=300000. PALPATE_CSG_KEEP=FOLDER stores scene and path of each failure, for
// `palpate touch SCENE --path PATH`.

#include <gtest/gtest.h>

#include <cstdlib>
#include <set>

#include "lib/render/csg_run.h"

namespace palpate::test {
namespace {

using testing::Fault;

long numberFrom(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

/// Prints the counts and, for the first faults, the scene file, once.
void tell(const CsgCounts& counts) {
  std::printf("%s", counts.text().c_str());
  std::set<std::uint64_t> told;
  for (const CsgFault& fault : counts.list) {
    if (told.size() == 3 || !told.insert(fault.scene).second) continue;
    std::printf("scene %llu:\n%s", static_cast<unsigned long long>(fault.scene),
                randomScene(fault.scene).yaml.c_str());
  }
}

void expectRight(const CsgCounts& counts, long wanted) {
  EXPECT_GE(counts.contacts, wanted);
  for (const Fault never : {Fault::kNotFinite, Fault::kRegion, Fault::kInside, Fault::kForce,
                            Fault::kContact, Fault::kStep, Fault::kFrozen}) {
    EXPECT_EQ(counts.of(never), 0) << nameOf(never);
  }
  // 99.99 % of the ticks are at the minimum within 1e-6 of the depth; the list above shows the
  // others.
  EXPECT_LE(counts.of(Fault::kPlace), 1 + counts.contacts / 10'000);
  // Ticks that cannot be judged must stay rare: two minima within the oracle's own noise, and kinks
  // that it cannot resolve.
  EXPECT_LE(counts.ambiguous, 5 + counts.contacts / 1'000);
  EXPECT_LE(counts.unjudged, 5 + counts.contacts / 1'000);
  EXPECT_LE(counts.given_up, 1 + counts.scenes / 50);
  EXPECT_LE(counts.empty, 1 + counts.scenes / 10);
}

/// The sweep in parts, so that none takes more than some minutes when ten million ticks are judged.
class RandomCsg : public ::testing::TestWithParam<int> {};

constexpr int kParts = 4;

TEST_P(RandomCsg, TheProxyIsWhereTheOracleIs) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const long wanted = numberFrom("PALPATE_CSG_CONTACTS", slow ? 10'000'000 : 32'000) / kParts;
  const auto first = static_cast<std::uint64_t>(numberFrom("PALPATE_CSG_FIRST", 1));
  const long scenes = numberFrom("PALPATE_CSG_SCENES", 1'000'000);
  const int in_each = slow ? 1500 : 150;
  CsgCounts counts;
  for (std::uint64_t number = first + static_cast<std::uint64_t>(GetParam());
       counts.contacts < wanted && counts.scenes < scenes; number += kParts) {
    CsgRun(counts, in_each, 8 * in_each).run(randomScene(number));
    if (slow && counts.scenes % 100 == 0) {
      std::fprintf(stderr, "%d scenes, %ld of %ld contacts, %ld at fault\n", counts.scenes,
                   counts.contacts, wanted, counts.allFaults());
    }
  }
  tell(counts);
  expectRight(counts, scenes < 1'000'000 ? 0 : wanted);
}

TEST(RandomCsgMaterials, OneThatNoWallHasIsNeverFelt) {
  CsgCounts counts;
  for (std::uint64_t number = 1; counts.contacts < 32'000; ++number) {
    const RandomScene scene = randomScene(number);
    SceneDescription description = scene.description();
    Material other;
    other.name = "other";
    other.stiffness = 1e5;
    Material wall;
    wall.name = "wall";
    wall.stiffness = 1000.0;  // [N/m] like those that the scene does not name
    description.materials = {other, wall};
    for (LayerDescription& layer : description.layers) layer.wall.material = "wall";
    CsgRun(counts, 150, 1200).run(scene, compile(description));
  }
  tell(counts);
  expectRight(counts, 32'000);
}

/// Scenes found by runs of millions of ticks.
struct FoundScene {
  const char* name;
  std::uint64_t number;
};

class FoundCsg : public ::testing::TestWithParam<FoundScene> {};

TEST_P(FoundCsg, StaysRight) {
  CsgCounts counts;
  CsgRun(counts, 1500, 12'000).run(randomScene(GetParam().number));
  tell(counts);
  expectRight(counts, 1000);
}

INSTANTIATE_TEST_SUITE_P(Long, FoundCsg,
                         ::testing::Values(FoundScene{"GoesBackAndForthAtAnApex", 9},
                                           FoundScene{"RestsNearAnApexWithinTheNoise", 181},
                                           FoundScene{"ComesBackFromALittleDeepInItsWalls", 2580},
                                           FoundScene{"SeesOneSideOfAnApexOnly", 1705},
                                           FoundScene{"ComesToARimByHalvesOfTheWay", 2327},
                                           FoundScene{"CreepsBackAndForthAtAnApex", 2770},
                                           FoundScene{"IsOffItsWallsByMoreThanItsStep", 6504},
                                           FoundScene{"GoesAlongACreaseOfAConeThatIsBlended", 6652},
                                           FoundScene{"RestsAtACreaseThatWasMetFarOff", 669},
                                           FoundScene{"GoesRoundThreePlacesAtACrease", 396}),
                         [](const auto& found) { return found.param.name; });

INSTANTIATE_TEST_SUITE_P(Part, RandomCsg, ::testing::Range(0, kParts),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace palpate::test
