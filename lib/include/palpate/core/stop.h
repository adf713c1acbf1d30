#pragma once
/// One flag that stops long work, also where no Progress is at hand, as in the reading of files.

#include <atomic>

#include "palpate/export.h"

namespace palpate {

/// From now on pollStop() on any thread reads `flag`, which must outlive the work; null switches
/// the check off. There is one flag for the whole process, and a signal handler may set it. Do not
/// call this while work runs on other threads.
PALPATE_EXPORT void watchStopFlag(const std::atomic<bool>* flag) noexcept;

/// True once the watched flag is set. A relaxed load, cheap enough to be called once every thousand
/// voxels or bytes.
[[nodiscard]] PALPATE_EXPORT bool isStopRequested() noexcept;

/// @throws Error (kCancelled) once the watched flag is set.
PALPATE_EXPORT void pollStop();

}  // namespace palpate
