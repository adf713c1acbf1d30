#include <algorithm>

#include "accuracy/accuracy_report.h"
#include "bench/machine_json.h"
#include "input_kind.h"
#include "loaded_scene.h"
#include "output_files.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.accuracy", std::move(message), std::move(hint)});
}

std::vector<vdb::Sampler> chosenSamplers(const std::vector<std::string>& names) {
  std::vector<vdb::Sampler> chosen;
  for (const vdb::Sampler sampler :
       {vdb::Sampler::kCubic, vdb::Sampler::kTrilinear, vdb::Sampler::kAccessor}) {
    if (names.empty() ||
        std::find(names.begin(), names.end(), samplerName(sampler)) != names.end()) {
      chosen.push_back(sampler);
    }
  }
  return chosen;
}

/// [m] The requested voxel sizes, the coarsest first and each once; empty if none was requested.
std::vector<double> askedVoxels(const AccuracyOptions& options, const LengthUnit& unit) {
  std::vector<double> voxels;
  const auto take = [&](std::string_view text, const char* what) {
    const double voxel = parseLength(text, unit, what);
    if (!(voxel > 0.0)) throw usageError(std::string(what) + " must be greater than 0");
    voxels.push_back(voxel);
  };
  for (const std::string& text : options.voxels) take(text, "--voxel");
  if (!options.ladder.empty()) {
    for (const std::string_view text : split(options.ladder, ',')) take(text, "--ladder");
  }
  std::sort(voxels.rbegin(), voxels.rend());
  voxels.erase(std::unique(voxels.begin(), voxels.end()), voxels.end());
  return voxels;
}

std::vector<double> defaultVoxels(const Field& field) {
  const Vec3 size = field.bounds().size();
  const double longest = std::max({size.x, size.y, size.z});
  return {longest / 32.0, longest / 64.0, longest / 128.0, longest / 256.0};
}

std::vector<AskedField> chosenFields(const AccuracyOptions& options, const Scene& scene) {
  std::vector<AskedField> chosen;
  const std::vector<std::string> every = {""};
  for (const std::string& name : options.fields.empty() ? every : options.fields) {
    for (AskedField& asked : chooseFields(scene, name, "accuracy.unknown_field")) {
      if (!asked.field->bounds().isBounded()) {
        throw inputError("accuracy.unbounded", "'" + asked.name + "' reaches to infinity",
                         "name others with --field, or cut it in the scene: {intersection: [it, a "
                         "box]}",
                         options.scene);
      }
      chosen.push_back(std::move(asked));
    }
  }
  if (chosen.empty()) {
    throw inputError("accuracy.no_layers", "the scene has no layers",
                     "name one of its fields with --field", options.scene);
  }
  return chosen;
}

void refuseIfNothingWasDone(const std::vector<FieldResult>& results) {
  std::string why;
  for (const FieldResult& result : results) {
    for (const Rung& rung : result.rungs) {
      if (rung.why.empty()) return;
      why = rung.why;
    }
  }
  throw inputError("accuracy.not_baked", "no grid could be made: " + why, "try smaller voxels");
}

}  // namespace

Report run(const AccuracyOptions& options, const GeneralOptions& general, Console& console) {
  if (inputKind(options.scene) != InputKind::kScene) {
    throw inputError("accuracy.kind", "only the fields of scenes can be compared with their grids",
                     "name the file in a scene: fields: {part: {mesh: {file: part.stl}}}",
                     options.scene);
  }
  OutputFiles files(general);
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) files.announce(path, {options.scene}, OutputFiles::Streams::kYes);
  }
  LoadedScene loaded(options.scene, console);
  const LengthUnit unit = loaded.unit();
  const std::vector<double> voxels = askedVoxels(options, unit);
  const Machine machine = thisMachine();
  if (!machine.optimized) {
    console.warn("this is a " + machine.build_type +
                 " build: its errors are valid, its times are not");
  }
  const ScenePtr scene = loaded.compile();
  const std::vector<AskedField> asked = chosenFields(options, *scene);

  std::vector<FieldResult> results;
  CacheFlood flood;
  const Progress progress = console.progress();
  for (std::size_t i = 0; i < asked.size(); ++i) {
    const AskedField& one = asked[i];
    if (!one.source.empty()) {
      console.note("'" + one.name + "' is a grid itself (" + one.source +
                   "): the comparison is with that grid, not with its source");
    }
    LadderSettings settings;
    settings.voxels = voxels.empty() ? defaultVoxels(*one.field) : voxels;
    settings.samplers = chosenSamplers(options.samplers);
    settings.points = static_cast<std::size_t>(options.points);
    settings.band = options.band;
    settings.repeats = options.repeats;
    settings.clock_ns = machine.clock_ns;
    const Progress inner = [&](std::string_view what, double fraction) {
      return progress(one.name + ": " + std::string(what),
                      (static_cast<double>(i) + fraction) / static_cast<double>(asked.size()));
    };
    results.push_back(measureLadder(one, settings, flood, inner));
  }
  refuseIfNothingWasDone(results);
  if (!options.csv.empty()) files.write(options.csv, accuracyCsv(results));
  if (!options.svg.empty()) files.write(options.svg, accuracySvg(results, unit, machine));
  checkStop();
  files.commit();

  Report out;
  out.json = {{"schema", "palpate.accuracy/1"},
              {"scene", options.scene},
              {"machine", machineJson(machine)},
              {"points", options.points},
              {"band_voxels", options.band},
              {"stroke_step_m", kStrokeStep},
              {"repeats", options.repeats},
              {"cold_sweep_bytes", flood.bytes()},
              {"results", Json::array()},
              {"csv", options.csv.empty() ? Json() : Json(options.csv)},
              {"svg", options.svg.empty() ? Json() : Json(options.svg)}};
  out.text = machineText(machine) + "\n" + formatCount(static_cast<std::uint64_t>(options.points)) +
             " random points within " + formatNumber(options.band, 3) +
             (options.band == 1.0 ? " voxel" : " voxels") +
             " of the surface; times are for value and gradient, the shortest of " +
             std::to_string(options.repeats) + " runs\n";
  for (const FieldResult& result : results) {
    out.json["results"].push_back(accuracyJson(result));
    out.text += "\n" + accuracyText(result, unit);
  }
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) out.text += "\nWritten  " + path + "\n";
  }
  return out;
}

}  // namespace palpate::tools
