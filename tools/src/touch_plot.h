#pragma once
/// Force over depth of a touch, as SVG: the usual plot for needle insertion.

#include <string>

#include "palpate/render/trace.h"

namespace palpate::tools {

/// The hand's force against its depth. The depth is measured from the first wall met, along the
/// straight line from there to the farthest point that the hand reached; the force is its component
/// that pushes the hand back along that line. Passed ports are marked beside the curve. If the hand
/// leaves that line, a second plot below shows the force along the hand's own path and
/// perpendicular to it, over the length of the path. Without rows, or if the hand never met a
/// surface, only axes are drawn.
[[nodiscard]] std::string forcePlot(const Trace& trace, const Scene& scene,
                                    const std::string& title);

}  // namespace palpate::tools
