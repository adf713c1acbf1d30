#include "devices/virtual_clock.h"

#include <sys/syscall.h>
#include <unistd.h>

#include <atomic>
#include <cstdint>
#include <ctime>

namespace palpate::devices {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;  // [ns]
constexpr std::int64_t kLook = 500;              // [ns] that reading the clock takes

std::int64_t realTime() {
  timespec now{};
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return kSecond * static_cast<std::int64_t>(now.tv_sec) + now.tv_nsec;
}

std::atomic<const FalconEmulator*> falcon_of_time{nullptr};
std::atomic<std::int64_t> began{0};
std::atomic<std::int64_t> looks{0};

}  // namespace

VirtualClock::VirtualClock(const FalconEmulator& falcon) {
  began = realTime() - falcon.now();
  looks = 0;
  falcon_of_time = &falcon;
}

VirtualClock::~VirtualClock() { falcon_of_time = nullptr; }

}  // namespace palpate::devices

/// Replaces the C library's clock_gettime() for the whole process.
extern "C" int clock_gettime(clockid_t id, timespec* out) {
  using namespace palpate::devices;
  const FalconEmulator* const falcon = falcon_of_time;
  if (id != CLOCK_MONOTONIC || falcon == nullptr) {
    return static_cast<int>(syscall(SYS_clock_gettime, id, out));
  }
  const std::int64_t now = began + falcon->now() + kLook * ++looks;
  out->tv_sec = now / kSecond;
  out->tv_nsec = now % kSecond;
  return 0;
}
