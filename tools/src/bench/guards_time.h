#pragma once
/// What the guards of stability cost.

namespace palpate::tools {

/// [ns] A tick of a virtual coupling and a passivity controller with its bound, pressed on a wall:
/// the shortest of some runs, over all ticks.
[[nodiscard]] double guardsTime();

}  // namespace palpate::tools
