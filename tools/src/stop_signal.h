#pragma once
/// Ctrl-C and a polite kill, turned into a flag.

#include <atomic>

namespace palpate::tools {

/// From now on SIGINT and SIGTERM set stopRequested(); a second one ends the process at once.
/// Writing to a pipe that nobody reads, or beyond the size that a file may have, fails, instead of
/// ending the process.
void catchStopSignals();

[[nodiscard]] const std::atomic<bool>& stopRequested() noexcept;

}  // namespace palpate::tools
