#pragma once
/// Ticks that end before the proxy is at rest.

#include <algorithm>
#include <cstddef>

namespace palpate::tools {

/// Counts the ticks whose TickResult::settled is false, and the longest run of them.
class UnsettledMeter {
 public:
  void add(bool is_settled) noexcept {
    ++ticks_;
    run_ = is_settled ? 0 : run_ + 1;
    count_ += is_settled ? 0 : 1;
    longest_ = std::max(longest_, run_);
  }

  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::size_t longest() const noexcept { return longest_; }  ///< [ticks] in a row
  /// Share of all ticks; 0 if there are none.
  [[nodiscard]] double share() const noexcept {
    return ticks_ > 0 ? static_cast<double>(count_) / static_cast<double>(ticks_) : 0.0;
  }

 private:
  std::size_t ticks_ = 0;
  std::size_t count_ = 0;
  std::size_t run_ = 0;
  std::size_t longest_ = 0;
};

}  // namespace palpate::tools
