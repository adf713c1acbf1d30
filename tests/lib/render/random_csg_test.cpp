// Random constructive solid geometry: at every tick the proxy is where an oracle comes to rest that starts from the
// proxy of the tick before.
//
// One scene by its number: PALPATE_CSG_FIRST=14 PALPATE_CSG_SCENES=1; more ticks: PALPATE_CSG_CONTACTS=300000.
// PALPATE_CSG_KEEP=FOLDER keeps scene and path of what fails, for `palpate touch SCENE --path PATH`.

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

/// What to do about a fault: the scene, the tick and where the hand was, and the scene file once.
void tell(const CsgCounts& counts) {
  std::printf("%s", counts.text().c_str());
  for (const CsgFault& fault : counts.list) {
    std::printf(
        "  scene %llu tick %d: %s, by %.3g, depth %.3g mm, %s, hand (%.17g, %.17g, %.17g)\n",
        static_cast<unsigned long long>(fault.scene), fault.tick, nameOf(fault.fault), fault.off,
        1e3 * fault.depth, fault.cause.c_str(), fault.hip.x, fault.hip.y, fault.hip.z);
  }
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
  // 99.99 % of the ticks are at the minimum within 1e-6 of the depth; the list above has the rest.
  EXPECT_LE(counts.of(Fault::kPlace), 1 + counts.contacts / 10'000);
  // What passes unseen stays rare: two ends within the oracle's own noise, and kinks that it cannot tell.
  EXPECT_LE(counts.ambiguous, 5 + counts.contacts / 1'000);
  EXPECT_LE(counts.unjudged, 5 + counts.contacts / 1'000);
  EXPECT_LE(counts.empty, 1 + counts.scenes / 10);
}

/// Parts of the sweep, so that none takes more than some minutes where there are ten million ticks to judge.
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
  }
  tell(counts);
  expectRight(counts, scenes < 1'000'000 ? 0 : wanted);
}

INSTANTIATE_TEST_SUITE_P(Part, RandomCsg, ::testing::Range(0, kParts),
                         ::testing::PrintToStringParamName());

}  // namespace
}  // namespace palpate::test
