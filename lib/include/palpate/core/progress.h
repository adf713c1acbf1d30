#pragma once
/// How long work reports its progress and is stopped.

#include <functional>
#include <string_view>

#include "palpate/core/error.h"

namespace palpate {

/// Called now and then, always on the thread that started the work, with what is being done and the
/// share done so far (0 to 1; negative: unknown). Return false to stop; the work then throws Error
/// of kind kCancelled and leaves nothing behind. An empty function means: no report, no stop.
using Progress = std::function<bool(std::string_view what, double fraction)>;

/// Reports progress; throws kCancelled if `progress` returns false.
inline void report(const Progress& progress, std::string_view what, double fraction) {
  if (progress && !progress(what, fraction)) {
    throw Error(ErrorKind::kCancelled, {"cancelled", "stopped at your request"});
  }
}

}  // namespace palpate
