#include "report_page/tick_columns.h"

#include <cmath>

namespace palpate::tools {

void TickColumns::add(const devices::RecordedTick& recorded, std::span<const RegionEntry>) {
  const double t = recorded.tick.reading.time;
  const Vec3& hip = recorded.tick.hip.position;
  const TickResult& result = recorded.tick.result;
  if (!std::isfinite(t) || !isFinite(hip)) return;
  if (has_last_) work_ += glm::dot(last_force_, hip - last_hip_);
  has_last_ = true;
  last_hip_ = hip;
  last_force_ = result.force;

  if (columns_.empty() || count_ == length_) {
    if (columns_.size() == kMost) {
      for (std::size_t i = 0; i < kMost; i += 2) {
        TickColumn both = columns_[i];
        both.end = columns_[i + 1].end;
        both.force.add(columns_[i + 1].force);
        both.beyond.add(columns_[i + 1].beyond);
        both.work.add(columns_[i + 1].work);
        columns_[i / 2] = both;
      }
      columns_.resize(kMost / 2);
      length_ *= 2;
    }
    columns_.emplace_back().begin = t;
    count_ = 0;
  }
  TickColumn& column = columns_.back();
  ++count_;
  column.end = t;
  column.force.add(glm::length(result.force));
  column.beyond.add(glm::distance(hip, result.proxy));
  column.work.add(work_);
}

}  // namespace palpate::tools
