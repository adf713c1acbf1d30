#include "servo_clock.h"

#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>

#include <algorithm>
#include <cerrno>
#include <ctime>

#include "palpate/devices/device.h"

namespace palpate::devices {
namespace {

/// [ns] Longer than the delay of most wake-ups on a stock kernel: 80 us, or 8 % of a 1 kHz tick.
constexpr std::int64_t kSpin = 80'000;  // [ns]

/// [ns] A stop requested by another thread does not wake a sleeping loop: in a slow loop the device
/// would hold its force until the next tick is due.
constexpr std::int64_t kLongestSleep = 10'000'000;  // [ns]

}  // namespace

std::int64_t monotonicNs() noexcept {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return std::int64_t{now.tv_sec} * 1'000'000'000 + now.tv_nsec;
}

void sleepUntil(std::int64_t due, const std::atomic<bool>& stop) noexcept {
  const std::int64_t wake = due - kSpin;
  for (std::int64_t now = monotonicNs(); now < wake; now = monotonicNs()) {
    if (stop.load(std::memory_order_relaxed)) return;
    const std::int64_t next = std::min(wake, now + kLongestSleep);
    timespec until{};
    until.tv_sec = next / 1'000'000'000;
    until.tv_nsec = next % 1'000'000'000;
    clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &until, nullptr);  // EINTR: check `stop` again
  }
  while (monotonicNs() < due) {
  }
}

Elevation::Elevation(bool elevate, bool timers) noexcept {
  if (timers) {
    const int slack = prctl(PR_GET_TIMERSLACK, 0, 0, 0, 0);
    if (slack > 0 && prctl(PR_SET_TIMERSLACK, 1, 0, 0, 0) == 0) old_slack_ = slack;
  }
  if (!elevate) return;
  sched_param old{};
  if (pthread_getschedparam(pthread_self(), &old_policy_, &old) == 0) {
    old_priority_ = old.sched_priority;
    sched_param wanted{};
    wanted.sched_priority = kServoPriority;
    priority_error_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted);
    has_priority_ = priority_error_ == 0;
  }
  // The memory mapped now is all that the loop uses. MCL_FUTURE would make other threads'
  // allocations fail wherever the limit on locked memory is finite.
  has_locked_memory_ = mlockall(MCL_CURRENT) == 0;
  if (!has_locked_memory_) memory_error_ = errno;
}

Elevation::~Elevation() {
  if (has_locked_memory_) munlockall();
  if (has_priority_) {
    sched_param old{};
    old.sched_priority = old_priority_;
    pthread_setschedparam(pthread_self(), old_policy_, &old);
  }
  if (old_slack_ >= 0) prctl(PR_SET_TIMERSLACK, static_cast<unsigned long>(old_slack_), 0, 0, 0);
}

}  // namespace palpate::devices
