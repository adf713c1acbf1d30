#pragma once
/// The one place where a device is chosen by its name.

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

/// The model that --device, --hand and --delay mean, at `rate` [Hz]: of falcon as of
/// virtual:falcon; none without --device.
/// @throws Error (kUsage) for an unknown name, or one without a model; --hand or --delay without a
/// device.
[[nodiscard]] std::optional<devices::SimulationSettings> simulationOf(const DeviceOptions& options,
                                                                      double rate);

/// The loop that it makes, for the stability budget; the session's velocities are backward
/// differences.
[[nodiscard]] devices::LoopModel loopOf(const devices::SimulationSettings& simulation);

/// The loop of a touch, as far as a model of its device is known. @throws Error as simulationOf().
[[nodiscard]] std::optional<devices::LoopModel> touchLoop(const TouchOptions& options);

/// @throws Error (kUsage) as simulationOf(), and for a motion or options that the device has
/// nothing to do with.
void checkDevice(const TouchOptions& options);

/// The device of a touch that has a motion: a simulated one in a hand that means to go along
/// `motion`, by `mapping` in the device's own space; or a hand that goes there whatever it feels.
/// Warns of a motion that leaves the device's workspace.
[[nodiscard]] std::unique_ptr<devices::Device> makeDevice(const TouchOptions& options,
                                                          Motion motion,
                                                          const DeviceMapping& mapping,
                                                          Console& console);

/// Where the device is [m, device] when the probe is at `world` [m].
[[nodiscard]] Vec3 toDevice(const DeviceMapping& mapping, const Vec3& world);

/// The numbers of the device and the hand, each with what is known of it; null or empty without a
/// device.
[[nodiscard]] Json deviceJson(const DeviceOptions& options, double rate);
[[nodiscard]] std::string deviceText(const DeviceOptions& options);

}  // namespace palpate::tools
