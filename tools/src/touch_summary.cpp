#include "touch_summary.h"

#include <algorithm>
#include <optional>

#include "json_parts.h"
#include "quantile.h"

namespace palpate::tools {

namespace {

/// Follows the proxy from region to region.
class Visits {
 public:
  void add(const TraceRow& row, std::span<const RegionEntry> entries) {
    const TickResult& r = row.result;
    if (visits_.empty()) begin(row.t, entries.empty() ? r.region : entries.front().from);
    for (const RegionEntry& entry : entries) pass(row.t, entry);
    // Depths count from where the probe first met a wall: pressed one, or passed a port.
    if (!first_wall_ && (r.contact || r.event_count > 0)) first_wall_ = r.proxy;
    // Entries that a full trace dropped.
    if (visits_.back().region != r.region) begin(row.t, r.region, depthOf(r.proxy));
    Visit& now = visits_.back();
    now.seconds = row.t - now.t;
    now.depth = std::max(now.depth, depthOf(r.proxy));
    now.peak_force = std::max(now.ticks == 0 ? 0.0 : now.peak_force, glm::length(r.force));
    ++now.ticks;
  }
  [[nodiscard]] std::vector<Visit> take() { return std::move(visits_); }

 private:
  void begin(double t, RegionId region, double depth = 0.0) {
    Visit visit;
    visit.region = region;
    visit.t = t;
    visit.entry_depth = visit.depth = depth;
    visits_.push_back(visit);
  }
  void pass(double t, const RegionEntry& entry) {
    if (!first_wall_) first_wall_ = entry.point;
    const double depth = depthOf(entry.point);
    Visit& left = visits_.back();
    left.depth = std::max(left.depth, depth);
    left.seconds = t - left.t;
    if (left.ticks == 0) left.peak_force = entry.force + entry.cut;
    begin(t, entry.to, depth);
    visits_.back().port = entry.port;
    visits_.back().rupture = entry.force;
  }
  [[nodiscard]] double depthOf(const Vec3& p) const {
    return first_wall_ ? glm::distance(*first_wall_, p) : 0.0;
  }

  std::vector<Visit> visits_;
  std::optional<Vec3> first_wall_;
};

}  // namespace

TouchSummary summarize(const Trace& trace, RendererKind kind) {
  TouchSummary summary;
  const std::span<const TraceRow> rows = trace.rows();
  if (kind == RendererKind::kConstraint) summary.unsettled.emplace();
  summary.ticks = rows.size();
  if (rows.empty()) return summary;
  summary.seconds = rows.back().t - rows.front().t;

  Visits visits;
  std::vector<std::int64_t> times;
  times.reserve(rows.size());
  const TraceRow* before = nullptr;
  for (const TraceRow& row : rows) {
    const TickResult& r = row.result;
    if (before != nullptr && isFinite(row.hip - before->hip)) {
      summary.work += glm::dot(before->result.force, row.hip - before->hip);
    }
    before = &row;
    times.push_back(row.tick_ns);
    visits.add(row, trace.entriesOf(row));
    const double force = glm::length(r.force);
    if (force > summary.peak_force) {
      summary.peak_force = force;
      summary.peak_force_at = r.proxy;
    }
    if (r.contact) ++summary.contact_ticks;
    if (summary.unsettled) summary.unsettled->add(r.settled);
    for (std::size_t i = 0; i < r.event_count; ++i) summary.ports.push_back({row.t, r.events[i]});
  }
  summary.visits = visits.take();
  summary.met_something = summary.contact_ticks > 0 || !summary.ports.empty() ||
                          summary.visits.size() > 1 || summary.peak_force > 0.0;
  std::sort(times.begin(), times.end());
  summary.tick_median = quantile(times, 0.5);
  summary.tick_p99 = quantile(times, 0.99);
  summary.tick_p999 = quantile(times, 0.999);
  summary.tick_max = static_cast<double>(times.back());
  return summary;
}

Json summaryJson(const TouchSummary& s, const Scene& scene) {
  Json json;
  json["ticks"] = s.ticks;
  json["seconds"] = s.seconds;
  json["contact_ticks"] = s.contact_ticks;
  json["unsettled_ticks"] = s.unsettled ? Json(s.unsettled->count()) : Json();
  json["unsettled_share"] = s.unsettled ? Json(s.unsettled->share()) : Json();
  json["longest_unsettled_ticks"] = s.unsettled ? Json(s.unsettled->longest()) : Json();
  json["peak_force_N"] = s.peak_force;
  json["peak_force_at_m"] = vectorJson(s.peak_force_at);
  json["work_on_hand_J"] = s.work;
  json["source_work_J"] = s.source_work;
  json["regions"] = Json::array();
  for (const Visit& v : s.visits) {
    json["regions"].push_back(
        {{"region", scene.regions()[v.region].name},
         {"t", v.t},
         {"seconds", v.seconds},
         {"port", v.port < 0 ? Json() : Json(scene.ports()[static_cast<std::size_t>(v.port)].name)},
         {"rupture_N", v.rupture > 0.0 ? Json(v.rupture) : Json()},
         {"entry_depth_m", v.entry_depth},
         {"depth_m", v.depth},
         {"peak_force_N", v.peak_force}});
  }
  json["events"] = Json::array();
  for (const PassedPort& p : s.ports) {
    json["events"].push_back({{"t", p.t}, {"port", scene.ports()[p.port].name}});
  }
  json["tick_ns"] = {
      {"median", s.tick_median}, {"p99", s.tick_p99}, {"p99.9", s.tick_p999}, {"max", s.tick_max}};
  return json;
}

std::string summaryText(const TouchSummary& s, const Scene& scene) {
  const double unit = scene.metresPerUnit();
  const std::string& name = scene.lengthUnit();
  // A proxy stands off its wall by a rounding error, which does not count as a depth.
  constexpr double kNoDepth = 1e-9;  // [m]
  const auto length = [&](double metres) {
    return formatNumber(metres < kNoDepth ? 0.0 : metres / unit, 4) + " " + name;
  };

  std::string text = "Regions in order (depth of walls and tip from the first wall met)\n";
  Table table(
      {"#", "region", "entered at", "depth at entry", "wall gave way at", "deepest", "peak force"});
  for (std::size_t i = 0; i < s.visits.size(); ++i) {
    const Visit& v = s.visits[i];
    table.add({std::to_string(i + 1), scene.regions()[v.region].name, formatNumber(v.t, 4) + " s",
               length(v.entry_depth),
               v.rupture > 0.0 ? formatNumber(v.rupture, 3) + " N" : std::string("-"),
               length(v.depth), formatNumber(v.peak_force, 3) + " N"});
  }
  text += table.text("  ");

  text += "\nPorts passed";
  if (s.ports.empty()) text += ": none";
  text += "\n";
  constexpr std::size_t kMostListed = 24;
  for (std::size_t i = 0; i < std::min(s.ports.size(), kMostListed); ++i) {
    text +=
        "  " + formatNumber(s.ports[i].t, 4) + " s  " + scene.ports()[s.ports[i].port].name + "\n";
  }
  if (s.ports.size() > kMostListed) {
    text += "  ... and " + std::to_string(s.ports.size() - kMostListed) + " more\n";
  }

  text += "\nPeak force  " + formatNumber(s.peak_force, 4) + " N";
  if (s.peak_force > 0.0) text += " at " + formatVector(s.peak_force_at / unit) + " " + name;
  text += "\nWork        " + formatNumber(s.work, 4) + " J on the hand";
  if (s.source_work != 0.0) {
    text += ", where flows, lattices and walls met behind others gave " +
            formatNumber(s.source_work, 4) + " J";
  }
  text += "\nTicks       " + formatCount(s.ticks) + " in " + formatNumber(s.seconds, 4) +
          " s of hand time, " + formatCount(s.contact_ticks) + " in contact\n";
  if (s.unsettled) {
    text += "Unsettled   " + formatCount(s.unsettled->count()) + " ticks (" +
            formatNumber(100.0 * s.unsettled->share(), 3) + " %), at most " +
            formatCount(s.unsettled->longest()) + " in a row\n";
  }
  text += "A tick took " + formatNanoseconds(s.tick_median) + " (median), " +
          formatNanoseconds(s.tick_p99) + " (99 %), " + formatNanoseconds(s.tick_p999) +
          " (99.9 %), " + formatNanoseconds(s.tick_max) + " (longest)\n";
  return text;
}

}  // namespace palpate::tools
