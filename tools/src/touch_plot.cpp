#include "touch_plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <vector>

#include "bench/svg.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1200.0;
constexpr double kHeight = 800.0;
constexpr Frame kFrame{90.0, 1160.0, 110.0, 730.0};
constexpr const char* kIn = "#1f5fa8";
constexpr const char* kOut = "#c4571b";

/// A stretch of the page for values from `least` to `most`, with round numbers at even steps.
struct Scale {
  double least = 0.0;
  double most = 1.0;
  double from = 0.0;
  double to = 1.0;
  double step = 1.0;

  Scale(double lowest, double highest, double begin, double end) : from(begin), to(end) {
    if (!(highest > lowest)) highest = lowest + 1.0;
    const double rough = (highest - lowest) / 8.0;
    const double decade = std::pow(10.0, std::floor(std::log10(rough)));
    step = decade;
    for (const double round : {2.0, 5.0, 10.0}) {
      if (step < rough) step = round * decade;
    }
    least = step * std::floor(lowest / step);
    most = step * std::ceil(highest / step);
  }
  [[nodiscard]] double at(double value) const {
    return from + (to - from) * (value - least) / (most - least);
  }
  [[nodiscard]] int count() const { return static_cast<int>(std::lround((most - least) / step)); }
  [[nodiscard]] double number(int i) const {
    const double value = least + i * step;
    return std::fabs(value) < 1e-9 * step ? 0.0 : value;
  }
};

struct Sample {
  double depth = 0.0;  ///< in the scene's unit
  double force = 0.0;  ///< [N]
};

std::string axes(const Scale& x, const Scale& y, const std::string& unit) {
  std::string out;
  for (int i = 0; i <= x.count(); ++i) {
    const double at = x.at(x.number(i));
    out += svgLine(at, kFrame.top, at, kFrame.bottom, "#ddd");
    out += svgText(at, kFrame.bottom + 22.0, "text-anchor='middle'", formatNumber(x.number(i), 4));
  }
  for (int i = 0; i <= y.count(); ++i) {
    const double at = y.at(y.number(i));
    out += svgLine(kFrame.left, at, kFrame.right, at, y.number(i) == 0.0 ? "#888" : "#ddd");
    out += svgText(kFrame.left - 8.0, at + 5.0, "text-anchor='end'", formatNumber(y.number(i), 4));
  }
  out += svgText(0.5 * (kFrame.left + kFrame.right), kFrame.bottom + 52.0, "text-anchor='middle'",
                 "depth of the hand, " + unit);
  const double middle = 0.5 * (kFrame.top + kFrame.bottom);
  return out + svgText(28.0, middle,
                       "text-anchor='middle' transform='rotate(-90 28 " + svgNumber(middle) + ")'",
                       "force against the way in, N");
}

std::string curve(const std::vector<Sample>& samples, std::size_t first, std::size_t last,
                  const Scale& x, const Scale& y, const char* color) {
  std::string points;
  for (std::size_t i = first; i <= last && i < samples.size(); ++i) {
    points += svgNumber(x.at(samples[i].depth)) + "," + svgNumber(y.at(samples[i].force)) + " ";
  }
  return "<polyline fill='none' stroke-width='1.6' stroke='" + std::string(color) + "' points='" +
         points + "'/>\n";
}

}  // namespace

std::string forcePlot(std::span<const TraceRow> rows, const Scene& scene,
                      const std::string& title) {
  std::optional<Vec3> surface;
  for (std::size_t i = 0; i < rows.size() && !surface; ++i) {
    const TickResult& r = rows[i].result;
    if (r.contact || r.event_count > 0) surface = r.contact ? r.proxy : rows[i].hip;
  }
  const Vec3 origin = surface.value_or(rows.empty() ? Vec3(0.0) : rows.front().hip);
  Vec3 furthest(0.0);
  std::size_t turn = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    // What comes before the surface lies on the other side of it.
    const Vec3 way = rows[i].hip - origin;
    if (surface && glm::dot(way, origin - rows.front().hip) < 0.0) continue;
    if (glm::length(way) > glm::length(furthest)) {
      furthest = way;
      turn = i;
    }
  }
  const Vec3 axis = unitOr(furthest, Vec3(0.0, 0.0, -1.0));
  const double unit = scene.metresPerUnit();
  std::vector<Sample> samples;
  Sample lowest{0.0, 0.0};
  Sample highest{0.0, 0.0};
  for (const TraceRow& row : rows) {
    const Sample s{glm::dot(row.hip - origin, axis) / unit, -glm::dot(row.result.force, axis)};
    samples.push_back(s);
    lowest = {std::min(lowest.depth, s.depth), std::min(lowest.force, s.force)};
    highest = {std::max(highest.depth, s.depth), std::max(highest.force, s.force)};
  }
  const Scale x(lowest.depth, highest.depth, kFrame.left, kFrame.right);
  const Scale y(lowest.force, highest.force, kFrame.bottom, kFrame.top);

  std::string out = svgPage(kWidth, kHeight);
  out += svgText(kFrame.left, 34.0, "font-size='20'", title);
  out += svgText(kFrame.left, 58.0, "fill='" + std::string(kIn) + "'", "going in");
  if (turn + 1 < rows.size()) {
    out += svgText(kFrame.left + 90.0, 58.0, "fill='" + std::string(kOut) + "'", "coming back");
  }
  out += axes(x, y, scene.lengthUnit());
  // Ports passed on the way in hang from the top, those on the way back stand on the bottom; names that would
  // run into each other stand one above the other.
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
  return out + "</svg>\n";
}

}  // namespace palpate::tools
