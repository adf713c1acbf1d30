#pragma once
/// Force over depth of a touch, as SVG: what needle insertion is usually shown by.

#include <string>

#include "palpate/render/trace.h"

namespace palpate::tools {

/// The hand's force against its depth. The depth counts from the first wall met, along the straight
/// line from there to the furthest that the hand got; the force is what pushes the hand back along
/// it. Ports passed stand beside the curve. Where the hand leaves that line, a second plot below
/// has the force along the hand's own way and square to it, over the length of that way. Empty rows
/// or a hand that never met a surface give axes alone.
[[nodiscard]] std::string forcePlot(const Trace& trace, const Scene& scene,
                                    const std::string& title);

}  // namespace palpate::tools
