#include "palpate/devices/device_model.h"

#include <cmath>
#include <string>

#include "palpate/core/error.h"

namespace palpate::devices {
namespace {

void require(bool good, const std::string& what, double value) {
  if (good) return;
  throw Error(ErrorKind::kUsage, {"device.model", what + ", not " + std::to_string(value)});
}

void requireNotNegative(double value, const std::string& what) {
  require(std::isfinite(value) && value >= 0.0, what + " must be finite and 0 or more", value);
}

}  // namespace

void check(const DeviceModel& device) {
  require(std::isfinite(device.mass) && device.mass > 0.0,
          "the mass of a device must be finite and above 0 kg", device.mass);
  requireNotNegative(device.damping, "the damping of a device");
  requireNotNegative(device.friction, "the friction of a device");
  requireNotNegative(device.encoder, "the encoder step of a device");
  requireNotNegative(device.lag, "the lag of a device's amplifier");
  require(device.max_force > 0.0, "the greatest force of a device must be above 0 N",
          device.max_force);
}

void check(const HandModel& hand) {
  requireNotNegative(hand.mass, "the mass of a hand");
  requireNotNegative(hand.damping, "the damping of a hand");
  requireNotNegative(hand.stiffness, "the stiffness of a hand");
  requireNotNegative(hand.grip_stiffness, "the stiffness of a grip");
  requireNotNegative(hand.grip_damping, "the damping of a grip");
  require(!hand.hasGrip() || hand.mass > 0.0,
          "the mass of a hand that holds a device by a grip must be above 0 kg", hand.mass);
}

}  // namespace palpate::devices
