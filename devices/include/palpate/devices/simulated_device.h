#pragma once
/// SimulatedDevice: a device with a mass, friction, encoders and motors, held by a hand that yields
/// to the force.

#include <functional>
#include <memory>
#include <optional>

#include "palpate/devices/device.h"
#include "palpate/devices/device_model.h"
#include "palpate/devices/path.h"
#include "palpate/export.h"

namespace palpate::devices {

/// The settings of a simulated device.
struct SimulationSettings {
  DeviceModel device;                  ///< masses, friction and limits of the device
  std::optional<HandModel> hand = {};  ///< none: nobody holds the device
  double rate = 1000.0;                ///< [Hz] of readings; 1 to 1e5
  /// [samples] from writing a force until the motors exert it; 0 to SimulatedDevice::kMostDelay.
  /// With 0 they exert it from the reading on that it answers.
  int delay = 0;
  bool realtime = false;     ///< read() takes a reading now, not 1 / rate after the last one
  Vec3 push{0.0, 0.0, 0.0};  ///< [N] constant force on the tip: a weight, or a preload of a contact
};

/// A hand whose path is not known beforehand.
struct LiveHand {
  /// [m] Where the hand wants to be at a time [s] since open(). Called once for each reading, in
  /// the servo thread and at increasing times, after a first call at 0: it must not allocate, lock,
  /// throw or block, and its result must be finite.
  std::function<Vec3(double)> position;
  double end = kInfinity;  ///< [s] when the hand lets go, and the device answers kEnd
};

/// Energy balance since open(), summed over the axes [J].
struct DeviceWork {
  double motor = 0.0;     ///< done by the motors
  double push = 0.0;      ///< done by the constant push
  double friction = 0.0;  ///< lost to Coulomb friction
  double viscous = 0.0;   ///< lost to the device's own damping
  double kinetic = 0.0;   ///< present kinetic energy of the device's own mass

  /// Energy that the device gave to the hand.
  [[nodiscard]] double given() const noexcept {
    return motor + push - friction - viscous - kinetic;
  }
};

/// Each reading is one tick: sampling and encoder; then, when the force is written, delay,
/// saturation (the vector is shortened, its direction kept) and hold until the next reading. In
/// between, device, hand and amplifier move by their equations, exactly: the linear part by the
/// matrix exponential, stick and slip by events within the tick. Between two readings the hand's
/// path is a straight line at constant speed. Coulomb friction and encoder act along each axis
/// separately.
///
/// The device starts at rest where the path begins, and so does the hand. Without a hand the path
/// only determines where that is, and how long it lasts. If a write() is left out, the force stays
/// as it is: a dropped sample. Set-up allocates and takes some 10 ms; read() and write() never
/// allocate, lock, throw or block.
class PALPATE_EXPORT SimulatedDevice final : public Device {
 public:
  /// [samples] The largest SimulationSettings::delay.
  static constexpr int kMostDelay = 64;

  /// `path`, `hand`: where the hand wants to go, in `frame`, at increasing times.
  /// @throws Error (kUsage, device.model, device.rate, device.delay, device.push) for settings out
  /// of range; (kInput, path.empty, path.time, path.not_finite) for the path.
  SimulatedDevice(const SimulationSettings& settings, Path path,
                  DeviceFrame frame = DeviceFrame::kDevice);
  /// The same for a path that is computed row by row.
  SimulatedDevice(const SimulationSettings& settings, PathFormula path,
                  DeviceFrame frame = DeviceFrame::kDevice);
  /// The same for a hand that decides where to go while it runs.
  SimulatedDevice(const SimulationSettings& settings, LiveHand hand,
                  DeviceFrame frame = DeviceFrame::kDevice);
  ~SimulatedDevice() override;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override;

  // The true position at the last reading, before the encoder.
  [[nodiscard]] Vec3 position() const noexcept;      ///< [m]
  [[nodiscard]] Vec3 velocity() const noexcept;      ///< [m/s]
  [[nodiscard]] Vec3 handPosition() const noexcept;  ///< [m] the device's own if there is no grip
  /// Energy balance up to the last reading.
  [[nodiscard]] DeviceWork work() const noexcept;
  /// [N] The motors' command since the last write(), after delay and saturation.
  [[nodiscard]] const Vec3& heldForce() const noexcept;

 private:
  class Plant;
  std::unique_ptr<Plant> plant_;
};

}  // namespace palpate::devices
