#pragma once
/// `touch --trace`: the ticks as CSV, written as they arrive.

#include <string>

#include "palpate/devices/record.h"
#include "palpate/render/trace.h"

namespace palpate::tools {

/// Writes whole rows only, some hundreds at a time or at flush(): memory does not grow with the
/// trace.
class TraceFile final : public devices::RecordSink {
 public:
  /// `file` is emptied; `name` is used in messages. @throws Error (kOperation, record.write).
  TraceFile(const std::string& file, std::string name, const Scene& scene);
  void add(const devices::RecordedTick& tick, std::span<const RegionEntry> entries) override;
  void flush() override;

 private:
  devices::OutFile out_;
  TraceText format_;
  std::string text_;  ///< text that was not written yet
};

}  // namespace palpate::tools
