#pragma once
/// One flag that stops long work, also where no Progress is at hand: reading files, for one.

#include <atomic>

#include "palpate/export.h"

namespace palpate {

/// From now on pollStop() of any thread looks at `flag`, which must outlive the work; null: at
/// none. One flag for the process, which a signal handler may set. Not to be called while work runs
/// on other threads.
PALPATE_EXPORT void watchStopFlag(const std::atomic<bool>* flag) noexcept;

/// True once the watched flag is set. A relaxed load: cheap enough for every thousand voxels or
/// bytes.
[[nodiscard]] PALPATE_EXPORT bool isStopRequested() noexcept;

/// @throws Error (kCancelled) once the watched flag is set.
PALPATE_EXPORT void pollStop();

}  // namespace palpate
