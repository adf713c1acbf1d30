#pragma once
/// The only code that chooses a device by its name.

#include <memory>
#include <optional>
#include <string>

#include "console.h"
#include "motion.h"
#include "options.h"
#include "palpate/devices/device.h"
#include "palpate/devices/simulated_device.h"
#include "palpate/devices/stability.h"
#include "palpate/scene/description.h"
#include "report.h"

namespace palpate::tools {

/// The model that --device, --hand and --delay describe, at `rate` [Hz]; falcon has the same one as
/// virtual:falcon. Nothing without --device.
/// @throws Error (kUsage) for an unknown name, or one without a model; for --hand or --delay
/// without a device.
[[nodiscard]] std::optional<devices::SimulationSettings> simulationOf(const DeviceOptions& options,
                                                                      double rate);

/// The loop that this simulation makes, for the stability budget; the session computes velocities
/// as backward differences.
[[nodiscard]] devices::LoopModel loopOf(const devices::SimulationSettings& simulation);

/// The loop of a touch, as far as a model of its device is known. @throws Error as simulationOf().
[[nodiscard]] std::optional<devices::LoopModel> touchLoop(const TouchOptions& options);

/// @throws Error (kUsage) as simulationOf(), and for a motion or options that do not apply to the
/// device.
void checkDevice(const TouchOptions& options);

/// The device of a touch that has a motion. With a simulated device, the hand tries to follow
/// `motion`, converted to the device's own space by `mapping`; without one, the hand goes there
/// whatever it feels. Warns of a motion that leaves the device's workspace.
[[nodiscard]] std::unique_ptr<devices::Device> makeDevice(const TouchOptions& options,
                                                          Motion motion,
                                                          const DeviceMapping& mapping,
                                                          Console& console);

/// [m, device] Position of the device when the probe is at `world` [m].
[[nodiscard]] Vec3 toDevice(const DeviceMapping& mapping, const Vec3& world);

/// The numbers of the device and the hand, each with its source; null or empty without a device.
[[nodiscard]] Json deviceJson(const DeviceOptions& options, double rate);
[[nodiscard]] std::string deviceText(const DeviceOptions& options);

}  // namespace palpate::tools
