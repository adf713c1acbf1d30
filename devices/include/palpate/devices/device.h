#pragma once
/// Device: where the hand is, and what it feels.

#include <cstdint>
#include <string>

#include "palpate/core/math.h"

namespace palpate::devices {

/// One reading.
struct DeviceState {
  double time = 0.0;             ///< [s] since the device was opened
  Vec3 position{0.0, 0.0, 0.0};  ///< [m] in the frame that DeviceInfo says
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s] the same
  std::uint32_t buttons = 0;     ///< a bit each, 1: pressed
};

enum class DeviceStatus : std::uint8_t {
  kOk,
  kEnd,    ///< a recorded or generated path is over; the loop ends
  kStale,  ///< nothing new since the last call; the previous reading was returned
  kTimeout,
  kDisconnected,  ///< will not recover without open()
  kFault,         ///< the device reported an error and has cut its motors
};

/// What the coordinates of a device mean.
enum class DeviceFrame : std::uint8_t {
  kDevice,  ///< its own: a scene's DeviceMapping leads to the world
  kWorld,   ///< the scene's, as most recorded paths are
};

struct DeviceInfo {
  std::string name;
  double max_force = 0.0;  ///< [N] continuous; the servo loop never writes a longer force
  Box3 workspace;          ///< [m] in the frame
  DeviceFrame frame = DeviceFrame::kDevice;  ///< of positions, velocities, forces and the workspace
};

/// open() and close() are called while no loop runs; read() and write() from the servo thread only.
/// A device at rest exerts no force: close() and the destructor zero it first.
class Device {
 public:
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual void open() = 0;            ///< @throws Error (kDevice)
  virtual void close() noexcept = 0;  ///< safe to call twice
  [[nodiscard]] virtual const DeviceInfo& info() const noexcept = 0;

  // Real time: no allocation, no lock, no exception, bounded wait.
  [[nodiscard]] virtual DeviceStatus read(DeviceState& out) noexcept = 0;
  [[nodiscard]] virtual DeviceStatus write(
      const Vec3& force) noexcept = 0;  ///< [N] in the same frame

 protected:
  Device() = default;
};

}  // namespace palpate::devices
