// Speed of baking fields, meshes and labels to bands, and bands to bricks, compared with OpenVDB's
// own tools in the same run. See README.md.

#include "bench/bake_bench.h"

#include <malloc.h>

#include <algorithm>
#include <cstdio>
#include <fstream>
#include <string>
#include <vector>

#include "bench/machine.h"
#include "palpate/core/error.h"
#include "write_results.h"

namespace palpate::vdb::bench {
namespace {

/// [bytes] The value of a line of /proc/self/status; 0 if there is no such line.
double statusOf(const std::string& key) {
  std::ifstream in("/proc/self/status");
  for (std::string line; std::getline(in, line);) {
    if (line.starts_with(key + ":")) return 1024.0 * std::stod(line.substr(key.size() + 1));
  }
  return 0.0;
}

/// Prints as the console reporter does, and keeps the shortest run of each benchmark.
class Results final : public benchmark::ConsoleReporter {
 public:
  void ReportRuns(const std::vector<Run>& runs) override {
    ConsoleReporter::ReportRuns(runs);
    for (const Run& run : runs) {
      if (run.run_type != Run::RT_Iteration || run.error_occurred) continue;
      const std::string name = run.run_name.function_name + "/" + run.run_name.args;
      const double seconds = run.real_accumulated_time / static_cast<double>(run.iterations);
      auto found = std::find_if(rows_.begin(), rows_.end(),
                                [&](const auto& row) { return row["name"] == name; });
      if (found == rows_.end()) {
        rows_.push_back({{"name", name}, {"seconds", seconds}});
        found = rows_.end() - 1;
      } else if (seconds >= (*found)["seconds"]) {
        continue;
      }
      nlohmann::ordered_json& row = *found;
      row["seconds"] = seconds;
      for (const auto& [key, counter] : run.counters) {
        // In the time column for one voxel or brick, Google Benchmark reports seconds.
        if (key == "per_voxel" || key == "per_brick") {
          row[key + "_ns"] = 1e9 * counter.value;
        } else {
          row[key] = counter.value;
        }
      }
    }
  }

  /// Adds to each row with two threads its speed-up over one thread, and prints that beside the
  /// speed-up of the control.
  void compareThreads() {
    std::string table;
    for (nlohmann::ordered_json& row : rows_) {
      const std::string name = row["name"];
      const std::string two = "threads:2";
      const std::size_t at = name.rfind(two);
      if (at == std::string::npos) continue;
      std::string alone = name;
      alone.replace(at, two.size(), "threads:1");
      const auto one = std::find_if(rows_.begin(), rows_.end(),
                                    [&](const auto& other) { return other["name"] == alone; });
      if (one == rows_.end()) continue;
      const double times = (*one)["seconds"].get<double>() / row["seconds"].get<double>();
      row["times_as_fast_as_one_thread"] = times;
      char line[160];
      std::snprintf(line, sizeof line, "  %-48s %5.2f\n", name.c_str(), times);
      table += line;
    }
    if (table.empty()) return;
    std::printf("\nTwo threads, times as fast as one (%s: no memory, what the machine gives)\n%s",
                kControl, table.c_str());
  }

  [[nodiscard]] nlohmann::ordered_json json(const tools::Machine& machine) const {
    return {{"schema", "palpate.bench_baking/1"},
            {"machine", palpate::bench::machineJson(machine)},
            {"runs", rows_}};
  }

 private:
  nlohmann::ordered_json rows_ = nlohmann::ordered_json::array();
};

int runAll(int count, char** arguments) {
  const std::string folder = palpate::bench::takeOption("write", count, arguments);
  benchmark::Initialize(&count, arguments);
  if (benchmark::ReportUnrecognizedArguments(count, arguments)) return 2;
  const tools::Machine machine = tools::thisMachine();
  if (!machine.optimized) std::fputs("warning: not optimized: times say nothing\n", stderr);
  Results results;
  benchmark::RunSpecifiedBenchmarks(&results);
  results.compareThreads();
  if (!folder.empty()) palpate::bench::write(results.json(machine), machine, folder, "-baking");
  return 0;
}

}  // namespace

void addPeak(benchmark::State& state, const std::function<Made()>& make) {
  malloc_trim(0);  // otherwise memory that earlier benchmarks left in the heap would be reused, and
                   // not be counted
  const double before = statusOf("VmRSS");
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the peak
  const Made made = make();
  const double memory = static_cast<double>(made.second);
  state.counters["memory_mb"] = 1e-6 * memory;
  state.counters["peak"] = (statusOf("VmHWM") - before) / memory;
}

}  // namespace palpate::vdb::bench

int main(int argc, char** argv) {
  try {
    return palpate::vdb::bench::runAll(argc, argv);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}
