#include "hang_watch.h"

#include <pthread.h>
#include <sched.h>

#include <ctime>
#include <limits>
#include <system_error>

#include "palpate/core/error.h"
#include "servo_clock.h"

namespace palpate::devices {
namespace {

/// Short compared with the 20 ms for which a hand may be left alone.
constexpr std::int64_t kPause = 2'000'000;  // [ns]

}  // namespace

HangWatch::HangWatch(Device& device, std::int64_t longest, int above)
    : device_(device), longest_(longest), beat_(monotonicNs()) {
  if (longest_ == std::numeric_limits<std::int64_t>::max()) return;
  try {
    thread_ = std::thread([this, above] { run(above); });
  } catch (const std::system_error& error) {
    throw Error(
        ErrorKind::kOperation,
        {"servo.watch",
         std::string("the watchdog thread of the servo loop cannot be started: ") + error.what(),
         "close other programs, or raise the limit on processes (ulimit -u)"});
  }
}

HangWatch::~HangWatch() {
  is_over_.store(true, std::memory_order_relaxed);
  if (thread_.joinable()) thread_.join();
}

void HangWatch::run(int priority) noexcept {
  if (priority > 0) {
    sched_param wanted{};
    wanted.sched_priority = priority;
    // If this is refused, the thread still watches, from another core.
    (void)pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
  }
  while (!is_over_.load(std::memory_order_relaxed)) {
    const std::int64_t beat = beat_.load(std::memory_order_acquire);
    if (isHung(monotonicNs(), beat, longest_)) {
      // Counted before the cut: a loop that wakes up now must not write a force after it.
      cuts_.fetch_add(1, std::memory_order_acq_rel);
      device_.cut();
    }
    timespec pause{0, kPause};
    nanosleep(&pause, nullptr);
  }
}

}  // namespace palpate::devices
