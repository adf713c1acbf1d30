#pragma once
/// Converts a recorded tick to a row of a trace.

#include "palpate/devices/record.h"
#include "palpate/render/trace.h"

namespace palpate::tools {

[[nodiscard]] inline TraceRow traceRow(const devices::RecordedTick& recorded) {
  return {.t = recorded.tick.reading.time,
          .hip = recorded.tick.hip.position,
          .result = recorded.tick.result,
          .tick_ns = recorded.tick.renderer_ns};
}

}  // namespace palpate::tools
