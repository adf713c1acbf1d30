#include "report_page/strip_chart.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "even_scale.h"
#include "picture/palette.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1060.0;
constexpr double kLeft = 84.0;
constexpr double kRight = 1040.0;
constexpr double kBandTop = 40.0;
constexpr double kBandBottom = 72.0;
constexpr double kStrip = 130.0;     // height
constexpr double kGap = 34.0;        // between strips
constexpr double kLetter = 7.5;      // width
constexpr double kFine = 0.25;       // points that are closer together are drawn as one
constexpr double kPortSpace = 60.0;  // between names of ports

std::string hex(const Color& color) {
  const auto byte = [](double share) { return static_cast<unsigned>(std::lround(255.0 * share)); };
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "#%02x%02x%02x", byte(color.r), byte(color.g),
                byte(color.b));
  return text.data();
}

std::string box(double left, double right, double top, double bottom, const std::string& style) {
  return "<rect x='" + svgNumber(left) + "' y='" + svgNumber(top) + "' width='" +
         svgNumber(std::max(right - left, kFine)) + "' height='" + svgNumber(bottom - top) + "' " +
         style + "/>\n";
}

/// A band with one color for each region, its name where there is room, and green lines where a
/// port was passed.
std::string regionBand(const TouchSummary& summary, const EvenScale& x, double end,
                       const std::vector<std::string>& regions,
                       const std::vector<std::string>& ports) {
  std::string out;
  double drawn = -kInfinity;
  for (std::size_t i = 0; i < summary.visits.size(); ++i) {
    const Visit& visit = summary.visits[i];
    const double from = x.at(visit.t);
    const double to = x.at(i + 1 < summary.visits.size() ? summary.visits[i + 1].t : end);
    if (!(to - drawn > kFine)) continue;
    drawn = to;
    const std::string& name = regions[visit.region];
    out += box(from, to, kBandTop, kBandBottom,
               "fill='" + hex(regionColor(visit.region)) + "' stroke='#999' stroke-width='0.5'");
    if (to - from > kLetter * static_cast<double>(name.size()) + 6.0) {
      out += svgText(0.5 * (from + to), 0.5 * (kBandTop + kBandBottom) + 5.0,
                     "text-anchor='middle' font-size='13' fill='#222'", name);
    }
  }
  double named = -kInfinity;
  double marked = -kInfinity;
  for (const PassedPort& port : summary.ports) {
    const double at = x.at(port.t);
    if (!(at - marked > kFine)) continue;
    marked = at;
    out += svgLine(at, kBandTop - 8.0, at, kBandBottom, "#0b8a72");
    if (at - named < kPortSpace) continue;
    named = at;
    out += svgText(at + 3.0, kBandTop - 6.0, "font-size='12' fill='#0b8a72'", ports[port.port]);
  }
  return out;
}

/// The area between the least and the most value of each column.
std::string strip(double top, const EvenScale& x, const std::vector<TickColumn>& columns,
                  Extent TickColumn::*what, double unit, const std::string& label,
                  const char* color) {
  Extent all;
  all.add(0.0);
  for (const TickColumn& column : columns) all.add(column.*what);
  const double bottom = top + kStrip;
  const EvenScale y(all.least / unit, all.most / unit, bottom, top, 4.0);
  std::string out = box(kLeft, kRight, top, bottom, "fill='#fff' stroke='#bbb'");
  for (int i = 0; i <= y.count(); ++i) {
    const double at = y.at(y.number(i));
    out += svgLine(kLeft, at, kRight, at, y.number(i) == 0.0 ? "#888" : "#e2e2e2");
    out += svgText(kLeft - 8.0, at + 4.5, "text-anchor='end' font-size='12'",
                   formatNumber(y.number(i), 4));
  }
  out += svgText(kLeft, top - 8.0, "font-size='13' fill='" + std::string(color) + "'", label);
  std::string upper;
  std::string lower;
  for (const TickColumn& column : columns) {
    const Extent& extent = column.*what;
    upper += svgNumber(x.at(column.begin)) + "," + svgNumber(y.at(extent.most / unit)) + " ";
    lower.insert(0,
                 svgNumber(x.at(column.begin)) + "," + svgNumber(y.at(extent.least / unit)) + " ");
  }
  return out + "<polygon fill='" + color + "' stroke='" + color +
         "' stroke-width='1.2' stroke-linejoin='round' points='" + upper + lower + "'/>\n";
}

}  // namespace

std::string stripChart(const TouchSummary& summary, const std::vector<TickColumn>& columns,
                       const std::vector<std::string>& regions,
                       const std::vector<std::string>& ports) {
  constexpr double kFirst = kBandBottom + kGap;
  constexpr double kBottom = kFirst + 3.0 * kStrip + 2.0 * kGap;
  if (columns.empty()) return svgPage(kWidth, kBottom + 44.0) + "</svg>\n";
  Extent times;
  for (const TickColumn& column : columns) {
    times.add(column.begin);
    times.add(column.end);
  }
  EvenScale x(times.least, times.most, kLeft, kRight);
  x.least = times.least;  // use the full width for the touch itself
  x.most = std::max(times.most, times.least + 1e-9);
  std::string out = svgPage(kWidth, kBottom + 44.0);
  out += regionBand(summary, x, times.most, regions, ports);
  out += strip(kFirst, x, columns, &TickColumn::force, 1.0, "force on the hand, N", "#c3213b");
  out += strip(kFirst + kStrip + kGap, x, columns, &TickColumn::beyond, 1e-3,
               "hand beyond the proxy, mm", "#c96a12");
  out += strip(kFirst + 2.0 * (kStrip + kGap), x, columns, &TickColumn::work, 1e-3,
               "work on the hand since the first tick, mJ", "#1f4fb0");
  const double first = x.step * std::ceil(x.least / x.step - 1e-9);
  for (int i = 0; first + i * x.step <= x.most + 1e-9 * x.step; ++i) {
    const double value = first + i * x.step;
    out += svgLine(x.at(value), kBottom, x.at(value), kBottom + 5.0, "#888");
    out += svgText(x.at(value), kBottom + 19.0, "text-anchor='middle' font-size='12'",
                   formatNumber(std::fabs(value) < 1e-9 * x.step ? 0.0 : value, 6));
  }
  out += svgText(0.5 * (kLeft + kRight), kBottom + 37.0, "text-anchor='middle' font-size='13'",
                 "time, s");
  return out + "</svg>\n";
}

}  // namespace palpate::tools
