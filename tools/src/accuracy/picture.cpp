#include <algorithm>
#include <array>
#include <functional>

#include "accuracy/accuracy_report.h"
#include "bench/machine_json.h"
#include "bench/svg.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1300.0;
constexpr double kHeight = 1060.0;
constexpr double kMark = 6.0;  ///< half the width of a mark
constexpr std::array<const char*, 3> kColors = {"#1f5fa8", "#c4571b", "#6b8e23"};

using Quantity = std::function<double(const Rung&, const SamplerResult&)>;

struct Scale {
  Quantity of;
  std::string label;
};

const char* colorOf(vdb::Sampler sampler) {
  return kColors[static_cast<std::size_t>(sampler) % kColors.size()];
}

/// A mark for a field: circle, square, triangle, diamond, and so on in turn.
std::string mark(double x, double y, std::size_t field, const char* color) {
  const std::string fill = std::string("' fill='") + color + "'/>\n";
  const auto corners = [&](const std::vector<std::pair<double, double>>& offsets) {
    std::string points;
    for (const auto& [dx, dy] : offsets) {
      points +=
          (points.empty() ? "" : " ") + svgNumber(x + kMark * dx) + "," + svgNumber(y + kMark * dy);
    }
    return "<polygon points='" + points + fill;
  };
  switch (field % 4) {
    case 1:
      return corners({{-0.9, -0.9}, {0.9, -0.9}, {0.9, 0.9}, {-0.9, 0.9}});
    case 2:
      return corners({{0.0, -1.2}, {1.1, 0.9}, {-1.1, 0.9}});
    case 3:
      return corners({{0.0, -1.3}, {1.3, 0.0}, {0.0, 1.3}, {-1.3, 0.0}});
    default:
      return "<circle cx='" + svgNumber(x) + "' cy='" + svgNumber(y) + "' r='" + svgNumber(kMark) +
             fill;
  }
}

/// The curve of one field and sampler, from coarse to fine.
std::string curve(const FieldResult& result, std::size_t field, vdb::Sampler sampler,
                  const Scale& x_scale, const Scale& y_scale, const Axis& x, const Axis& y,
                  const LengthUnit& unit) {
  std::string way;
  std::string marks;
  for (const Rung& rung : result.rungs) {
    for (const SamplerResult& s : rung.samplers) {
      const double error = y_scale.of(rung, s);
      const double cost = x_scale.of(rung, s);
      if (s.sampler != sampler || !(error > 0.0) || !(cost > 0.0)) continue;
      way += (way.empty() ? "" : " ") + svgNumber(x.at(cost)) + "," + svgNumber(y.at(error));
      marks += mark(x.at(cost), y.at(error), field, colorOf(sampler));
      marks += svgText(x.at(cost) + 10.0, y.at(error) + 4.0, "font-size='11' fill='#555'",
                       formatNumber(rung.voxel / unit.meters, 3));
    }
  }
  return "<polyline points='" + way + "' fill='none' stroke='" + colorOf(sampler) + "'/>\n" + marks;
}

std::string panel(const Frame& frame, const std::vector<FieldResult>& results, const Scale& x_scale,
                  const Scale& y_scale, const LengthUnit& unit) {
  double least_x = 1e300, most_x = 0.0, least_y = 1e300, most_y = 0.0;
  for (const FieldResult& result : results) {
    for (const Rung& rung : result.rungs) {
      for (const SamplerResult& s : rung.samplers) {
        const double cost = x_scale.of(rung, s);
        const double error = y_scale.of(rung, s);
        if (!(error > 0.0) || !(cost > 0.0)) continue;
        least_x = std::min(least_x, cost);
        most_x = std::max(most_x, cost);
        least_y = std::min(least_y, error);
        most_y = std::max(most_y, error);
      }
    }
  }
  if (!(most_x > 0.0)) least_x = most_x = least_y = most_y = 1.0;
  const Axis x = axisFor(least_x, most_x, frame.left, frame.right);
  const Axis y = axisFor(least_y, most_y, frame.bottom, frame.top);
  std::string out = svgAxes(frame, x, y, x_scale.label, y_scale.label);
  for (std::size_t field = 0; field < results.size(); ++field) {
    for (const Orders& o : results[field].orders) {
      out += curve(results[field], field, o.sampler, x_scale, y_scale, x, y, unit);
    }
  }
  return out;
}

std::string key(const std::vector<FieldResult>& results) {
  std::string out;
  double at = 90.0;
  const double y = 84.0;
  for (const Orders& o : results.front().orders) {
    out += "<rect x='" + svgNumber(at) + "' y='" + svgNumber(y - 7.0) +
           "' width='26' height='6' fill='" + colorOf(o.sampler) + "'/>\n";
    out += svgText(at + 34.0, y, "", samplerName(o.sampler));
    at += 130.0;
  }
  for (std::size_t field = 0; field < results.size(); ++field) {
    out += mark(at, y - 5.0, field, "#333");
    out += svgText(at + 14.0, y, "", results[field].asked.name);
    at += 40.0 + 9.0 * static_cast<double>(results[field].asked.name.size());
  }
  return out;
}

}  // namespace

std::string accuracySvg(const std::vector<FieldResult>& results, const LengthUnit& unit,
                        const Machine& machine) {
  const Scale time = {[](const Rung&, const SamplerResult& s) { return s.times.dependent; },
                      "value + gradient, each query waiting for the last [ns]"};
  const Scale memory = {
      [](const Rung&, const SamplerResult& s) { return static_cast<double>(s.memory); },
      "memory [bytes]"};
  const Scale normal = {[](const Rung&, const SamplerResult& s) { return s.smooth.normal.rms; },
                        "error of the normal, RMS [degree]"};
  const Scale value = {
      [&](const Rung&, const SamplerResult& s) { return s.smooth.value.rms / unit.meters; },
      "error of the distance, RMS [" + unit.name + "]"};

  std::string out = svgPage(kWidth, kHeight);
  out += svgText(90.0, 34.0, "font-size='20'", "Grids: error against time and memory");
  out += svgText(90.0, 58.0, "font-size='12' fill='#555'",
                 machineText(machine) + "; numbers at the marks: voxel size [" + unit.name + "]");
  out += key(results);
  out += panel({90.0, 620.0, 110.0, 500.0}, results, time, normal, unit);
  out += panel({740.0, 1270.0, 110.0, 500.0}, results, memory, normal, unit);
  out += panel({90.0, 620.0, 600.0, 990.0}, results, time, value, unit);
  out += panel({740.0, 1270.0, 600.0, 990.0}, results, memory, value, unit);
  return out + "</svg>\n";
}

}  // namespace palpate::tools
