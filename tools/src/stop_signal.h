#pragma once
/// Turns Ctrl-C and SIGTERM into a flag.

#include <atomic>

namespace palpate::tools {

/// From now on SIGINT and SIGTERM set stopRequested(); a second one ends the process at once.
/// Writing to a pipe without a reader, or beyond the size limit of files, then fails instead of
/// ending the process.
void catchStopSignals();

[[nodiscard]] const std::atomic<bool>& stopRequested() noexcept;

}  // namespace palpate::tools
