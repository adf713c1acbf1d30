#include "palpate/devices/device_access.h"

#include <array>
#include <cstdio>

namespace palpate::devices {

std::string udevRule(std::uint16_t vendor, std::uint16_t product) {
  std::array<char, 192> text{};
  (void)std::snprintf(text.data(), text.size(),
                      "SUBSYSTEM==\"usb\", ATTR{idVendor}==\"%04x\", ATTR{idProduct}==\"%04x\", "
                      "MODE=\"0660\", GROUP=\"plugdev\", TAG+=\"uaccess\"",
                      vendor, product);
  return text.data();
}

}  // namespace palpate::devices
