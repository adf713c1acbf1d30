#include "picture/track.h"

#include <cmath>

#include "palpate/core/error.h"
#include "palpate/render/haptic_renderer.h"
#include "trace_reader.h"

namespace palpate::tools {
Box3 Track::bounds() const {
  Box3 box;
  for (const Point& p : points) {
    box.include(p.hip);
    box.include(p.proxy);
  }
  return box;
}

Track trackOf(std::span<const TraceRow> rows) {
  Track track;
  track.points.reserve(rows.size());
  for (const TraceRow& row : rows) {
    if (!isFinite(row.hip)) continue;  // a broken sensor's reading, which has no place
    track.points.push_back({row.hip, row.result.proxy, row.result.force});
  }
  return track;
}

Track readTrack(const std::string& file) {
  TraceReader reader(file);
  Track track;
  TraceLine row;
  // A broken sensor's reading has no place, or one beyond any scale.
  const auto isDrawn = [](const TraceLine& line) {
    return line.is_finite && HapticRenderer::isInReach(line.hip) &&
           HapticRenderer::isInReach(line.proxy) && std::isfinite(glm::length(line.force));
  };
  while (reader.next(row)) {
    if (isDrawn(row)) track.points.push_back({row.hip, row.proxy, row.force});
  }
  if (track.points.empty()) throw inputError("trace.empty", "the trace has no rows", "", file);
  return track;
}

}  // namespace palpate::tools
