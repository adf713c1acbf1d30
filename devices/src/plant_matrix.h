#pragma once
// The linear part of a device with a hand, along one axis, as z' = M z.

#include <Eigen/Dense>
#include <optional>

#include "palpate/devices/device_model.h"

namespace palpate::devices::plant {

/// The entries of z, by index. Entries that do not apply (no grip, no lag) have rows of zeros.
enum : int {
  kX,         ///< [m] position of the device
  kV,         ///< [m/s]
  kHandX,     ///< [m] position of the hand, if it has a grip
  kHandV,     ///< [m/s]
  kForce,     ///< [N] of the motor
  kPath,      ///< [m] where the hand wants to be
  kPathRate,  ///< [m/s] constant
  kConstant,  ///< [N] constant force on the device: the push minus the friction that acts
  kCommand,   ///< [N] constant command to the amplifier; without a lag kForce equals it
  kSize
};

using Matrix = Eigen::Matrix<double, kSize, kSize>;

/// [kg] the mass that moves with the device: its own, and that of a hand that is rigidly connected.
[[nodiscard]] inline double movingMass(const DeviceModel& device,
                                       const std::optional<HandModel>& hand) {
  return device.mass + (hand && !hand->hasGrip() ? hand->mass : 0.0);
}

/// M while the device moves; if `sticks`, M while friction holds it.
[[nodiscard]] inline Matrix matrixOf(const DeviceModel& device,
                                     const std::optional<HandModel>& hand, bool sticks = false) {
  Matrix m = Matrix::Zero();
  m(kX, kV) = 1.0;
  m(kV, kV) = -device.damping;
  m(kV, kForce) = 1.0;
  m(kV, kConstant) = 1.0;
  if (hand && hand->hasGrip()) {
    const double k = hand->grip_stiffness;
    const double b = hand->grip_damping;
    m(kV, kX) = -k;
    m(kV, kHandX) = k;
    m(kV, kV) -= b;
    m(kV, kHandV) = b;
    m(kHandX, kHandV) = 1.0;
    m(kHandV, kX) = k;
    m(kHandV, kV) = b;
    m(kHandV, kHandX) = -k - hand->stiffness;
    m(kHandV, kHandV) = -b - hand->damping;
    m(kHandV, kPath) = hand->stiffness;
    m(kHandV, kPathRate) = hand->damping;
    m.row(kHandV) /= hand->mass;
  } else if (hand) {
    m(kV, kX) = -hand->stiffness;
    m(kV, kV) -= hand->damping;
    m(kV, kPath) = hand->stiffness;
    m(kV, kPathRate) = hand->damping;
  }
  m.row(kV) /= movingMass(device, hand);
  if (device.lag > 0.0) {
    m(kForce, kForce) = -1.0 / device.lag;
    m(kForce, kCommand) = 1.0 / device.lag;
  }
  m(kPath, kPathRate) = 1.0;
  if (sticks) {
    m.row(kX).setZero();
    m.row(kV).setZero();
  }
  return m;
}

}  // namespace palpate::devices::plant
