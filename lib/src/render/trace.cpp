#include "palpate/render/trace.h"

#include <algorithm>
#include <charconv>
#include <string_view>

namespace palpate {
namespace {

constexpr std::string_view kHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,"
    "region,contact,event,tick_ns\n";

/// The longest shortest double is -2.2250738585072014e-308: 24 characters; an int64 takes 20.
constexpr std::size_t kNumberRoom = 32;

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) {
    if (c == '"') out += '"';
    out += c;
  }
  return out + '"';
}

/// Appends to a string that is grown in large steps, so that numbers are printed straight into it.
class Writer {
 public:
  explicit Writer(std::size_t expected) { text_.resize(expected); }

  template <typename Number>
  void number(Number value) {
    room(kNumberRoom);
    used_ = static_cast<std::size_t>(
        std::to_chars(text_.data() + used_, text_.data() + text_.size(), value).ptr - text_.data());
  }
  void character(char c) {
    room(1);
    text_[used_++] = c;
  }
  void words(std::string_view words) {
    room(words.size());
    std::copy(words.begin(), words.end(), text_.begin() + static_cast<std::ptrdiff_t>(used_));
    used_ += words.size();
  }
  void vector(const Vec3& v) {
    for (int i = 0; i < 3; ++i) {
      number(v[i]);
      character(',');
    }
  }
  [[nodiscard]] std::string take() && {
    text_.resize(used_);
    return std::move(text_);
  }

 private:
  void room(std::size_t more) {
    if (text_.size() - used_ < more) text_.resize(2 * text_.size() + more);
  }

  std::string text_;
  std::size_t used_ = 0;
};

const std::string& nameOf(std::span<const std::string> names, std::size_t id, const char* what) {
  if (id < names.size()) return names[id];
  throw inputError("trace.name", std::string("the trace has the ") + what + " number " +
                                     std::to_string(id) + ", but only " +
                                     std::to_string(names.size()) + " have a name");
}

/// The ports of one tick as one field. Quotes belong around the whole field, so names are joined bare.
void events(Writer& out, const TickResult& result, std::span<const std::string> ports) {
  if (result.event_count == 0) return;
  const auto count = std::min<std::size_t>(result.event_count, TickResult::kMaxEvents);
  if (count == 1) {
    out.words(quoted(nameOf(ports, result.events[0], "port")));
    return;
  }
  std::string joined;
  for (std::size_t i = 0; i < count; ++i) {
    if (i > 0) joined += ';';
    joined += nameOf(ports, result.events[i], "port");
  }
  out.words(quoted(joined));
}

}  // namespace

std::string traceCsv(std::span<const TraceRow> rows, std::span<const std::string> regions,
                     std::span<const std::string> ports) {
  std::vector<std::string> region_fields;
  region_fields.reserve(regions.size());
  for (const std::string& name : regions) region_fields.push_back(quoted(name));

  constexpr std::size_t kTypicalRow = 160;
  Writer out(kHeader.size() + kTypicalRow * rows.size());
  out.words(kHeader);
  for (const TraceRow& row : rows) {
    out.number(row.t);
    out.character(',');
    out.vector(row.hip);
    out.vector(row.result.proxy);
    out.vector(row.result.force);
    out.words(nameOf(region_fields, row.result.region, "region"));
    out.words(row.result.contact ? ",1," : ",0,");
    events(out, row.result, ports);
    out.character(',');
    out.number(row.tick_ns);
    out.character('\n');
  }
  return std::move(out).take();
}

std::string traceCsv(std::span<const TraceRow> rows, const Scene& scene) {
  std::vector<std::string> regions;
  for (const Region& region : scene.regions()) regions.push_back(region.name);
  std::vector<std::string> ports;
  for (const Port& port : scene.ports()) ports.push_back(port.name);
  return traceCsv(rows, regions, ports);
}

}  // namespace palpate
