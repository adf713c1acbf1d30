#include "touch_summary.h"

#include <algorithm>
#include <optional>

#include "json_parts.h"
#include "quantile.h"

namespace palpate::tools {

TouchSummary summarize(std::span<const TraceRow> rows, RendererKind kind) {
  TouchSummary summary;
  if (kind == RendererKind::kConstraint) summary.unsettled.emplace();
  summary.ticks = rows.size();
  if (rows.empty()) return summary;
  summary.seconds = rows.back().t - rows.front().t;

  // Depths count from where the probe first met a surface: pressed a wall or passed a port.
  std::optional<Vec3> first_surface;
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
    const bool new_region = summary.visits.empty() || summary.visits.back().region != r.region;
    if (!first_surface &&
        (r.contact || r.event_count > 0 || (new_region && !summary.visits.empty()))) {
      first_surface = r.proxy;
    }
    const double depth = first_surface ? glm::distance(*first_surface, r.proxy) : 0.0;
    if (new_region) summary.visits.push_back({r.region, row.t, 0.0, depth, depth, 0.0});
    Visit& visit = summary.visits.back();
    const double force = glm::length(r.force);
    visit.seconds = row.t - visit.t;
    visit.depth = std::max(visit.depth, depth);
    visit.peak_force = std::max(visit.peak_force, force);
    if (force > summary.peak_force) {
      summary.peak_force = force;
      summary.peak_force_at = r.proxy;
    }
    if (r.contact) ++summary.contact_ticks;
    if (summary.unsettled) summary.unsettled->add(r.settled);
    for (std::size_t i = 0; i < r.event_count; ++i) summary.ports.push_back({row.t, r.events[i]});
  }
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
    json["regions"].push_back({{"region", scene.regions()[v.region].name},
                               {"t", v.t},
                               {"seconds", v.seconds},
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
  const auto length = [&](double metres) { return formatNumber(metres / unit, 4) + " " + name; };

  std::string text = "Regions in order (depth below the first surface met)\n";
  Table table({"#", "region", "entered at", "depth at entry", "deepest", "peak force"});
  for (std::size_t i = 0; i < s.visits.size(); ++i) {
    const Visit& v = s.visits[i];
    table.add({std::to_string(i + 1), scene.regions()[v.region].name, formatNumber(v.t, 4) + " s",
               length(v.entry_depth), length(v.depth), formatNumber(v.peak_force, 3) + " N"});
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
    text += ", where flows and lattices gave " + formatNumber(s.source_work, 4) + " J";
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
