#pragma once
/// Force over depth of a touch, as SVG: what needle insertion is usually shown by.

#include <span>
#include <string>

#include "palpate/render/trace.h"

namespace palpate::tools {

/// The hand's force against its depth. The depth counts from the first surface met, along the straight line
/// from there to the furthest that the hand got; the force is what pushes the hand back along it. Ports
/// passed and regions stand beside the curve. Empty rows or a hand that never met a surface give axes alone.
[[nodiscard]] std::string forcePlot(std::span<const TraceRow> rows, const Scene& scene,
                                    const std::string& title);

}  // namespace palpate::tools
