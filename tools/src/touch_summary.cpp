#include "touch_summary.h"

#include <algorithm>

#include "json_parts.h"

namespace palpate::tools {

TouchMeter::TouchMeter(RendererKind kind) : kind_(kind) {
  if (kind == RendererKind::kConstraint) summary_.unsettled.emplace();
}

void TouchMeter::add(const devices::RecordedTick& recorded, std::span<const RegionEntry> entries) {
  if (recorded.tick.scene != scene_) {
    summary_ = {};
    if (kind_ == RendererKind::kConstraint) summary_.unsettled.emplace();
    visit_ = {};
    has_visit_ = false;
    first_wall_.reset();
    times_ = {};
    scene_ = recorded.tick.scene;
  }
  const double t = recorded.tick.reading.time;
  const Vec3& hip = recorded.tick.hip.position;
  const TickResult& r = recorded.tick.result;
  if (summary_.ticks == 0) {
    begin_ = t;
  } else if (isFinite(hip - last_hip_)) {
    summary_.work += glm::dot(last_force_, hip - last_hip_);
  }
  last_hip_ = hip;
  last_force_ = r.force;
  ++summary_.ticks;
  summary_.seconds = t - begin_;
  times_.add(recorded.tick.renderer_ns);
  visit(t, r, entries);
  const double force = glm::length(r.force);
  if (force > summary_.peak_force) {
    summary_.peak_force = force;
    summary_.peak_force_at = r.proxy;
    summary_.is_peak_at_wall = r.contact;
  }
  if (r.contact) ++summary_.contact_ticks;
  if (summary_.unsettled) summary_.unsettled->add(r.settled);
  for (std::size_t i = 0; i < r.event_count; ++i) {
    if (summary_.ports.size() < TouchSummary::kMostListed) {
      summary_.ports.push_back({t, r.events[i]});
    } else {
      ++summary_.more_ports;
    }
  }
}

TouchSummary TouchMeter::summary() const {
  TouchSummary out = summary_;
  if (has_visit_ && out.more_visits == 0) out.visits.push_back(visit_);
  out.met_something =
      out.contact_ticks > 0 || !out.ports.empty() || out.visits.size() > 1 || out.peak_force > 0.0;
  out.tick_median = times_.quantile(0.5);
  out.tick_p99 = times_.quantile(0.99);
  out.tick_p999 = times_.quantile(0.999);
  out.tick_max = times_.longest();
  return out;
}

void TouchMeter::visit(double t, const TickResult& r, std::span<const RegionEntry> entries) {
  if (!has_visit_) begin(t, entries.empty() ? r.region : entries.front().from);
  for (const RegionEntry& entry : entries) pass(t, entry);
  // Depths count from the first wall that the probe met: one it pressed on, or one with a port it
  // passed.
  if (!first_wall_ && (r.contact || r.event_count > 0)) first_wall_ = r.proxy;
  // The region may differ because a full record of entries dropped some.
  if (visit_.region != r.region) begin(t, r.region, depthOf(r.proxy));
  visit_.seconds = t - visit_.t;
  visit_.depth = std::max(visit_.depth, depthOf(r.proxy));
  visit_.peak_force = std::max(visit_.ticks == 0 ? 0.0 : visit_.peak_force, glm::length(r.force));
  ++visit_.ticks;
}

void TouchMeter::begin(double t, RegionId region, double depth) {
  // Keep one place free for the visit that goes on.
  if (has_visit_ && summary_.visits.size() + 1 < TouchSummary::kMostListed) {
    summary_.visits.push_back(visit_);
  } else if (has_visit_) {
    ++summary_.more_visits;
  }
  visit_ = {};
  visit_.region = region;
  visit_.t = t;
  visit_.entry_depth = visit_.depth = depth;
  has_visit_ = true;
}

void TouchMeter::pass(double t, const RegionEntry& entry) {
  if (!first_wall_) first_wall_ = entry.point;
  const double depth = depthOf(entry.point);
  visit_.depth = std::max(visit_.depth, depth);
  visit_.seconds = t - visit_.t;
  if (visit_.ticks == 0) visit_.peak_force = entry.force + entry.cut;
  begin(t, entry.to, depth);
  visit_.port = entry.port;
  visit_.rupture = entry.force;
}

double TouchMeter::depthOf(const Vec3& p) const {
  return first_wall_ ? glm::distance(*first_wall_, p) : 0.0;
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
  json["peak_force_at_wall"] = s.is_peak_at_wall;
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
  json["more_regions"] = s.more_visits;
  json["events"] = Json::array();
  for (const PassedPort& p : s.ports) {
    json["events"].push_back({{"t", p.t}, {"port", scene.ports()[p.port].name}});
  }
  json["more_events"] = s.more_ports;
  json["tick_ns"] = {
      {"median", s.tick_median}, {"p99", s.tick_p99}, {"p99.9", s.tick_p999}, {"max", s.tick_max}};
  return json;
}

std::string summaryText(const TouchSummary& s, const Scene& scene) {
  const double unit = scene.metersPerUnit();
  const std::string& name = scene.lengthUnit();
  // A proxy stands off its wall by a rounding error, which does not count as depth.
  constexpr double kNoDepth = 1e-9;  // [m]
  const auto length = [&](double meters) {
    return formatNumber(meters < kNoDepth ? 0.0 : meters / unit, 4) + " " + name;
  };

  std::string text = "Regions in order (depth of walls and tip from the first wall met)\n";
  Table table(
      {"#", "region", "entered at", "depth at entry", "wall gave way at", "deepest", "peak force"});
  constexpr std::size_t kMostRows = 1000;
  for (std::size_t i = 0; i < std::min(s.visits.size(), kMostRows); ++i) {
    const Visit& v = s.visits[i];
    table.add({std::to_string(i + 1), scene.regions()[v.region].name, formatNumber(v.t, 4) + " s",
               length(v.entry_depth),
               v.rupture > 0.0 ? formatNumber(v.rupture, 3) + " N" : std::string("-"),
               length(v.depth), formatNumber(v.peak_force, 3) + " N"});
  }
  text += table.text("  ");
  if (s.visits.size() + s.more_visits > kMostRows) {
    text += "  ... and " + std::to_string(s.visits.size() + s.more_visits - kMostRows) + " more\n";
  }

  text += "\nPorts passed";
  if (s.ports.empty()) text += ": none";
  text += "\n";
  constexpr std::size_t kMostPorts = 24;
  for (std::size_t i = 0; i < std::min(s.ports.size(), kMostPorts); ++i) {
    text +=
        "  " + formatNumber(s.ports[i].t, 4) + " s  " + scene.ports()[s.ports[i].port].name + "\n";
  }
  if (s.ports.size() + s.more_ports > kMostPorts) {
    text += "  ... and " + std::to_string(s.ports.size() + s.more_ports - kMostPorts) + " more\n";
  }

  text += "\nPeak force  " + formatNumber(s.peak_force, 4) + " N";
  if (s.peak_force > 0.0) text += " at " + formatVector(s.peak_force_at / unit) + " " + name;
  if (s.peak_force > 0.0 && !s.is_peak_at_wall)
    text += ", from contents such as drag: no wall is pressed there";
  text += "\nWork        " + formatNumber(s.work, 4) + " J on the hand";
  if (s.source_work != 0.0) {
    text += ", of which flows, lattices and walls met behind others gave " +
            formatNumber(s.source_work, 4) + " J";
  }
  text += "\nTicks       " + formatCount(s.ticks) + " in " + formatNumber(s.seconds, 4) +
          " s of hand time, " + formatCount(s.contact_ticks) + " in contact with a wall\n";
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
