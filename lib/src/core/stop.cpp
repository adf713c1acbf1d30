#include "palpate/core/stop.h"

#include "palpate/core/error.h"

namespace palpate {
namespace {

std::atomic<const std::atomic<bool>*> watched = nullptr;

}  // namespace

void watchStopFlag(const std::atomic<bool>* flag) noexcept { watched.store(flag); }

bool isStopRequested() noexcept {
  const std::atomic<bool>* const flag = watched.load(std::memory_order_relaxed);
  return flag != nullptr && flag->load(std::memory_order_relaxed);
}

void pollStop() {
  if (isStopRequested()) {
    throw Error(ErrorKind::kCancelled, {"cancelled", "stopped at your request"});
  }
}

}  // namespace palpate
