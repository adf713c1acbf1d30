#pragma once
/// Devices whose makers publish no protocol but a library, which is loaded when the device is
/// opened: no part of it is linked or shipped. Protocol from public sources, unverified on
/// hardware.

#include <memory>
#include <string>

#include "palpate/devices/device.h"
#include "palpate/export.h"

namespace palpate::devices {

/// The library to load for makeOpenHaptics() or makeForceDimension().
struct PluginSettings {
  std::string library;  ///< a path, or a name for dlopen(); empty: the maker's usual one
};

/// 3D Systems' Touch and Phantom devices, by OpenHaptics' HD library (libHD.so). Frame: x to the
/// right, y up, z towards the hand. The library's own thread reads the device and writes the force,
/// 1000 times a second; after 20 of its turns without a new force it writes zero.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<Device> makeOpenHaptics(
    const PluginSettings& settings);

/// Force Dimension's devices, by the DHD library (libdhd.so). Frame: x towards the hand, y to the
/// right, z up.
[[nodiscard]] PALPATE_EXPORT std::unique_ptr<Device> makeForceDimension(
    const PluginSettings& settings);

/// Whether the maker's library can be loaded; no device is opened.
[[nodiscard]] PALPATE_EXPORT bool hasOpenHaptics(const PluginSettings& settings);
/// The same for Force Dimension's library.
[[nodiscard]] PALPATE_EXPORT bool hasForceDimension(const PluginSettings& settings);

}  // namespace palpate::devices
