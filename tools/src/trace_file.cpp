#include "trace_file.h"

#include <utility>

#include "trace_parts.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kAtOnce = std::size_t{1} << 16U;  // [bytes]

}  // namespace

TraceFile::TraceFile(const std::string& file, std::string name, const Scene& scene)
    : out_(file, std::move(name)), format_(scene), text_(TraceText::header()) {
  text_.reserve(2 * kAtOnce);
  flush();
}

void TraceFile::add(const devices::RecordedTick& tick, std::span<const RegionEntry>) {
  format_.add(text_, traceRow(tick));
  if (text_.size() >= kAtOnce) flush();
}

void TraceFile::flush() {
  if (text_.empty()) return;
  out_.append(text_.data(), text_.size(), text_.size());
  text_.clear();
}

}  // namespace palpate::tools
