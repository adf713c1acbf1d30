#pragma once
/// The USB devices that are plugged in.

#include <cstdint>
#include <string>
#include <vector>

#include "palpate/export.h"

namespace palpate::devices {

/// One device on the bus.
struct UsbDevice {
  std::uint16_t vendor = 0;    ///< idVendor
  std::uint16_t product = 0;   ///< idProduct
  int bus = 0;                 ///< number of the bus, as lsusb shows it
  int address = 0;             ///< on that bus; changes when it is plugged in again
  std::string serial;          ///< empty: it has none, or there is no access
  bool is_accessible = false;  ///< this user may open it
};

/// All USB devices; empty if the build has no libusb. @throws Error (kDevice) if libusb does not
/// start.
[[nodiscard]] PALPATE_EXPORT std::vector<UsbDevice> listUsbDevices();

/// Whether the build has libusb, without which listUsbDevices() finds nothing.
[[nodiscard]] PALPATE_EXPORT bool hasLibusb() noexcept;

}  // namespace palpate::devices
