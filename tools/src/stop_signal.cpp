#include "stop_signal.h"

#include <csignal>

namespace palpate::tools {
namespace {

std::atomic<bool> stop_requested = false;
static_assert(std::atomic<bool>::is_always_lock_free, "set from a signal handler");

extern "C" void onStopSignal(int /*signal*/) { stop_requested.store(true); }

}  // namespace

void catchStopSignals() {
  struct sigaction action = {};
  action.sa_handler = onStopSignal;
  // A second signal ends the process at once.
  action.sa_flags = static_cast<int>(SA_RESETHAND);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // If a pipe's reader closes its end, writing then fails instead of ending the process. The error
  // is reported like others, and no files are left behind.
  struct sigaction ignore = {};
  ignore.sa_handler = SIG_IGN;
  sigaction(SIGPIPE, &ignore, nullptr);
  sigaction(SIGXFSZ, &ignore, nullptr);  // the same for a file that may not grow further
}

const std::atomic<bool>& stopRequested() noexcept { return stop_requested; }

}  // namespace palpate::tools
