#pragma once
/// The USB devices that are plugged in.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/export.h"

namespace palpate::devices {

struct UsbDevice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  int bus = 0;
  int address = 0;
  std::string serial;          ///< empty: it has none, or there is no access
  bool is_accessible = false;  ///< this user may open it
};

/// All USB devices; empty if the build has no libusb. @throws Error (kDevice) if libusb does not
/// start.
[[nodiscard]] PALPATE_EXPORT std::vector<UsbDevice> listUsbDevices();

[[nodiscard]] PALPATE_EXPORT bool hasLibusb() noexcept;

}  // namespace palpate::devices
