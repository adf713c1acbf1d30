#include "real_device.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <utility>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/device_access.h"
#include "palpate/devices/evdev.h"
#include "palpate/devices/falcon.h"
#include "palpate/devices/inverse3.h"
#include "palpate/devices/plugins.h"

namespace palpate::tools {
namespace {

constexpr std::array<std::string_view, 4> kNames = {"falcon", "inverse3", "dhd", "hd"};
constexpr std::string_view kInput = "evdev";

/// An option, whether it is given, and the devices that accept it.
struct GivenOption {
  const char* name;
  bool is_given;
  std::vector<std::string_view> devices;
};

std::vector<GivenOption> optionsOf(const RealDeviceOptions& o) {
  return {{"--serial", !o.serial.empty(), {"falcon"}},
          {"--descriptor", o.descriptor.has_value(), {"falcon"}},
          {"--firmware", !o.firmware.empty(), {"falcon"}},
          {"--calibration", !o.calibration.empty(), {"falcon"}},
          {"--library", !o.library.empty(), {"hd", "dhd"}},
          {"--service", !o.service.empty(), {"inverse3"}}};
}

/// Wraps another device, and ends after a time.
class TimedDevice final : public devices::Device {
 public:
  TimedDevice(std::unique_ptr<devices::Device> device, double seconds)
      : device_(std::move(device)), length_(seconds) {}
  void open() override {
    device_->open();
    opened_ = Clock::now();
  }
  void close() noexcept override { device_->close(); }
  [[nodiscard]] const devices::DeviceInfo& info() const noexcept override {
    return device_->info();
  }
  [[nodiscard]] devices::DeviceStatus read(devices::DeviceState& out) noexcept override {
    const std::chrono::duration<double> since = Clock::now() - opened_;
    return since.count() < length_ ? device_->read(out) : devices::DeviceStatus::kEnd;
  }
  [[nodiscard]] devices::DeviceStatus write(const Vec3& force) noexcept override {
    return device_->write(force);
  }
  [[nodiscard]] devices::DeviceStatus writeWrench(const Vec3& force,
                                                  const Vec3& torque) noexcept override {
    return device_->writeWrench(force, torque);
  }
  void cut() noexcept override { device_->cut(); }

 private:
  using Clock = std::chrono::steady_clock;
  std::unique_ptr<devices::Device> device_;
  double length_;  ///< [s]
  Clock::time_point opened_;
};

std::unique_ptr<devices::Device> falcon(const RealDeviceOptions& o) {
  devices::FalconSettings settings;
  settings.serial = o.serial;
  settings.descriptor = o.descriptor.value_or(-1);
  settings.firmware = o.firmware;
  if (!o.calibration.empty()) settings.calibration = devices::readFalconCalibration(o.calibration);
  return devices::makeFalcon(settings);
}

devices::Inverse3Settings serviceOf(const std::string& text) {
  devices::Inverse3Settings settings;
  if (text.empty()) return settings;
  const std::size_t colon = text.rfind(':');
  const std::string port = colon == std::string::npos ? "" : text.substr(colon + 1);
  const auto end = std::from_chars(port.data(), port.data() + port.size(), settings.port);
  const bool is_port = end.ec == std::errc() && end.ptr == port.data() + port.size();
  if (!is_port || colon == 0) {
    throw Error(
        ErrorKind::kUsage,
        {"usage.device", "--service must be HOST:PORT, such as 127.0.0.1:10001, not " + text, ""});
  }
  settings.host = text.substr(0, colon);
  return settings;
}

std::unique_ptr<devices::Device> inputDevice(const std::string& name) {
  devices::EvdevSettings settings;
  if (name.size() > kInput.size()) settings.node = name.substr(kInput.size() + 1);
  return devices::makeEvdev(settings);
}

std::unique_ptr<devices::Device> driverOf(const std::string& name, const RealDeviceOptions& o) {
  if (isInputDevice(name)) return inputDevice(name);
  if (name == "hd") return devices::makeOpenHaptics({o.library});
  if (name == "dhd") return devices::makeForceDimension({o.library});
  if (name == "inverse3") return devices::makeInverse3(serviceOf(o.service));
  return falcon(o);
}

}  // namespace

bool isInputDevice(std::string_view name) {
  const bool has_node = name.size() > kInput.size() + 1 && name[kInput.size()] == ':';
  return name == kInput || (name.substr(0, kInput.size()) == kInput && has_node);
}

bool isRealDevice(std::string_view name) {
  return isInputDevice(name) || std::find(kNames.begin(), kNames.end(), name) != kNames.end();
}

const char* noticeOf(std::string_view name) {
  return isInputDevice(name) ? devices::kEvdevNotice : devices::kUnverifiedNotice;
}

std::string givenOption(const RealDeviceOptions& options) {
  for (const GivenOption& option : optionsOf(options)) {
    if (option.is_given) return option.name;
  }
  return {};
}

std::unique_ptr<devices::Device> makeRealDevice(const std::string& name,
                                                const RealDeviceOptions& options,
                                                std::optional<double> seconds) {
  if (!isRealDevice(name)) {
    throw Error(ErrorKind::kUsage,
                {"usage.device", "no driver is known for a device '" + name + "'",
                 "the devices are falcon, inverse3, dhd, hd, evdev and evdev:/dev/input/eventN"});
  }
  for (const GivenOption& option : optionsOf(options)) {
    const auto& of = option.devices;
    if (option.is_given && std::find(of.begin(), of.end(), name) == of.end()) {
      throw Error(
          ErrorKind::kUsage,
          {"usage.device", std::string(option.name) + " does not apply to the device " + name, ""});
    }
  }
  auto device = driverOf(name, options);
  if (!seconds) return device;
  return std::make_unique<TimedDevice>(std::move(device), *seconds);
}

}  // namespace palpate::tools
