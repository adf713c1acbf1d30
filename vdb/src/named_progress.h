#pragma once
/// Progress of one of several tasks.

#include <string>
#include <utility>

#include "palpate/core/progress.h"

namespace palpate::vdb {

/// Forwards to `progress`, with each step named "what: step".
[[nodiscard]] inline Progress namedProgress(const Progress& progress, std::string what) {
  if (!progress) return {};
  return [progress, what = std::move(what)](std::string_view step, double fraction) {
    return progress(what + ": " + std::string(step), fraction);
  };
}

}  // namespace palpate::vdb
