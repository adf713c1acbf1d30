#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <optional>
#include <system_error>

#include "evdev/event_node.h"
#include "evdev/input_hand.h"
#include "palpate/core/error.h"
#include "palpate/devices/evdev.h"
#include "servo_clock.h"

namespace palpate::devices {
namespace {

/// The most reads in one turn: 2048 events, more than the kernel buffers for a device.
constexpr int kMostReads = 32;
constexpr std::size_t kEvents = 64;

bool isAtLeast(double value, double least) { return std::isfinite(value) && value >= least; }

void check(const EvdevSettings& s) {
  const auto refuse = [](const std::string& what) {
    throw Error(ErrorKind::kUsage, {"evdev.settings", "an input device's " + what, ""});
  };
  if (!isAtLeast(s.max_speed, 0.0)) refuse("largest speed must be a number, 0 m/s or more");
  if (!isAtLeast(s.max_turn, 0.0)) refuse("largest turn must be a number, 0 rad/s or more");
  if (!(s.dead_zone >= 0.0 && s.dead_zone < 1.0)) refuse("dead zone must be 0 to below 1");
  if (!isAtLeast(s.meters_per_count, 0.0)) refuse("meters a count must be a number, 0 or more");
  if (!isAtLeast(s.meters_per_notch, 0.0)) refuse("meters a notch must be a number, 0 or more");
  if (!s.workspace.isBounded()) refuse("workspace must be a box of finite size");
}

Error cannotOpen(const std::string& node, int error) {
  const bool is_denied = error == EACCES || error == EPERM;
  return {ErrorKind::kDevice,
          {is_denied ? "evdev.access" : "evdev.open",
           node + " cannot be opened: " + std::generic_category().message(error),
           is_denied ? inputAccessRemedy() : "`palpate devices` lists the input devices that fit"}};
}

/// The first node that fits.
std::string findNode() {
  const std::vector<InputDevice> all = listInputDevices();
  const InputDevice* best = nullptr;
  bool is_denied = false;
  for (const InputDevice& each : all) {
    is_denied = is_denied || !each.is_accessible;
    if (each.kind && (best == nullptr || *each.kind < *best->kind)) best = &each;
  }
  if (best != nullptr) return best->node;
  throw Error(
      ErrorKind::kDevice,
      {is_denied ? "evdev.access" : "evdev.none",
       is_denied ? "no SpaceMouse, gamepad or mouse was found, and some input devices cannot "
                   "be opened by this user"
                 : "no SpaceMouse, gamepad or mouse is plugged in",
       is_denied ? inputAccessRemedy() : "plug one in"});
}

class EvdevDevice final : public Device {
 public:
  explicit EvdevDevice(EvdevSettings settings) : settings_(std::move(settings)) {
    info_.name = "evdev";
    info_.workspace = settings_.workspace;
  }
  ~EvdevDevice() override { node_.close(); }
  EvdevDevice(const EvdevDevice&) = delete;
  EvdevDevice& operator=(const EvdevDevice&) = delete;

  void open() override {
    close();
    try {
      openNode(settings_.node.empty() ? findNode() : settings_.node);
    } catch (...) {
      close();
      throw;
    }
  }
  void close() noexcept override {
    node_.close();
    hand_.reset();
  }
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  /// The device has no motors: max_force is 0.
  [[nodiscard]] DeviceStatus write(const Vec3& /*force*/) noexcept override {
    return hand_ ? DeviceStatus::kOk : DeviceStatus::kDisconnected;
  }

 private:
  void openNode(const std::string& path);
  [[nodiscard]] bool drain(std::int64_t now) noexcept;
  [[nodiscard]] bool takeAll(const input_event* events, std::size_t count,
                             std::int64_t now) noexcept;
  [[nodiscard]] bool askAll() noexcept;

  EvdevSettings settings_;
  DeviceInfo info_;
  evdev::EventNode node_;
  std::optional<evdev::InputHand> hand_;  // has a value while it is open and plugged in
  std::array<std::uint16_t, evdev::kMostAxes> absolute_{};
  std::size_t absolute_count_ = 0;
  bool has_times_ = false;
  std::int64_t began_ = 0;  // [ns]
  std::int64_t last_ = 0;   // [ns] of the last reading
  Vec3 place_{0.0, 0.0, 0.0};
};

void EvdevDevice::openNode(const std::string& path) {
  if (const int error = node_.open(path); error != 0) throw cannotOpen(path, error);
  const auto has = node_.capabilities();
  const auto map = has ? evdev::mapOf(*has) : std::nullopt;
  if (!map) {
    throw Error(ErrorKind::kDevice, {"evdev.kind",
                                     path + (has ? " is not a SpaceMouse, a gamepad or a mouse"
                                                 : " is not an event node"),
                                     "`palpate devices` lists the input devices that fit"});
  }
  info_.name = "evdev, " + std::string(nameOf(map->kind)) + ": " + node_.name();
  info_.buttons = static_cast<int>(map->buttons.size());
  absolute_count_ = 0;
  for (const evdev::AxisMap& axis : map->axes) {
    if (axis.type == EV_ABS) absolute_[absolute_count_++] = axis.code;
  }
  has_times_ = node_.setMonotonic();
  began_ = monotonicNs();
  last_ = began_;
  hand_.emplace(*map, settings_, began_);
  place_ = hand_->position();
  if (!askAll()) {
    throw Error(ErrorKind::kDevice, {"evdev.open", path + " does not report its present state",
                                     "unplug the device and plug it in again"});
  }
}

/// Reads the present state of all axes and keys.
bool EvdevDevice::askAll() noexcept {
  std::bitset<KEY_CNT> keys;
  if (!node_.keys(keys)) return false;
  hand_->setKeys(keys);
  for (std::size_t i = 0; i < absolute_count_; ++i) {
    std::int32_t value = 0;
    if (!node_.value(absolute_[i], value)) return false;
    hand_->setAxis(absolute_[i], value);
  }
  return true;
}

bool EvdevDevice::takeAll(const input_event* events, std::size_t count, std::int64_t now) noexcept {
  for (std::size_t i = 0; i < count; ++i) {
    const input_event& event = events[i];
    std::int64_t at = now;
    if (has_times_) {
      at = std::int64_t{event.input_event_sec} * 1'000'000'000 +
           std::int64_t{event.input_event_usec} * 1'000;
    }
    const bool has_dropped = hand_->take(event.type, event.code, event.value, std::min(at, now));
    if (has_dropped && !askAll()) return false;
  }
  return true;
}

/// Takes all waiting events; false if the device is gone.
bool EvdevDevice::drain(std::int64_t now) noexcept {
  std::array<input_event, kEvents> events;
  for (int reads = 0; reads < kMostReads; ++reads) {
    const ssize_t bytes = node_.read(events.data(), events.size());
    if (bytes < 0 && errno == EINTR) continue;
    if (bytes < 0) return errno == EAGAIN;
    if (bytes == 0) return false;
    if (!takeAll(events.data(), static_cast<std::size_t>(bytes) / sizeof(input_event), now)) {
      return false;
    }
  }
  return true;
}

DeviceStatus EvdevDevice::read(DeviceState& out) noexcept {
  if (!hand_) return DeviceStatus::kDisconnected;
  const std::int64_t now = monotonicNs();
  if (!drain(now)) {
    hand_.reset();
    return DeviceStatus::kDisconnected;
  }
  hand_->advance(now);
  const double dt = 1e-9 * static_cast<double>(now - last_);
  out.time = 1e-9 * static_cast<double>(now - began_);
  out.position = hand_->position();
  out.velocity = dt > 0.0 ? (out.position - place_) / dt : Vec3(0.0);
  out.buttons = hand_->buttons();
  out.is_homed = true;
  out.orientation = hand_->orientation();
  last_ = now;
  place_ = out.position;
  return DeviceStatus::kOk;
}

}  // namespace

std::unique_ptr<Device> makeEvdev(const EvdevSettings& settings) {
  check(settings);
  return std::make_unique<EvdevDevice>(settings);
}

}  // namespace palpate::devices
