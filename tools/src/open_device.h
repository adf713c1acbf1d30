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

/// What --device, --hand and --delay of a simulated device mean, at `rate` [Hz]; none without
/// --device.
/// @throws Error (kUsage) for a name that there is not, or --hand or --delay without a device.
[[nodiscard]] std::optional<devices::SimulationSettings> simulationOf(const DeviceOptions& options,
                                                                      double rate);

/// The loop that it makes, for the stability budget; the session's velocities are backward
/// differences.
[[nodiscard]] devices::LoopModel loopOf(const devices::SimulationSettings& simulation);

/// @throws Error (kUsage) as simulationOf(), and for a motion that no device can follow.
void checkDevice(const TouchOptions& options);

/// The device that a touch was asked for: a simulated one in a hand that is told to go along
/// `motion`, by `mapping` in the device's own space; or a hand that goes there whatever it feels.
/// Warns of a motion that leaves the device's workspace.
[[nodiscard]] std::unique_ptr<devices::Device> makeDevice(const TouchOptions& options,
                                                          Motion motion,
                                                          const DeviceMapping& mapping,
                                                          Console& console);

/// The numbers of the device and the hand, each with what is known of it; null or empty without a
/// device.
[[nodiscard]] Json deviceJson(const DeviceOptions& options, double rate);
[[nodiscard]] std::string deviceText(const DeviceOptions& options);

}  // namespace palpate::tools
