#include "palpate/devices/device.h"

namespace palpate::devices {

DeviceStatus Device::writeWrench(const Vec3& force, const Vec3& /*torque*/) noexcept {
  return write(force);
}

void Device::cut() noexcept {}

}  // namespace palpate::devices
