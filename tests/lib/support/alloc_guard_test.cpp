#include "support/alloc_guard.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace palpate::testing {
namespace {

/// Keeps the optimizer from removing a pair of new and delete.
template <typename T>
void use(T* pointer) {
  asm volatile("" : : "g"(pointer) : "memory");
}

TEST(AllocGuard, CleanCodeHasNoViolation) {
  std::vector<int> room;
  room.reserve(16);
  const AllocGuard guard;
  for (int i = 0; i < 16; ++i) room.push_back(i);
  EXPECT_EQ(guard.violations(), 0);
}

TEST(AllocGuard, NoticesNewAndDelete) {
  const AllocGuard guard;
  int* one = new int(1);
  use(one);
  delete one;
  const AllocGuard::Counts counts = guard.counts();
  EXPECT_EQ(counts.allocations, 1);
  EXPECT_EQ(counts.releases, 1);
}

TEST(AllocGuard, NoticesAlignedNew) {
  struct alignas(64) Line {
    char bytes[64];
  };
  const AllocGuard guard;
  auto* line = new Line;
  use(line);
  delete line;
  EXPECT_EQ(guard.counts().allocations, 1);
}

TEST(AllocGuard, NoticesTheMallocFamily) {
  const AllocGuard guard;
  void* a = std::malloc(10);
  use(a);
  void* b = std::calloc(2, 10);
  use(b);
  a = std::realloc(a, 100000);
  use(a);
  std::free(a);
  std::free(b);
  const AllocGuard::Counts counts = guard.counts();
  EXPECT_GE(counts.allocations, 3);
  EXPECT_GE(counts.releases, 2);
}

TEST(AllocGuard, NoticesWhatTheLibraryAllocatesInside) {
  const std::string text(100, 'x');
  const AllocGuard guard;
  const std::string copy = text;  // NOLINT(performance-unnecessary-copy-initialization): the point
  use(copy.data());
  EXPECT_EQ(guard.counts().allocations, 1);
}

TEST(AllocGuard, NoticesLocks) {
  std::mutex mutex;
  std::shared_mutex shared;
  const AllocGuard guard;
  mutex.lock();
  mutex.unlock();
  shared.lock_shared();
  shared.unlock_shared();
  shared.lock();
  shared.unlock();
  EXPECT_EQ(guard.counts().locks, 3);
}

TEST(AllocGuard, NoticesAThrow) {
  const AllocGuard guard;
  try {
    throw 1;
  } catch (int) {
  }
  EXPECT_EQ(guard.counts().throws, 1);
}

TEST(AllocGuard, NoticesAThrowFromInsideTheLibrary) {
  const std::vector<int> empty;
  const AllocGuard guard;
  try {
    static_cast<void>(empty.at(1));
  } catch (const std::out_of_range&) {
  }
  EXPECT_EQ(guard.counts().throws, 1);
}

TEST(AllocGuard, IsBlindToOtherThreads) {
  std::mutex gate;
  gate.lock();
  std::thread other([&] {
    gate.lock();
    use(std::make_unique<int>(3).get());
    gate.unlock();
  });
  {
    const AllocGuard guard;
    gate.unlock();
    EXPECT_EQ(guard.violations(), 0);
  }
  other.join();
}

TEST(AllocGuard, CountsOnlyWhileItLives) {
  use(std::make_unique<int>(1).get());
  const AllocGuard outer;
  {
    const AllocGuard inner;
    use(std::make_unique<int>(2).get());
    EXPECT_EQ(inner.counts().allocations, 1);
  }
  use(std::make_unique<int>(3).get());
  EXPECT_EQ(outer.counts().allocations, 2);
}

}  // namespace
}  // namespace palpate::testing
