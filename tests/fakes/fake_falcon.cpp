// Plugs an emulated Falcon into a program that was started with this library before all others (LD_PRELOAD): its node is the
// open descriptor kDescriptor, and time is the Falcon's. FAKE_FALCON_LOG names a file for what its motors gave; at command
// number FAKE_FALCON_AT the process gets the signal FAKE_FALCON_SIGNAL, or the cable is pulled if that is 0. Everything between
// the command line and the kernel is the real thing.

#include <sys/syscall.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "devices/falcon_emulator.h"
#include "devices/usbfs_emulation.h"

namespace palpate::devices {
namespace {

constexpr int kDescriptor = 100;

std::int64_t realTime() {
  timespec now{};
  syscall(SYS_clock_gettime, CLOCK_MONOTONIC, &now);
  return 1'000'000'000 * static_cast<std::int64_t>(now.tv_sec) + now.tv_nsec;
}

class PluggedFalcon {
 public:
  PluggedFalcon() : began_(realTime()) {
    dup2(usb_.descriptor(), kDescriptor);
    usb_.answerFor(kDescriptor);
    if (const char* file = std::getenv("FAKE_FALCON_LOG")) log_ = std::fopen(file, "w");
    emulator_.damping = 7.0;
    emulator_.place(target(0.0));
    emulator_.hand = [this](const Vec3& p) {
      return 250.0 * (target(1e-9 * static_cast<double>(emulator_.now())) - p);
    };
    const std::uint64_t at = numberOf("FAKE_FALCON_AT", ~std::uint64_t{0});
    const int signal = static_cast<int>(numberOf("FAKE_FALCON_SIGNAL", 0));
    usb_.fault = [=, this](UsbfsEmulation::Step) {
      return signal == 0 && emulator_.commands >= at ? ENODEV : 0;
    };
    emulator_.damage = [=, this](std::vector<std::uint8_t>& /*reply*/) {
      if (signal != 0 && emulator_.commands == at) (void)kill(getpid(), signal);
      if (log_ == nullptr) return;
      const Vec3& f = emulator_.felt;
      (void)std::fprintf(log_, "%.17g,%.17g,%.17g\n", f.x, f.y, f.z);
    };
  }
  ~PluggedFalcon() {
    if (log_ != nullptr) (void)std::fclose(log_);
  }
  PluggedFalcon(const PluggedFalcon&) = delete;
  PluggedFalcon& operator=(const PluggedFalcon&) = delete;

  /// [ns] Each look at the clock takes a little.
  std::int64_t now() { return began_ + emulator_.now() + 500 * ++looks_; }

 private:
  static std::uint64_t numberOf(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
  }

  /// Where the hand wants to be, in the frame of the base: 30 mm above the middle, from 0.8 s on 90 mm down and back up.
  static Vec3 target(double time) {
    constexpr double kWay = 2.0;  // [s] each
    const double t = std::clamp(time - 0.8, 0.0, 2.0 * kWay);
    const double down = t < kWay ? t / kWay : 2.0 - t / kWay;
    return {0.005, 0.0, 0.125 + 0.030 - 0.090 * down};
  }

  std::int64_t began_;
  FalconEmulator emulator_;
  UsbfsEmulation usb_{emulator_};
  std::FILE* log_ = nullptr;
  std::atomic<std::int64_t> looks_{0};
};

PluggedFalcon& plugged() {
  static PluggedFalcon one;
  return one;
}

/// Before main(), so that the descriptor is open.
[[maybe_unused]] const bool kIsPlugged = (plugged(), true);

}  // namespace
}  // namespace palpate::devices

extern "C" int clock_gettime(clockid_t id, timespec* out) {
  if (id != CLOCK_MONOTONIC) return static_cast<int>(syscall(SYS_clock_gettime, id, out));
  const std::int64_t now = palpate::devices::plugged().now();
  out->tv_sec = now / 1'000'000'000;
  out->tv_nsec = now % 1'000'000'000;
  return 0;
}
