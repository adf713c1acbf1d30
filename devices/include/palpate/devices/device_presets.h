#pragma once
/// Devices and hands by name, each number with its source.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "palpate/devices/device_model.h"
#include "palpate/export.h"

namespace palpate::devices {

/// How far a number can be trusted.
enum class Known : std::uint8_t {
  kSourced,     ///< read in the source that is named
  kUnverified,  ///< stated by its maker and quoted in the field, but not read in a source
  kAssumed,     ///< no source gives it
};

/// A number of a preset, and how it is known. The preset states the unit.
struct Quantity {
  double value = 0.0;             ///< [SI]
  Known known = Known::kAssumed;  ///< how far to trust `value`
  std::string_view source = {};   ///< who states it; for an assumed number, the reason
};

/// Effective mass, damping and friction are those at the tip, in the middle of the workspace.
struct DevicePreset {
  std::string_view name;   ///< on the command line
  std::string_view title;  ///< its maker's name for it
  Quantity mass;           ///< [kg]
  Quantity damping;        ///< [N s/m]
  Quantity friction;       ///< [N]
  Quantity encoder;        ///< [m]
  Quantity max_force;      ///< [N] peak
  Quantity width;          ///< [m] of the workspace along x, centered on the device's origin
  Quantity height;         ///< [m] along y
  Quantity depth;          ///< [m] along z
  /// Without an amplifier's lag: no source states one, so none is assumed.
  [[nodiscard]] PALPATE_EXPORT DeviceModel model() const;
};

/// A hand that can hold a simulated device.
struct HandPreset {
  std::string_view name;  ///< on the command line
  HandModel model;        ///< all of it is assumed
  std::string_view why;   ///< the hold that the numbers stand for, in words
};

/// All device presets, in the order of reports; static memory.
[[nodiscard]] PALPATE_EXPORT std::span<const DevicePreset> devicePresets() noexcept;
/// All hand presets, likewise.
[[nodiscard]] PALPATE_EXPORT std::span<const HandPreset> handPresets() noexcept;

/// @throws Error (kUsage, device.unknown) that lists the known names, if the name is unknown.
[[nodiscard]] PALPATE_EXPORT const DevicePreset& devicePreset(std::string_view name);
/// No value for "none": nobody holds the device. @throws Error (kUsage, hand.unknown) likewise.
[[nodiscard]] PALPATE_EXPORT std::optional<HandModel> handPreset(std::string_view name);

/// "", " (not verified)" or " (assumed)": to be written after the number.
[[nodiscard]] PALPATE_EXPORT std::string_view markOf(Known known) noexcept;

}  // namespace palpate::devices
