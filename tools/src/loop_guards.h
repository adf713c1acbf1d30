#pragma once
/// The passivity controller and the virtual coupling that a touch's options and its scene ask for.

#include <optional>
#include <string>

#include "options.h"
#include "palpate/devices/hand_guards.h"
#include "palpate/devices/session.h"
#include "report.h"

namespace palpate::tools {

/// The guards of --passivity, --hand-force and --coupling, or else of `mapping`, the scene's
/// `device`. Without --device, their numbers have to be in the scene or in --coupling. @throws
/// Error (kUsage).
[[nodiscard]] devices::HandGuards guardsOf(const TouchOptions& options, DeviceMapping mapping,
                                           const std::optional<devices::LoopModel>& loop);

/// After a run: the settings, and what was measured; null or empty if no guard was asked for.
[[nodiscard]] Json guardsJson(const devices::HandGuards& guards, const devices::Session& session);
[[nodiscard]] std::string guardsText(const devices::HandGuards& guards,
                                     const devices::Session& session);

}  // namespace palpate::tools
