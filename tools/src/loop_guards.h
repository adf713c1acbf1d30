#pragma once
/// Passivity and a virtual coupling, as the options of a touch and its scene ask for them.

#include <optional>
#include <string>

#include "options.h"
#include "palpate/devices/hand_guards.h"
#include "palpate/devices/session.h"
#include "report.h"

namespace palpate::tools {

/// What --passivity, --hand-force and --coupling say, and else `mapping`, the scene's `device`;
/// without --device the numbers have to be in the scene, or in --coupling. @throws Error (kUsage).
[[nodiscard]] devices::HandGuards guardsOf(const TouchOptions& options, DeviceMapping mapping,
                                           const std::optional<devices::LoopModel>& loop);

/// After a run: what was given, and what it costs; null or empty where nothing was asked for.
[[nodiscard]] Json guardsJson(const devices::HandGuards& guards, const devices::Session& session);
[[nodiscard]] std::string guardsText(const devices::HandGuards& guards,
                                     const devices::Session& session);

}  // namespace palpate::tools
