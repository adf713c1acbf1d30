#pragma once
/// A state taken over into a scene that was edited: regions and ports are known again by their names.

#include <string>
#include <vector>

#include "palpate/render/renderer_state.h"
#include "palpate/scene/scene.h"

namespace palpate {

struct CarriedState {
  RendererState state;  ///< of the other scene: for HapticRenderer::setState()
  /// The probe is where it was. False: it starts anew, in the start region, with no port passed and with the ramp of its limits.
  bool goes_on = false;
  /// What the other scene does not have, in words: the probe's region, or its place in that; ports that were passed, and
  /// those whose walls have holes.
  std::vector<std::string> lost;
};

/// What `state`, of a renderer of `kind` of the scene `from`, comes to in the scene `to`. The proxy goes on if its region is
/// there by name and holds its place still (the paper's renderer asks for the region only: its state is not where the HIP is).
/// With it goes what was passed, how often and which way; the holes made; what friction holds; how far the wall that is
/// pressed has relaxed; and the work of sources. What a needle has cut and what holds it begin anew, and what is felt may
/// jump: limits of the force see to that. For set-up, between two ticks: it allocates.
[[nodiscard]] CarriedState carryState(const RendererState& state, RendererKind kind,
                                      const Scene& from, const Scene& to);

}  // namespace palpate
