// Random constructive solid geometry against the oracle.

#include <gtest/gtest.h>

#include <cstdlib>

#include "lib/render/csg_run.h"

namespace palpate::test {
namespace {

long numberFrom(const char* name, long otherwise) {
  const char* text = std::getenv(name);
  return text != nullptr ? std::atol(text) : otherwise;
}

TEST(RandomCsg, TheProxyIsWhereTheOracleIs) {
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const long wanted = numberFrom("PALPATE_CSG_CONTACTS", slow ? 10'000'000 : 30'000);
  const auto first = static_cast<std::uint64_t>(numberFrom("PALPATE_CSG_FIRST", 1));
  const long scenes = numberFrom("PALPATE_CSG_SCENES", 1'000'000);
  CsgCounts counts;
  for (std::uint64_t number = first;
       counts.contacts < wanted && counts.scenes < scenes; ++number) {
    CsgRun(counts, 150, 1500).run(randomScene(number));
  }
  std::printf("%s", counts.text().c_str());
  for (const CsgFault& fault : counts.list) {
    std::printf("  scene %llu tick %d: %s, by %.3g, depth %.3g mm\n",
                static_cast<unsigned long long>(fault.scene), fault.tick, nameOf(fault.fault),
                fault.off, 1e3 * fault.depth);
  }
  EXPECT_EQ(counts.allFaults(), 0);
}

}  // namespace
}  // namespace palpate::test
