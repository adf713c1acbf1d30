#include "cache_flood.h"

#include <unistd.h>

#include <algorithm>

namespace palpate::tools {
namespace {

constexpr std::size_t kLine = 64;              ///< [bytes] of a cache line
constexpr std::size_t kLeastFlood = 24 << 20;  ///< [bytes]

std::size_t floodBytes() {
  const long last_level = sysconf(_SC_LEVEL3_CACHE_SIZE);
  const std::size_t twice = last_level > 0 ? 2 * static_cast<std::size_t>(last_level) : 0;
  return std::max(kLeastFlood, twice);
}

}  // namespace

CacheFlood::CacheFlood() : buffer_(floodBytes()) {}

void CacheFlood::run() noexcept {
  for (std::size_t i = 0; i < buffer_.size(); i += kLine) ++buffer_[i];
}

}  // namespace palpate::tools
