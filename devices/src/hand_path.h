#pragma once
// The place where a hand wants to be at any time: from rows, from a formula, or as given while it
// runs.

#include <algorithm>
#include <cstddef>
#include <optional>
#include <utility>

#include "palpate/devices/path.h"
#include "palpate/devices/simulated_device.h"

namespace palpate::devices {

/// Interpolates linearly between rows. Real-time safe, as long as the times asked for do not
/// decrease.
class HandPath {
 public:
  explicit HandPath(Path rows) : rows_(std::move(rows)) {}
  explicit HandPath(PathFormula formula) : formula_(std::move(formula)) {}
  explicit HandPath(LiveHand hand) : live_(std::move(hand)) {}

  [[nodiscard]] std::size_t size() const noexcept {
    if (live_) return 1;
    return formula_ ? formula_->size() : rows_.size();
  }
  [[nodiscard]] PathPoint row(std::size_t i) const {
    if (live_) return {0.0, live_->position(0.0)};
    return formula_ ? formula_->at(i) : rows_[i];
  }
  [[nodiscard]] double begin() const { return live_ ? 0.0 : row(0).t; }
  [[nodiscard]] double end() const { return live_ ? live_->end : row(size() - 1).t; }

  /// After this, at() may be called with any time again.
  void rewind() {
    next_ = 0;
    from_ = to_ = row(0);
  }
  /// [m]
  [[nodiscard]] Vec3 at(double t) {
    if (live_) {
      if (t > to_.t) to_ = {t, live_->position(t)};
      return to_.position;
    }
    while (to_.t < t && next_ + 1 < size()) {
      from_ = to_;
      to_ = row(++next_);
    }
    const double span = to_.t - from_.t;
    if (!(span > 0.0) || t >= to_.t) return to_.position;
    const double share = std::max(0.0, (t - from_.t) / span);
    return from_.position + share * (to_.position - from_.position);
  }

 private:
  Path rows_;
  std::optional<PathFormula> formula_;  ///< no value: rows_ are used
  std::optional<LiveHand> live_;        ///< no value: the path is known beforehand
  std::size_t next_ = 0;                ///< index of the row that is to_
  PathPoint from_;
  PathPoint to_;
};

}  // namespace palpate::devices
