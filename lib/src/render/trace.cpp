#include "palpate/render/trace.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <string_view>

namespace palpate {
namespace {

constexpr std::string_view kHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,"
    "region,contact,event,tick_ns\n";

/// `text` as a field of a CSV table: in double quotes where that is needed.
std::string inCsv(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

/// A few numbers, each followed by a comma, printed on the stack and appended at once: so the
/// string does not first fill the space with zeros. The longest double in shortest form has 24
/// characters (-2.2250738585072014e-308), an int64 has 20.
template <std::size_t kCount>
class Numbers {
 public:
  template <typename Number>
  void add(Number value) {
    at_ = std::to_chars(at_, buffer_.data() + buffer_.size(), value).ptr;
    *at_++ = ',';
  }
  void add(const Vec3& v) {
    for (int i = 0; i < 3; ++i) add(v[i]);
  }
  [[nodiscard]] std::string_view text() const {
    return {buffer_.data(), static_cast<std::size_t>(at_ - buffer_.data())};
  }

 private:
  std::array<char, 32 * kCount> buffer_;
  char* at_ = buffer_.data();
};

const std::string& nameOf(std::span<const std::string> names, std::size_t id, const char* what) {
  if (id < names.size()) return names[id];
  throw inputError("trace.name", std::string("the trace has ") + what + " number " +
                                     std::to_string(id) + ", but names for only " +
                                     std::to_string(names.size()));
}

/// The ports of one tick as one field.
std::string events(const TickResult& result, std::span<const std::string> ports) {
  const auto count = std::min<std::size_t>(result.event_count, TickResult::kMaxEvents);
  std::string joined;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) joined += ';';
    joined += nameOf(ports, result.events[i], "port");
  }
  return inCsv(joined);
}

}  // namespace

TraceText::TraceText(std::span<const std::string> regions, std::span<const std::string> ports)
    : ports_(ports.begin(), ports.end()) {
  regions_.reserve(regions.size());
  for (const std::string& name : regions) regions_.push_back(inCsv(name));
}

TraceText::TraceText(const Scene& scene) {
  for (const Region& region : scene.regions()) regions_.push_back(inCsv(region.name));
  for (const Port& port : scene.ports()) ports_.push_back(port.name);
}

std::string_view TraceText::header() noexcept { return kHeader; }

void TraceText::add(std::string& text, const TraceRow& row) const {
  const std::string& region = nameOf(regions_, row.result.region, "region");
  Numbers<10> numbers;
  numbers.add(row.t);
  numbers.add(row.hip);
  numbers.add(row.result.proxy);
  numbers.add(row.result.force);
  text += numbers.text();
  text += region;
  text += row.result.contact ? ",1," : ",0,";
  if (row.result.event_count > 0) text += events(row.result, ports_);
  text += ',';
  Numbers<1> time;
  time.add(row.tick_ns);
  text += time.text();
  text.back() = '\n';
}

namespace {

std::string textOf(std::span<const TraceRow> rows, const TraceText& format) {
  constexpr std::size_t kTypicalRow = 220;  // for numbers that use all their digits
  std::string out;
  out.reserve(kHeader.size() + kTypicalRow * rows.size());
  out += kHeader;
  for (const TraceRow& row : rows) format.add(out, row);
  return out;
}

}  // namespace

std::string traceCsv(std::span<const TraceRow> rows, std::span<const std::string> regions,
                     std::span<const std::string> ports) {
  return textOf(rows, TraceText(regions, ports));
}

std::string traceCsv(std::span<const TraceRow> rows, const Scene& scene) {
  return textOf(rows, TraceText(scene));
}

}  // namespace palpate
