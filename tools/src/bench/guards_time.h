#pragma once
/// Measures the cost of the guards of stability.

namespace palpate::tools {

/// [ns] Time for a tick of a virtual coupling and a passivity controller with its bound, pressed on
/// a wall: the shortest of some runs, averaged over all ticks.
[[nodiscard]] double guardsTime();

}  // namespace palpate::tools
