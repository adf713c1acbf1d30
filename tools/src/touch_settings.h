#pragma once
/// How `touch` was asked to render, out of its options.

#include <string>

#include "options.h"
#include "palpate/render/haptic_renderer.h"
#include "report.h"
#include "text.h"

namespace palpate::tools {

/// --renderer, the paper's parameters and the limits of the force, but for their period. @throws
/// Error (kUsage).
[[nodiscard]] RendererSettings rendererSettings(const TouchOptions& o, const LengthUnit& unit);

/// True if one of them was given.
[[nodiscard]] bool givesPaperParameters(const TouchOptions& o);

/// "paper" or "constraint".
[[nodiscard]] std::string rendererName(RendererKind kind);

/// @throws Error (kUsage).
[[nodiscard]] ForceLimits forceLimits(const TouchOptions& o);
[[nodiscard]] Json limitsJson(const ForceLimits& limits);
[[nodiscard]] std::string limitsText(const ForceLimits& limits);  ///< empty if there is none

}  // namespace palpate::tools
