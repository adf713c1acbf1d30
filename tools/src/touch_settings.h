#pragma once
/// Settings of the renderer from the options of `touch`.

#include <string>

#include "options.h"
#include "palpate/render/haptic_renderer.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// From --renderer, the paper's parameters and the limits of the force, except their period.
/// @throws Error (kUsage).
[[nodiscard]] RendererSettings rendererSettings(const TouchOptions& o, const LengthUnit& unit);

/// True if one of the paper's parameters was given.
[[nodiscard]] bool givesPaperParameters(const TouchOptions& o);

/// "paper" or "constraint".
[[nodiscard]] std::string rendererName(RendererKind kind);

/// @throws Error (kUsage).
[[nodiscard]] ForceLimits forceLimits(const TouchOptions& o);
[[nodiscard]] Json limitsJson(const ForceLimits& limits);
[[nodiscard]] std::string limitsText(const ForceLimits& limits);  ///< empty if there is none

}  // namespace palpate::tools
