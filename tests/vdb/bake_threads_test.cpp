// A processor that baking threads avoid, for a servo loop beside them.

#include "palpate/vdb/bake_threads.h"

#include <gtest/gtest.h>
#include <sched.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <atomic>
#include <stdexcept>
#include <vector>

#include "palpate/core/error.h"
#include "support/error_of.h"

namespace palpate::vdb {
namespace {

/// The processors that this thread may run on.
std::vector<int> mine() {
  cpu_set_t set;
  CPU_ZERO(&set);
  (void)sched_getaffinity(0, sizeof set, &set);
  std::vector<int> out;
  for (int i = 0; i < CPU_SETSIZE; ++i) {
    if (CPU_ISSET(static_cast<std::size_t>(i), &set)) out.push_back(i);
  }
  return out;
}

/// Number of pieces of work, divided as in a bake.
constexpr int kPieces = 2000;
/// How many of the pieces ran on a thread that may use `processor`.
int piecesOn(int processor) {
  std::atomic<int> count{0};
  tbb::parallel_for(tbb::blocked_range<int>(0, kPieces, 1),
                    [&](const tbb::blocked_range<int>& part) {
                      for (int i = part.begin(); i != part.end(); ++i) {
                        for (const int each : mine()) count += each == processor ? 1 : 0;
                      }
                    });
  return count;
}

void expectRefused(int processor) {
  bool was_called = false;
  const Error error = errorOf([&] { bakeOffProcessor(processor, [&] { was_called = true; }); });
  EXPECT_EQ(error.kind(), ErrorKind::kUsage);
  EXPECT_EQ(error.problem().code, "bake.processor");
  EXPECT_FALSE(was_called);
}

TEST(BakeOffProcessor, NoPieceOfABakeRunsThereAndAfterwardsAllIsAsBefore) {
  const std::vector<int> before = mine();
  // There would be no processor left for the bake
  if (before.size() == 1) return expectRefused(before.front());
  for (const int processor : before) {
    EXPECT_EQ(piecesOn(processor), kPieces);
    for (int n = 0; n < 10; ++n) {
      int there = -1;
      std::vector<int> baking;
      bakeOffProcessor(processor, [&] {
        there = piecesOn(processor);
        baking = mine();
      });
      EXPECT_EQ(there, 0);
      EXPECT_EQ(baking.size(), before.size() - 1) << "the thread that bakes is kept off too";
      EXPECT_EQ(mine(), before);
    }
    EXPECT_EQ(piecesOn(processor), kPieces) << "no thread of TBB is kept off any longer";
  }
}

TEST(BakeOffProcessor, AThrowingBakeLeavesAllAsBefore) {
  const std::vector<int> before = mine();
  if (before.size() == 1) return expectRefused(before.front());
  const auto broken = [] { throw std::runtime_error("broken bake"); };
  EXPECT_THROW(bakeOffProcessor(before.front(), broken), std::runtime_error);
  EXPECT_EQ(mine(), before);
}

TEST(BakeOffProcessor, AProcessorThatIsNotThereIsRefused) {
  for (const int processor : {-1, CPU_SETSIZE - 1, CPU_SETSIZE + 5}) expectRefused(processor);
}

}  // namespace
}  // namespace palpate::vdb
