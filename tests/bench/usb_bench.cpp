// Speed and regularity of a Falcon's commands and replies through the usual libusb. The kernel's
// side is emulated in this process (tests/devices/usbfs_emulation.h), so that only libusb, the
// driver and this machine's scheduler take time. Measured in wall-clock time, for information.
//   palpate_usb_bench [SECONDS]   for each row (default 2)

#include <pthread.h>
#include <sched.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "devices/falcon_rig.h"
#include "falcon/packet.h"
#include "palpate/devices/latency_histogram.h"
#include "support/busy_threads.h"
#include "usb/ftdi.h"
#include "usb/transport.h"

namespace palpate::devices {
namespace {

using Clock = std::chrono::steady_clock;

/// Gives this thread a real-time priority; threads made before keep theirs.
class Priority {
 public:
  Priority() {
    sched_param wanted{};
    wanted.sched_priority = kServoPriority;
    is_granted_ = pthread_setschedparam(pthread_self(), SCHED_FIFO, &wanted) == 0;
  }
  ~Priority() {
    const sched_param none{};
    if (is_granted_) (void)pthread_setschedparam(pthread_self(), SCHED_OTHER, &none);
  }
  Priority(const Priority&) = delete;
  Priority& operator=(const Priority&) = delete;
  [[nodiscard]] bool isGranted() const { return is_granted_; }

 private:
  bool is_granted_ = false;
};

/// Calls `cycle` for `seconds`; if it returns false, the process ends.
void measure(const char* what, unsigned load, bool wants_priority, double seconds,
             const std::function<bool()>& cycle) {
  // The kernel preempts a real-time thread that computes for 0.95 s of a second.
  constexpr std::chrono::milliseconds kBusy(400);
  constexpr std::chrono::milliseconds kRest(100);
  const BusyThreads others(load);
  std::optional<Priority> priority;
  if (wants_priority) priority.emplace();
  LatencyHistogram times;
  std::chrono::duration<double> spent(0.0);
  while (spent.count() < seconds) {
    const auto begin = Clock::now();
    auto now = begin;
    while (now - begin < kBusy) {
      if (!cycle()) {
        (void)std::fprintf(stderr, "error: %s: a cycle failed\n", what);
        std::exit(1);
      }
      const auto after = Clock::now();
      times.add(std::chrono::duration_cast<std::chrono::nanoseconds>(after - now).count());
      now = after;
    }
    spent += now - begin;
    std::this_thread::sleep_for(kRest);
  }
  const char* word = !wants_priority ? "none" : priority->isGranted() ? "FIFO" : "refused";
  const auto micros = [&](double share) {
    return 1e-3 * static_cast<double>(times.quantile(share));
  };
  std::printf("%-42s %4u %8s %9.0f %8.1f %8.1f %8.1f %9.1f\n", what, load, word,
              static_cast<double>(times.count()) / spent.count(), micros(0.5), micros(0.99),
              micros(0.999), 1e-3 * static_cast<double>(times.longest()));
}

/// Sends one command, and reads packets until a reply is complete.
bool exchange(usb::Transport& transport, falcon::Parser& parser) {
  static const falcon::Packet idle = falcon::encode({});
  if (transport.send(idle) != usb::Status::kOk) return false;
  std::array<std::uint8_t, usb::Transport::kPacket> packet{};
  constexpr int kMost = 1000;
  for (int i = 0; i < kMost; ++i) {
    std::size_t got = 0;
    if (transport.receive(packet, got, 100) != usb::Status::kOk) return false;
    for (const std::uint8_t byte : usb::payload(std::span(packet).first(got))) {
      if (parser.push(byte)) return true;
    }
  }
  return false;
}

void run(double seconds) {
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  std::printf(
      "cycle: one command out and its reply in                busy priority  cycles/s   us: 50 %%  "
      "   "
      "99 %%   99.9 %%       max\n");
  for (const bool wants_priority : {false, true}) {
    for (const unsigned load : {0U, cores}) {
      {
        FalconEmulator emulator;
        emulator.moves = false;
        const UsbfsEmulation usb(emulator);
        const auto transport = usb::openUsb({.descriptor = usb.descriptor()});
        (void)usb::control(*transport, {usb::ftdi::kBaud1500k});
        falcon::Parser parser;
        measure("libusb: a bulk OUT and its bulk IN", load, wants_priority, seconds,
                [&] { return exchange(*transport, parser); });
      }
      Rig rig;
      rig.emulator.moves = false;
      rig.device.open();
      DeviceState state;
      measure("the driver: write(), read(), kinematics", load, wants_priority, seconds, [&] {
        return rig.device.write(Vec3(0.0, 0.0, 1.0)) == DeviceStatus::kOk &&
               rig.device.read(state) == DeviceStatus::kOk;
      });
    }
  }
}

}  // namespace
}  // namespace palpate::devices

int main(int argc, char** argv) {
  const double seconds = argc > 1 ? std::atof(argv[1]) : 2.0;
  if (argc > 2 || !(seconds > 0.0)) {
    (void)std::fprintf(stderr, "usage: palpate_usb_bench [SECONDS]\n");
    return 2;
  }
  palpate::devices::run(seconds);
}
