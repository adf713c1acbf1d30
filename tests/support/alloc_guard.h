#pragma once
// Lets a test prove that code is fit for the servo loop.

#include <cstdint>

namespace palpate::testing {

/// While it exists, it counts on its own thread every allocation and release, every lock of a mutex
/// or read-write lock, and every throw:
///
///   AllocGuard guard;
///   loop();
///   EXPECT_EQ(guard.violations(), 0);
///
/// The counts come from definitions in the test executable that take precedence over those of the C
/// library and libstdc++ (malloc and its family, which operator new calls; pthread_mutex_lock;
/// __cxa_throw). Under the sanitizers memory is counted by hooks that they provide. To find the
/// culprit, set a breakpoint at palpate::testing::noteViolation. Guards may be nested.
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

  /// Counts since construction.
  [[nodiscard]] Counts counts() const noexcept;
  [[nodiscard]] std::int64_t violations() const noexcept;

 private:
  Counts before_;
};

}  // namespace palpate::testing
