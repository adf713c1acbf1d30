#pragma once
// Measures the work that a rendered world does on the hand.

#include <algorithm>
#include <span>

#include "palpate/render/trace.h"

namespace palpate::testing {

/// Adds up F . v dt over ticks: force k, written at tick k, is held until tick k + 1 (as a real
/// device's output stage holds it), so its work on the hand is F_k . (x_{k+1} - x_k). A passive
/// world that began at rest never gives back more than it was given: gained() does not exceed the
/// energy that sampling itself creates.
class EnergyMeter {
 public:
  /// Next tick: the hand is at `position` [m], and `force` [N] is put on it until the tick after.
  void add(const Vec3& position, const Vec3& force) noexcept {
    if (has_last_) work_ += glm::dot(force_, position - position_);
    position_ = position;
    force_ = force;
    has_last_ = true;
    gained_ = std::max(gained_, work_);
    lowest_ = std::min(lowest_, work_);
    rebound_ = std::max(rebound_, work_ - lowest_);
  }

  /// The work over a whole trace. The last row's force does no work, because no motion follows it.
  [[nodiscard]] static EnergyMeter of(std::span<const TraceRow> rows) noexcept {
    EnergyMeter meter;
    for (const TraceRow& row : rows) meter.add(row.hip, row.result.force);
    return meter;
  }

  [[nodiscard]] double work() const noexcept { return work_; }      ///< [J] on the hand, so far
  [[nodiscard]] double gained() const noexcept { return gained_; }  ///< [J] highest work() so far
  /// [J] most energy given back after it was taken: for lossless walls equal to the stored energy.
  [[nodiscard]] double rebound() const noexcept { return rebound_; }

 private:
  Vec3 position_{0.0, 0.0, 0.0};
  Vec3 force_{0.0, 0.0, 0.0};
  bool has_last_ = false;
  double work_ = 0.0;
  double gained_ = 0.0;
  double lowest_ = 0.0;
  double rebound_ = 0.0;
};

}  // namespace palpate::testing
