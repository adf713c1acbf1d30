#pragma once
/// Times of what is met cold: other data went through the caches before.

#include <cstddef>
#include <vector>

namespace palpate::tools {

/// A buffer larger than the caches, to push everything else out of them.
class CacheFlood {
 public:
  CacheFlood();
  void run() noexcept;
  [[nodiscard]] std::size_t bytes() const noexcept { return buffer_.size(); }

 private:
  std::vector<unsigned char> buffer_;
};

}  // namespace palpate::tools
