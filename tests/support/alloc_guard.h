#pragma once
// A test's proof that a piece of code is fit for the servo loop.

#include <cstdint>

namespace palpate::testing {

/// While it lives, counts on its own thread every allocation and release, every lock of a mutex or
/// read-write lock, and every throw:
///
///   AllocGuard guard;
///   loop();
///   EXPECT_EQ(guard.violations(), 0);
///
/// The counts come from definitions in the test executable that stand before the C library's and
/// libstdc++'s (malloc and its family, which operator new calls; pthread_mutex_lock; __cxa_throw).
/// Under the sanitizers memory is counted by the hooks that they offer. To find the culprit, set a
/// breakpoint at palpate::testing::noteViolation. Guards may be nested.
class AllocGuard {
 public:
  struct Counts {
    std::int64_t allocations = 0;
    std::int64_t releases = 0;
    std::int64_t locks = 0;
    std::int64_t throws = 0;
  };

  AllocGuard() noexcept;
  ~AllocGuard();
  AllocGuard(const AllocGuard&) = delete;
  AllocGuard& operator=(const AllocGuard&) = delete;

  /// Since construction.
  [[nodiscard]] Counts counts() const noexcept;
  [[nodiscard]] std::int64_t violations() const noexcept;

 private:
  Counts before_;
};

}  // namespace palpate::testing
