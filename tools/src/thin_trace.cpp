#include "thin_trace.h"

#include <algorithm>
#include <functional>
#include <iterator>
#include <utility>

#include "trace_parts.h"

namespace palpate::tools {

void ThinTrace::add(const devices::RecordedTick& tick, std::span<const RegionEntry> entries) {
  if (stretches_.empty() || count_ == length_) {
    if (!stretches_.empty()) thin(stretches_.back());
    if (stretches_.size() == kMostStretches) halve();
    stretches_.emplace_back();
    count_ = 0;
  }
  Row row{.row = traceRow(tick), .entries = {}};
  if (!entries.empty()) row.entries.push_back(entries.front());
  stretches_.back().push_back(std::move(row));
  ++count_;
  // Bounded, so that a long interval needs no more memory than a short one.
  constexpr std::size_t kMostOpen = 64;
  if (stretches_.back().size() == kMostOpen) thin(stretches_.back());
}

void ThinTrace::halve() {
  for (std::size_t i = 0; i < kMostStretches / 2; ++i) {
    Stretch joined = std::move(stretches_[2 * i]);
    std::move(stretches_[2 * i + 1].begin(), stretches_[2 * i + 1].end(),
              std::back_inserter(joined));
    thin(joined);
    stretches_[i] = std::move(joined);
  }
  stretches_.resize(kMostStretches / 2);
  length_ *= 2;
}

void ThinTrace::thin(Stretch& stretch) {
  if (stretch.size() <= kKept) return;
  std::vector<bool> is_kept(stretch.size(), false);
  is_kept.front() = is_kept.back() = true;
  const auto keep_extremes = [&](const std::function<double(const TraceRow&)>& value) {
    std::size_t least = 0;
    std::size_t most = 0;
    for (std::size_t i = 1; i < stretch.size(); ++i) {
      const double now = value(stretch[i].row);
      if (now < value(stretch[least].row)) least = i;
      if (now > value(stretch[most].row)) most = i;
    }
    is_kept[least] = is_kept[most] = true;
  };
  keep_extremes([](const TraceRow& row) { return glm::length(row.result.force); });
  for (int axis = 0; axis < 3; ++axis) {
    keep_extremes([axis](const TraceRow& row) { return row.hip[axis]; });
  }
  int entered = 0;
  constexpr int kMostEntered = 4;
  Stretch out;
  for (std::size_t i = 0; i < stretch.size(); ++i) {
    const bool enters = !stretch[i].entries.empty() || stretch[i].row.result.event_count > 0;
    const bool is_new = enters && entered < kMostEntered;
    entered += enters ? 1 : 0;
    if (is_kept[i] || is_new) out.push_back(std::move(stretch[i]));
  }
  stretch = std::move(out);
}

Trace ThinTrace::trace() const {
  std::size_t rows = 0;
  for (const Stretch& stretch : stretches_) rows += stretch.size();
  Trace trace(rows);
  for (const Stretch& stretch : stretches_) {
    for (const Row& row : stretch) trace.add(row.row, row.entries);
  }
  return trace;
}

}  // namespace palpate::tools
