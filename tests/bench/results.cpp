#include "results.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "rivals.h"
#include "write_results.h"

namespace palpate::bench {
namespace {

/// Two decimals: repetitions differ by more than that.
double rounded(double value) { return std::round(100.0 * value) / 100.0; }

std::string line(const std::string& sampler, const Times& t, const Times& yardstick) {
  std::vector<char> text(200);
  std::snprintf(text.data(), text.size(), "  %-42s %8.1f %8.1f   %5.2f %5.2f\n", sampler.c_str(),
                t.independent, t.dependent, t.independent / yardstick.independent,
                t.dependent / yardstick.dependent);
  return text.data();
}

}  // namespace

void Results::ReportRuns(const std::vector<Run>& runs) {
  for (const Run& run : runs) {
    if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
    const std::string name = run.run_name.function_name;
    const auto first = name.find('|');
    const auto last = name.rfind('|');
    Times& times = at(name.substr(0, first), name.substr(first + 1, last - first - 1));
    const double queries = run.counters.at("queries").value;
    const double ns =
        1e9 * run.real_accumulated_time / static_cast<double>(run.iterations) / queries;
    double& kept = name.substr(last + 1) == "dependent" ? times.dependent : times.independent;
    kept = kept > 0.0 ? std::min(kept, ns) : ns;
  }
}

Times& Results::at(const std::string& shape, const std::string& sampler) {
  auto found =
      std::find_if(shapes_.begin(), shapes_.end(), [&](const Shape& s) { return s.name == shape; });
  if (found == shapes_.end()) found = shapes_.insert(shapes_.end(), {shape, {}});
  auto& all = found->samplers;
  auto one =
      std::find_if(all.begin(), all.end(), [&](const auto& s) { return s.first == sampler; });
  if (one == all.end()) one = all.insert(all.end(), {sampler, {}});
  return one->second;
}

Times Results::yardstickOf(const Shape& shape) {
  for (const auto& [sampler, times] : shape.samplers) {
    if (sampler == kYardstick) return times;
  }
  return {};
}

std::string Results::table() const {
  std::string text;
  for (const Shape& shape : shapes_) {
    std::vector<char> heading(200);
    std::snprintf(heading.data(), heading.size(), "%-44s %8s %8s   %s\n", shape.name.c_str(),
                  "indep ns", "dep ns", "share of BoxStencil");
    text += heading.data();
    for (const auto& [sampler, times] : shape.samplers) {
      text += line(sampler, times, yardstickOf(shape));
    }
  }
  return text;
}

nlohmann::ordered_json Results::json(const tools::Machine& machine) const {
  nlohmann::ordered_json out = {{"schema", "palpate.bench_sampling/1"},
                                {"machine", machineJson(machine)},
                                {"shapes", nlohmann::ordered_json::array()}};
  for (const Shape& shape : shapes_) {
    nlohmann::ordered_json one = {{"shape", shape.name},
                                  {"samplers", nlohmann::ordered_json::array()}};
    const Times yardstick = yardstickOf(shape);
    for (const auto& [sampler, times] : shape.samplers) {
      nlohmann::ordered_json row = {{"sampler", sampler},
                                    {"independent_ns", rounded(times.independent)},
                                    {"dependent_ns", rounded(times.dependent)}};
      if (yardstick.independent > 0.0 && yardstick.dependent > 0.0) {
        row["share_of_box_stencil"] = {
            {"independent", rounded(times.independent / yardstick.independent)},
            {"dependent", rounded(times.dependent / yardstick.dependent)}};
      }
      one["samplers"].push_back(row);
    }
    out["shapes"].push_back(one);
  }
  return out;
}

}  // namespace palpate::bench
