#include "bench/servo_case.h"

#include <array>
#include <atomic>
#include <chrono>
#include <cstdio>
#include <system_error>

#include "palpate/devices/device.h"
#include "realtime_report.h"
#include "stop_signal.h"
#include "support/busy_threads.h"

namespace palpate::tools {
namespace {

/// A device that answers reads at once and accepts every force.
class NullDevice final : public devices::Device {
 public:
  void open() override {}
  void close() noexcept override {}
  [[nodiscard]] const devices::DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] devices::DeviceStatus read(devices::DeviceState& /*out*/) noexcept override {
    return devices::DeviceStatus::kOk;
  }
  [[nodiscard]] devices::DeviceStatus write(const Vec3& /*force*/) noexcept override {
    return devices::DeviceStatus::kOk;
  }

 private:
  devices::DeviceInfo info_{"null", 1.0, {}};
};

std::string micros(std::int64_t ns) {
  std::array<char, 32> text{};
  (void)std::snprintf(text.data(), text.size(), "%9.1f", 1e-3 * static_cast<double>(ns));
  return text.data();
}

constexpr double kRarely = 1e-4;  // share of turns that may be missed

}  // namespace

bool ServoFigures::isGood() const {
  const double half_period = 0.5e9 / rate;
  const auto turns = static_cast<double>(report.lateness.count());
  return static_cast<double>(report.overruns) <= kRarely * turns &&
         static_cast<double>(report.lateness.quantile(0.999)) <= half_period;
}

ServoFigures measureServo(double rate, int load, double seconds) {
  ServoFigures out;
  out.rate = rate;
  out.load = load;
  out.seconds = seconds;
  NullDevice device;
  std::atomic<bool> is_over{false};
  const BusyThreads others(static_cast<unsigned>(load));
  const auto begin = std::chrono::steady_clock::now();
  const auto tick = [&](const devices::DeviceState& /*state*/) {
    const std::chrono::duration<double> since = std::chrono::steady_clock::now() - begin;
    if (since.count() >= seconds || stopRequested()) is_over = true;
    return Vec3(0.0);
  };
  out.report = devices::runServo(
      device, tick, {.realtime = true, .rate = rate, .elevate = devices::Elevate::kPrefer},
      is_over);
  checkStop();
  return out;
}

Json servoJson(const std::vector<ServoFigures>& figures) {
  Json out = Json::array();
  for (const ServoFigures& f : figures) {
    const auto& late = f.report.lateness;
    out.push_back({{"rate_Hz", f.rate},
                   {"load_threads", f.load},
                   {"turns", late.count()},
                   {"overruns", f.report.overruns},
                   {"late_ns", latencyJson(late)},
                   {"priority", f.report.has_priority},
                   {"locked_memory", f.report.has_locked_memory},
                   {"good", f.isGood()}});
  }
  return out;
}

std::string servoText(const std::vector<ServoFigures>& figures) {
  std::string text =
      "   rate  load      turns   missed   late: 50 %      99 %    99.9 %       max us  good "
      "enough\n";
  for (const ServoFigures& f : figures) {
    const auto& late = f.report.lateness;
    std::array<char, 96> head{};
    (void)std::snprintf(head.data(), head.size(), "%7.0f %5d %10llu %8llu   ", f.rate, f.load,
                        static_cast<unsigned long long>(late.count()),
                        static_cast<unsigned long long>(f.report.overruns));
    text += head.data() + micros(late.quantile(0.5)) + " " + micros(late.quantile(0.99)) + " " +
            micros(late.quantile(0.999)) + " " + micros(late.longest()) + "     " +
            (f.isGood() ? "yes" : "no") + "\n";
  }
  if (figures.empty()) return text;
  const devices::ServoReport& last = figures.back().report;
  const auto word = [](bool has, int error) {
    return has ? std::string("granted")
               : "refused (" + std::generic_category().message(error) + ")";
  };
  return text + "Real-time priority " + word(last.has_priority, last.priority_error) +
         ", locked memory " + word(last.has_locked_memory, last.memory_error) +
         "\nGood enough: at most one turn in ten thousand missed, and 99.9 % no later than half a "
         "period\n";
}

}  // namespace palpate::tools
