// Connects an emulated Falcon to a program that is started with this library preloaded
// (LD_PRELOAD): its device node is the open descriptor kDescriptor, and time is the Falcon's.
// FAKE_FALCON_HAND names a file with the path that the hand intends, rows `t x y z` in s and m of
// the device's frame; FAKE_FALCON_LOG one for the forces of the motors, rows `x,y,z,quantum` in N,
// one for each command (FalconEmulator::quantum). At command number FAKE_FALCON_AT the process gets
// the signal FAKE_FALCON_SIGNAL, or, if that is 0, the cable is unplugged. Everything between the
// command line and the kernel is the real code.

#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <vector>

#include "devices/falcon_emulator.h"
#include "devices/usbfs_emulation.h"
#include "devices/virtual_clock.h"

namespace palpate::devices {
namespace {

constexpr int kDescriptor = 100;
const Vec3 kOrigin(0.0, 0.0, 0.125);  // [m] of the device's frame, in that of its base

struct Waypoint {
  double time = 0.0;  ///< [s]
  Vec3 place{0.0};    ///< [m] in the frame of the base
};

class PluggedFalcon {
 public:
  PluggedFalcon() {
    dup2(usb_.descriptor(), kDescriptor);
    usb_.answerFor(kDescriptor);
    if (const char* file = std::getenv("FAKE_FALCON_HAND")) readHand(file);
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
      (void)std::fprintf(log_, "%.17g,%.17g,%.17g,%.17g\n", f.x, f.y, f.z, emulator_.quantum);
    };
  }
  ~PluggedFalcon() {
    if (log_ != nullptr) (void)std::fclose(log_);
  }
  PluggedFalcon(const PluggedFalcon&) = delete;
  PluggedFalcon& operator=(const PluggedFalcon&) = delete;

 private:
  static std::uint64_t numberOf(const char* name, std::uint64_t otherwise) {
    const char* text = std::getenv(name);
    return text == nullptr ? otherwise : std::strtoull(text, nullptr, 10);
  }

  void readHand(const char* file) {
    std::ifstream in(file);
    Waypoint row;
    while (in >> row.time >> row.place.x >> row.place.y >> row.place.z) {
      row.place += kOrigin;
      way_.push_back(row);
    }
  }

  /// Linear from row to row; at rest before the first and after the last one.
  [[nodiscard]] Vec3 target(double time) const {
    if (way_.empty()) return kOrigin;
    if (time <= way_.front().time) return way_.front().place;
    for (std::size_t i = 1; i < way_.size(); ++i) {
      const Waypoint& a = way_[i - 1];
      const Waypoint& b = way_[i];
      if (time < b.time) return a.place + (time - a.time) / (b.time - a.time) * (b.place - a.place);
    }
    return way_.back().place;
  }

  std::vector<Waypoint> way_;
  FalconEmulator emulator_;
  UsbfsEmulation usb_{emulator_};
  VirtualClock clock_{emulator_};
  std::FILE* log_ = nullptr;
};

PluggedFalcon& plugged() {
  static PluggedFalcon one;
  return one;
}

/// Runs before main(), so that the descriptor is open by then.
[[maybe_unused]] const bool kIsPlugged = (plugged(), true);

}  // namespace
}  // namespace palpate::devices
