#pragma once
/// For timing cold queries: sends other data through the caches.

#include <cstddef>
#include <vector>

namespace palpate::tools {

/// A buffer larger than the caches, which pushes everything else out of them.
class CacheFlood {
 public:
  CacheFlood();
  void run() noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return buffer_.size(); }

 private:
  std::vector<unsigned char> buffer_;
};

}  // namespace palpate::tools
