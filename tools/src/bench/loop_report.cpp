#include "bench/loop_report.h"

#include <algorithm>

#include "bench/machine_json.h"
#include "bench/plot.h"
#include "text.h"

namespace palpate::tools {
namespace {

std::string stiffness(double value) {
  if (value <= 0.0) return "none";
  if (value >= 0.99 * LoopLimit::kMost) return "all";
  return formatNumber(value, 3);
}

/// Number of `name` in `names`, from 1; a new name is added.
int numberOf(std::vector<std::string>& names, const std::string& name) {
  const auto at = std::find(names.begin(), names.end(), name);
  if (at != names.end()) return static_cast<int>(at - names.begin()) + 1;
  names.push_back(name);
  return static_cast<int>(names.size());
}

/// [N/m] The axis begins with the decade of this value.
double leastOf(const std::vector<PlotPoint>& points) {
  double least = points.empty() ? 1.0 : points.front().y;
  for (const PlotPoint& point : points) least = std::min(least, point.y);
  return least;
}

}  // namespace

Json limitJson(const LoopLimit& row) {
  return {{"scene", row.what.scene},
          {"renderer", row.what.renderer},
          {"device", row.what.device},
          {"hand", row.what.hand},
          {"rate_Hz", row.what.rate},
          {"delay", row.what.delay},
          {"linear_N_per_m", row.linear},
          {"budget_N_per_m", row.budget},
          {"found_N_per_m", row.found > 0.0 ? Json(row.found) : Json()},
          {"cycle_N", row.cycle},
          {"cycle_Hz", row.frequency},
          {"to_hand_J", row.to_hand},
          {"largest_step_N", row.largest_step},
          {"holds", row.holds},
          {"tick_ns", row.tick_ns}};
}

std::string limitsTable(const std::vector<LoopLimit>& rows) {
  Table table({"scene", "renderer", "device", "rate", "budget N/m", "found N/m", "above: N", "Hz",
               "at it: to hand J", "step N", "felt", "tick"});
  for (const LoopLimit& row : rows) {
    table.add({row.what.scene, row.what.renderer, row.what.device,
               formatNumber(row.what.rate, 5) + " Hz", formatNumber(row.budget, 3),
               stiffness(row.found), formatNumber(row.cycle, 2), formatNumber(row.frequency, 3),
               formatNumber(std::max(0.0, row.to_hand), 2), formatNumber(row.largest_step, 2),
               row.holds ? "yes" : "no", formatNanoseconds(row.tick_ns)});
  }
  return table.text("  ");
}

std::string limitsCsv(const std::vector<LoopLimit>& rows) {
  std::string text =
      "scene,renderer,device,hand,rate_Hz,delay,linear_N_per_m,budget_N_per_m,found_N_per_m,cycle_"
      "N,"
      "cycle_Hz,to_hand_J,largest_step_N,holds,tick_ns\n";
  for (const LoopLimit& row : rows) {
    text += row.what.scene + "," + row.what.renderer + "," + row.what.device + "," + row.what.hand +
            "," + formatNumber(row.what.rate, 9) + "," + std::to_string(row.what.delay);
    for (const double value : {row.linear, row.budget, row.found, row.cycle, row.frequency,
                               row.to_hand, row.largest_step}) {
      text += "," + formatNumber(value, 9);
    }
    text += std::string(row.holds ? ",1," : ",0,") + formatNumber(row.tick_ns, 9) + "\n";
  }
  return text;
}

std::string rateMap(const std::vector<LoopLimit>& rows, const Machine& machine) {
  Plot plot;
  plot.title = "Largest stable stiffness over the rate of the loop";
  plot.subtitle = "flat wall, constraint renderer, relaxed hand; " + machineText(machine);
  plot.x_label = "rate [Hz]";
  plot.y_label = "stiffness [N/m]";
  plot.series = {"found in the loop", "budget"};
  for (const LoopLimit& row : rows) {
    const int number = numberOf(plot.key, row.what.device);
    if (row.found > 0.0) plot.points.push_back({row.what.rate, row.found, number, 0});
    if (row.budget > 0.0) plot.points.push_back({row.what.rate, row.budget, number, 1});
  }
  plot.least_y = leastOf(plot.points);
  return plotSvg(plot);
}

std::string curvatureMap(const std::vector<CurvedLimit>& rows, const Machine& machine) {
  Plot plot;
  plot.title = "Largest stable stiffness over curvature times depth";
  plot.subtitle = rows.empty() ? machineText(machine)
                               : rows.front().limit.what.device + ", relaxed hand, 1 N, 1 kHz; " +
                                     machineText(machine);
  plot.x_label = "curvature times depth";
  plot.y_label = "stiffness [N/m]";
  plot.series = {"ball", "hollow"};
  for (const CurvedLimit& row : rows) {
    if (!(row.limit.found > 0.0)) continue;
    plot.points.push_back({row.curvature_depth, row.limit.found,
                           numberOf(plot.key, row.limit.what.renderer),
                           row.is_hollow ? std::size_t{1} : std::size_t{0}});
  }
  plot.least_y = leastOf(plot.points);
  return plotSvg(plot);
}

}  // namespace palpate::tools
