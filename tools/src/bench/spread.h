#pragma once
/// Summary statistics of errors.

#include <algorithm>
#include <cmath>
#include <optional>

namespace palpate::tools {

/// Root of the mean square, and the largest magnitude.
struct Spread {
  double rms = 0.0;
  double most = 0.0;
};

class SpreadMeter {
 public:
  void add(double value) noexcept {
    squares_ += value * value;
    most_ = std::max(most_, std::fabs(value));
    count_ += 1.0;
  }
  /// Not given if nothing was added.
  [[nodiscard]] std::optional<Spread> found() const noexcept {
    return count_ > 0.0 ? std::optional<Spread>(spread()) : std::nullopt;
  }
  /// Zero if nothing was added.
  [[nodiscard]] Spread spread() const noexcept {
    return {count_ > 0.0 ? std::sqrt(squares_ / count_) : 0.0, most_};
  }

 private:
  double squares_ = 0.0;
  double most_ = 0.0;
  double count_ = 0.0;
};

}  // namespace palpate::tools
