#include "touch_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bench/svg.h"
#include "even_scale.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1200.0;
constexpr double kHeight = 800.0;
constexpr Frame kFrame{90.0, 1160.0, 110.0, 730.0};
/// A second plot below the first, drawn if the hand leaves the straight way in.
constexpr Frame kWayFrame{90.0, 1160.0, 860.0, 1240.0};
constexpr double kWayHeight = 1310.0;
/// The hand has left the straight way in if it is farther off than this share of the way's length.
constexpr double kOffWay = 0.02;
constexpr const char* kAlong = "#333333";
constexpr const char* kAcross = "#2a8a4a";
constexpr const char* kIn = "#1f5fa8";
constexpr const char* kOut = "#c4571b";

struct Sample {
  double depth = 0.0;  ///< in the scene's unit
  double force = 0.0;  ///< [N]
};

std::string curve(const std::vector<Sample>& samples, std::size_t first, std::size_t last,
                  const EvenScale& x, const EvenScale& y, const char* color) {
  std::string points;
  for (std::size_t i = first; i <= last && i < samples.size(); ++i) {
    points += svgNumber(x.at(samples[i].depth)) + "," + svgNumber(y.at(samples[i].force)) + " ";
  }
  return "<polyline fill='none' stroke-width='1.6' stroke='" + std::string(color) + "' points='" +
         points + "'/>\n";
}

/// The same forces along the hand's own path and perpendicular to it, over the length of that path:
/// the forces on a hand that turns off the straight way.
std::string wayPanel(const Trace& trace, const Scene& scene) {
  const std::span<const TraceRow> rows = trace.rows();
  const double unit = scene.metersPerUnit();
  std::vector<Sample> along;
  std::vector<Sample> across;
  std::vector<double> port_at;
  Sample lowest{0.0, 0.0};
  Sample highest{0.0, 0.0};
  double way = 0.0;
  Vec3 direction(0.0);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    if (i > 0) {
      const Vec3 step = rows[i].hip - rows[i - 1].hip;
      way += glm::length(step) / unit;
      direction = unitOr(step, direction);
    }
    const Vec3& force = rows[i].result.force;
    const double forward = glm::dot(force, direction);
    along.push_back({way, forward});
    across.push_back({way, glm::length(force - forward * direction)});
    lowest.force = std::min(lowest.force, forward);
    highest.force = std::max({highest.force, forward, across.back().force});
    if (rows[i].result.event_count > 0) port_at.push_back(way);
  }
  const EvenScale x(0.0, way, kWayFrame.left, kWayFrame.right);
  const EvenScale y(lowest.force, highest.force, kWayFrame.bottom, kWayFrame.top);
  std::string out = evenAxes(kWayFrame, x, y, "way of the hand, " + scene.lengthUnit(), "force, N");
  const double label = kWayFrame.top - 12.0;
  out += svgText(kWayFrame.left, label, "fill='" + std::string(kAlong) + "'",
                 "along its way (less than 0: held back)");
  out += svgText(kWayFrame.left + 290.0, label, "fill='" + std::string(kAcross) + "'",
                 "square to its way");
  for (const double at : port_at) {
    out += svgLine(x.at(at), kWayFrame.top, x.at(at), kWayFrame.bottom, kIn);
  }
  if (along.empty()) return out;
  out += curve(across, 0, across.size() - 1, x, y, kAcross);
  return out + curve(along, 0, along.size() - 1, x, y, kAlong);
}

}  // namespace

std::string forcePlot(const Trace& trace, const Scene& scene, const std::string& title) {
  const std::span<const TraceRow> rows = trace.rows();
  std::optional<Vec3> surface;
  for (std::size_t i = 0; i < rows.size() && !surface; ++i) {
    const TickResult& r = rows[i].result;
    if (rows[i].entry_count > 0) {
      surface = trace.entriesOf(rows[i]).front().point;
    } else if (r.contact || r.event_count > 0) {
      surface = r.proxy;
    }
  }
  const Vec3 origin = surface.value_or(rows.empty() ? Vec3(0.0) : rows.front().hip);
  Vec3 furthest(0.0);
  std::size_t turn = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // Points on the side of the surface from which the hand came do not count.
    const Vec3 way = rows[i].hip - origin;
    if (surface && glm::dot(way, origin - rows.front().hip) < 0.0) continue;
    if (glm::length(way) > glm::length(furthest)) {
      furthest = way;
      turn = i;
    }
  }
  const Vec3 axis = unitOr(furthest, Vec3(0.0, 0.0, -1.0));
  const double unit = scene.metersPerUnit();
  std::vector<Sample> samples;
  Sample lowest{0.0, 0.0};
  Sample highest{0.0, 0.0};
  for (const TraceRow& row : rows) {
    const Sample s{glm::dot(row.hip - origin, axis) / unit, -glm::dot(row.result.force, axis)};
    samples.push_back(s);
    lowest = {std::min(lowest.depth, s.depth), std::min(lowest.force, s.force)};
    highest = {std::max(highest.depth, s.depth), std::max(highest.force, s.force)};
  }
  const EvenScale x(lowest.depth, highest.depth, kFrame.left, kFrame.right);
  const EvenScale y(lowest.force, highest.force, kFrame.bottom, kFrame.top);

  double off = 0.0;
  for (const TraceRow& row : rows) {
    const Vec3 from = row.hip - origin;
    off = std::max(off, glm::length(from - glm::dot(from, axis) * axis));
  }
  const bool is_straight = !(off > kOffWay * (highest.depth - lowest.depth) * unit);
  std::string out = svgPage(kWidth, is_straight ? kHeight : kWayHeight);
  out += svgText(kFrame.left, 34.0, "font-size='20'", title);
  out += svgText(kFrame.left, 58.0, "fill='" + std::string(kIn) + "'", "going in");
  if (turn + 1 < rows.size()) {
    out += svgText(kFrame.left + 90.0, 58.0, "fill='" + std::string(kOut) + "'", "coming back");
  }
  out += evenAxes(kFrame, x, y, "depth of the hand, " + scene.lengthUnit(),
                  "force against the way in, N");
  // Ports passed on the way in are named at the top, those on the way back at the bottom; names
  // that would overlap are stacked.
  constexpr double kNameWidth = 130.0;
  std::array<double, 2> last_at = {-kWidth, -kWidth};
  std::array<int, 2> level = {0, 0};
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const TickResult& r = rows[i].result;
    for (std::size_t e = 0; e < r.event_count; ++e) {
      const bool inward = i <= turn;
      const std::size_t side = inward ? 0 : 1;
      const char* color = inward ? kIn : kOut;
      const double at = x.at(samples[i].depth);
      const double base = inward ? kFrame.top : kFrame.bottom;
      level[side] = std::fabs(at - last_at[side]) < kNameWidth ? (level[side] + 1) % 3 : 0;
      last_at[side] = at;
      out += svgLine(at, base, at, y.at(samples[i].force), color);
      out += svgText(at + 4.0, base - 6.0 - 15.0 * level[side],
                     "font-size='12' fill='" + std::string(color) + "'",
                     scene.ports()[r.events[e]].name);
    }
  }
  if (!samples.empty()) {
    out += curve(samples, turn, samples.size() - 1, x, y, kOut);
    out += curve(samples, 0, turn, x, y, kIn);
  }
  if (!is_straight) out += wayPanel(trace, scene);
  return out + "</svg>\n";
}

}  // namespace palpate::tools
