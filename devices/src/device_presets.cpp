#include "palpate/devices/device_presets.h"

#include <array>

#include "palpate/core/error.h"

namespace palpate::devices {
namespace {

constexpr Quantity sourced(double value, std::string_view source) {
  return {value, Known::kSourced, source};
}
constexpr Quantity unverified(double value) {
  return {value, Known::kUnverified, "the maker's data sheet, as passed on"};
}
constexpr Quantity assumed(double value, std::string_view why = "of the size of such a device") {
  return {value, Known::kAssumed, why};
}

constexpr std::string_view kPaper = "the source paper's section on its interface";
constexpr std::string_view kChai = "CHAI3D's table of devices";
constexpr std::string_view kReseller = "a reseller's specification";
constexpr std::string_view kKinematics =
    "computed from public kinematics and encoders: 0.015 to 0.045 mm";

constexpr std::array kDevices = {
    DevicePreset{"excalibur", "Excalibur (Haptic Technologies)", assumed(1.5), assumed(5.0),
                 assumed(1.0), sourced(8e-6, kPaper), sourced(100.0, kPaper), sourced(0.3, kPaper),
                 sourced(0.3, kPaper), sourced(0.2, kPaper)},
    DevicePreset{"falcon", "Falcon (Novint)", assumed(0.2), assumed(0.5), assumed(0.4),
                 sourced(40e-6, kKinematics), sourced(8.0, kChai), unverified(0.1016),
                 unverified(0.1016), unverified(0.1016)},
    DevicePreset{"touch", "Touch (3D Systems)", unverified(0.045), assumed(0.02), unverified(0.26),
                 unverified(55e-6), sourced(3.3, kChai), unverified(0.16), unverified(0.12),
                 unverified(0.07)},
    DevicePreset{"touch_x", "Touch X (3D Systems)", unverified(0.045), assumed(0.01),
                 unverified(0.06), unverified(23e-6), sourced(7.9, kChai), unverified(0.16),
                 unverified(0.12), unverified(0.12)},
    DevicePreset{"premium_1_0", "Phantom Premium 1.0 (3D Systems)", unverified(0.075),
                 assumed(0.005), unverified(0.04), unverified(30e-6), unverified(8.5),
                 unverified(0.254), unverified(0.178), unverified(0.127)},
    DevicePreset{"premium_1_5", "Phantom Premium 1.5 (3D Systems)", unverified(0.075),
                 assumed(0.01), unverified(0.04), unverified(30e-6), sourced(8.5, kChai),
                 unverified(0.381), unverified(0.267), unverified(0.191)},
    DevicePreset{"omega_3", "omega.3 (Force Dimension)", assumed(0.2), assumed(0.3), assumed(0.3),
                 assumed(9e-6, "its maker says below 0.01 mm"), sourced(12.0, kChai),
                 unverified(0.16), unverified(0.16), unverified(0.11)},
    DevicePreset{"delta_3", "delta.3 (Force Dimension)", assumed(0.25), assumed(0.4), assumed(0.4),
                 assumed(20e-6, "its maker says below 0.02 mm"), sourced(20.0, kChai),
                 unverified(0.4), unverified(0.4), unverified(0.26)},
    DevicePreset{"inverse3", "Inverse3 (Haply)", assumed(0.2), assumed(0.2), assumed(0.3),
                 sourced(10e-6, kReseller), sourced(10.0, kReseller), sourced(0.51, kReseller),
                 sourced(0.46, kReseller), sourced(0.23, kReseller)},
};

const std::array<HandPreset, 2>& hands() {
  static const std::array<HandPreset, 2> all = {
      HandPreset{"relaxed",
                 {"relaxed", 0.1, 4.0, 250.0, 800.0, 3.0},
                 "two fingers that hold a stylus lightly"},
      HandPreset{"firm", {"firm", 0.3, 15.0, 1000.0, 4000.0, 12.0}, "a fist about a grip"},
  };
  return all;
}

template <typename Presets>
std::string namesOf(const Presets& presets) {
  std::string names;
  for (const auto& each : presets) {
    names += (names.empty() ? "" : ", ") + std::string(each.name);
  }
  return names;
}

}  // namespace

DeviceModel DevicePreset::model() const {
  DeviceModel device;
  device.name = std::string(name);
  device.mass = mass.value;
  device.damping = damping.value;
  device.friction = friction.value;
  device.encoder = encoder.value;
  device.max_force = max_force.value;
  const Vec3 half = 0.5 * Vec3(width.value, height.value, depth.value);
  device.workspace = {-half, half};
  return device;
}

std::span<const DevicePreset> devicePresets() noexcept { return kDevices; }
std::span<const HandPreset> handPresets() noexcept { return hands(); }

const DevicePreset& devicePreset(std::string_view name) {
  for (const DevicePreset& each : kDevices) {
    if (each.name == name) return each;
  }
  throw Error(ErrorKind::kUsage,
              {"device.unknown", "there is no device '" + std::string(name) + "'",
               "one of " + namesOf(kDevices)});
}

std::optional<HandModel> handPreset(std::string_view name) {
  if (name == "none") return std::nullopt;
  for (const HandPreset& each : hands()) {
    if (each.name == name) return each.model;
  }
  throw Error(ErrorKind::kUsage, {"hand.unknown", "there is no hand '" + std::string(name) + "'",
                                  "one of none, " + namesOf(hands())});
}

std::string_view markOf(Known known) noexcept {
  switch (known) {
    case Known::kSourced:
      return "";
    case Known::kUnverified:
      return " (not verified)";
    case Known::kAssumed:
      break;
  }
  return " (assumed)";
}

}  // namespace palpate::devices
