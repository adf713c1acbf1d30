#include "bench/stability_bench.h"

#include <algorithm>
#include <map>
#include <optional>

#include "bench/guards_time.h"
#include "bench/loop_report.h"
#include "bench/machine_json.h"
#include "output_files.h"
#include "palpate/core/text.h"
#include "palpate/devices/device_presets.h"
#include "palpate/scene/scene_file.h"
#include "palpate/scene/suggestion.h"
#include "palpate/scene/units.h"
#include "support/loops/loop_limit.h"
#include "text.h"

namespace palpate::tools {
namespace {

using namespace loops;

const std::vector<std::string> kDevices = {"excalibur", "falcon", "touch", "omega_3"};
// The choice for quick runs: devices that differ most.
const std::vector<std::string> kFewDevices = {"falcon", "touch"};
const std::vector<std::string> kFewScenes = {"flat",      "ball-20",   "hollow-5",    "edge-within",
                                             "groove-10", "two-balls", "friction-0.8"};

Error unknown(const char* what, const std::string& name, const std::vector<std::string>& known) {
  return Error(ErrorKind::kUsage,
               {"usage.bench", "the bench has no " + std::string(what) + " '" + name + "'",
                suggestionFor(name, known, "it has " + joined(known))});
}

/// The requested names, or `all` if none was requested.
std::vector<std::string> chosen(const char* what, const std::vector<std::string>& asked,
                                const std::vector<std::string>& all) {
  for (const std::string& name : asked) {
    if (std::find(all.begin(), all.end(), name) == all.end()) throw unknown(what, name, all);
  }
  return asked.empty() ? all : asked;
}

std::vector<std::string> sceneNames() {
  std::vector<std::string> names;
  for (const HardScene& scene : hardScenes()) names.push_back(scene.name);
  return names;
}

const HardScene& sceneNamed(const std::string& name) {
  const auto& all = hardScenes();
  return *std::find_if(all.begin(), all.end(),
                       [&](const HardScene& scene) { return scene.name == name; });
}

/// Runs the rows. Rows of one scene share its compiled scene, and rows of one renderer share the
/// renderer.
class Runner {
 public:
  explicit Runner(Progress progress) : progress_(std::move(progress)) {}

  std::optional<LoopLimit> run(const LoopCase& what, const HardScene& scene, double fraction) {
    checkStop();
    report(progress_, what.scene + ": " + what.renderer + " on " + what.device, fraction);
    if (!canRender(what.renderer, scene)) return std::nullopt;
    if (scene_ == nullptr || scene_name_ != scene.name) {
      renderers_.clear();
      scene_ = compileHardScene(scene);
      scene_name_ = scene.name;
    }
    std::unique_ptr<HapticRenderer>& renderer = renderers_[what.renderer];
    if (!renderer) renderer = makeLoopRenderer(what.renderer, scene_);
    return findLimit(what, scene, *renderer, checkStop);
  }

 private:
  Progress progress_;
  ScenePtr scene_;
  std::string scene_name_;
  std::map<std::string, std::unique_ptr<HapticRenderer>> renderers_;
};

std::vector<LoopLimit> overRates(Runner& runner) {
  std::vector<LoopLimit> rows;
  for (const std::string& device : kDevices) {
    for (const double rate : {500.0, 1000.0, 2000.0, 4000.0, 10000.0}) {
      const LoopCase what{"flat", "constraint", device, "relaxed", rate};
      if (const auto row = runner.run(what, sceneNamed("flat"), -1.0)) rows.push_back(*row);
    }
  }
  return rows;
}

std::vector<CurvedLimit> overCurvature(Runner& runner) {
  std::vector<CurvedLimit> rows;
  for (const double radius : {50e-3, 20e-3, 10e-3, 5e-3, 2e-3, 1e-3, 0.5e-3}) {
    for (const bool is_hollow : {false, true}) {
      const HardScene scene = ballScene(radius, is_hollow);
      for (const char* renderer : {"constraint", "paper", "tangent-tracking"}) {
        const LoopCase what{scene.name, renderer, "falcon"};
        const auto row = runner.run(what, scene, -1.0);
        if (!row) continue;
        const double depth = row->found > 0.0 ? 1.0 / row->found : 0.0;  // [m] depth at 1 N
        rows.push_back({*row, depth / radius, is_hollow});
      }
    }
  }
  return rows;
}

}  // namespace

Report runStabilityBench(const BenchOptions& options, const GeneralOptions& general,
                         Console& console) {
  auto scenes = chosen("scene", options.scenes, sceneNames());
  if (options.scenes.empty() && !options.full) scenes = kFewScenes;
  const std::vector<std::string> one = options.renderer.empty()
                                           ? std::vector<std::string>{}
                                           : std::vector<std::string>{options.renderer};
  const auto renderers = chosen("renderer", one, loopRenderers());
  auto names = options.devices;
  if (names.empty()) names = options.full ? kDevices : kFewDevices;
  for (const std::string& name : names) (void)devices::devicePreset(name);
  std::vector<double> rates = options.rates;
  if (rates.empty()) rates.push_back(1000.0);
  if (options.rates.empty() && options.full) rates.insert(rates.end(), {4000.0, 10000.0});
  OutputFiles files(general);
  for (const std::string& path : {options.csv, options.svg, options.curvature_svg}) {
    if (!path.empty()) files.announce(path, {}, OutputFiles::Streams::kYes);
  }
  const Machine machine = thisMachine();
  if (!machine.optimized) {
    console.warn("this is a " + machine.build_type + " build: its times are not valid");
  }

  Runner runner(console.progress());
  std::vector<LoopLimit> rows;
  const auto total = static_cast<double>(scenes.size() * renderers.size() * names.size());
  double done = 0.0;
  for (const std::string& scene : scenes) {
    for (const std::string& renderer : renderers) {
      for (const std::string& device : names) {
        for (const double rate : rates) {
          const LoopCase what{scene, renderer, device, "relaxed", rate};
          if (const auto row = runner.run(what, sceneNamed(scene), done / total)) {
            rows.push_back(*row);
          }
        }
        done += 1.0;
      }
    }
  }
  if (!options.csv.empty()) files.write(options.csv, limitsCsv(rows));
  if (!options.svg.empty()) files.write(options.svg, rateMap(overRates(runner), machine));
  if (!options.curvature_svg.empty()) {
    files.write(options.curvature_svg, curvatureMap(overCurvature(runner), machine));
  }
  checkStop();
  files.commit();

  const double guards_ns = guardsTime();
  const auto or_null = [](const std::string& path) { return path.empty() ? Json() : Json(path); };
  Report out;
  out.json = {{"schema", "palpate.bench/1"},     {"bench", "stability"},
              {"machine", machineJson(machine)}, {"guards_ns", guards_ns},
              {"results", Json::array()},        {"csv", or_null(options.csv)},
              {"svg", or_null(options.svg)},     {"curvature_svg", or_null(options.curvature_svg)}};
  for (const LoopLimit& row : rows) out.json["results"].push_back(limitJson(row));
  out.text = machineText(machine) +
             "\nA relaxed hand presses with 1 N. Found: the stiffest wall on which it comes to "
             "rest. Above: the swing 15 % above that.\nAt it: on a wall of the budget, or of what "
             "was found if that is less\n\n" +
             limitsTable(rows) + "\nCoupling and passivity controller together take " +
             formatNanoseconds(guards_ns) + " a tick\n";
  for (const std::string& path : {options.csv, options.svg, options.curvature_svg}) {
    if (!path.empty()) out.text += "\nWritten  " + path + "\n";
  }
  return out;
}

}  // namespace palpate::tools
