#include "bench/plot.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include "bench/svg.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1200.0;
constexpr double kHeight = 800.0;
constexpr double kLeft = 90.0;
constexpr double kRight = 850.0;
constexpr double kTop = 80.0;
constexpr double kBottom = 730.0;
constexpr double kMark = 9.0;  ///< radius of a mark
constexpr std::array<const char*, 2> kColors = {"#1f5fa8", "#c4571b"};

struct Spot {
  double x = 0.0;
  double y = 0.0;
};

/// The free spot nearest to `wanted`, on a spiral around it.
Spot freeSpot(const Spot& wanted, const std::vector<Spot>& taken) {
  const auto is_free = [&](const Spot& spot) {
    return std::none_of(taken.begin(), taken.end(), [&](const Spot& other) {
      return std::hypot(spot.x - other.x, spot.y - other.y) < 2.0 * kMark + 1.0;
    });
  };
  for (int i = 0; i < 2000; ++i) {
    const double radius = 0.1 * i;
    const double angle = i * std::numbers::phi * 2.0 * std::numbers::pi;
    const Spot spot{wanted.x + radius * std::cos(angle), wanted.y + radius * std::sin(angle)};
    if (spot.x >= kLeft && spot.x <= kRight && spot.y >= kTop && spot.y <= kBottom &&
        is_free(spot)) {
      return spot;
    }
  }
  return wanted;
}

std::string mark(const Spot& spot, std::size_t series, const std::string& label) {
  const char* color = kColors[series % kColors.size()];
  std::string shape;
  if (series % kColors.size() == 0) {
    shape = "<circle cx='" + svgNumber(spot.x) + "' cy='" + svgNumber(spot.y) + "' r='" +
            svgNumber(kMark) + "'";
  } else {
    shape = "<rect x='" + svgNumber(spot.x - kMark) + "' y='" + svgNumber(spot.y - kMark) +
            "' width='" + svgNumber(2.0 * kMark) + "' height='" + svgNumber(2.0 * kMark) + "'";
  }
  return shape + " fill='" + color + "'/>\n" +
         svgText(spot.x, spot.y + 4.0, "text-anchor='middle' font-size='11' fill='#fff'", label);
}

}  // namespace

std::string plotSvg(const Plot& plot) {
  double least_x = 1e300;
  double most_x = 0.0;
  double most_y = plot.least_y;
  for (const PlotPoint& point : plot.points) {
    least_x = std::min(least_x, point.x);
    most_x = std::max(most_x, point.x);
    most_y = std::max(most_y, point.y);
  }
  if (plot.points.empty()) least_x = most_x = 1.0;
  const Axis x = axisFor(least_x, most_x, kLeft, kRight);
  const Axis y = axisFor(plot.least_y, most_y, kBottom, kTop);

  std::string out = svgPage(kWidth, kHeight);
  out += svgText(kLeft, 34.0, "font-size='20'", plot.title);
  out += svgText(kLeft, 58.0, "font-size='12' fill='#555'", plot.subtitle);
  out += svgAxes({kLeft, kRight, kTop, kBottom}, x, y, plot.x_label, plot.y_label);

  std::vector<Spot> taken;
  std::string marks;
  for (const PlotPoint& point : plot.points) {
    const Spot wanted{x.at(point.x), y.at(std::max(point.y, plot.least_y))};
    const Spot spot = freeSpot(wanted, taken);
    taken.push_back(spot);
    out += svgLine(wanted.x, wanted.y, spot.x, spot.y, "#555");
    marks += mark(spot, point.series, std::to_string(point.number));
  }
  out += marks;

  double at = kTop + 10.0;
  for (std::size_t i = 0; i < plot.series.size(); ++i, at += 26.0) {
    out += mark({kRight + 40.0, at}, i, "");
    out += svgText(kRight + 60.0, at + 5.0, "", plot.series[i]);
  }
  at += 14.0;
  for (std::size_t i = 0; i < plot.key.size(); ++i, at += 22.0) {
    out += svgText(kRight + 48.0, at, "text-anchor='end' fill='#555'", std::to_string(i + 1));
    out += svgText(kRight + 60.0, at, "", plot.key[i]);
  }
  return out + "</svg>\n";
}

}  // namespace palpate::tools
