#include <algorithm>
#include <thread>

#include "bench/contact_report.h"
#include "bench/machine_json.h"
#include "bench/servo_case.h"
#include "bench/stability_bench.h"
#include "input_kind.h"
#include "output_files.h"
#include "palpate/core/text.h"
#include "palpate/scene/scene_file.h"
#include "palpate/scene/suggestion.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.bench", std::move(message), std::move(hint)});
}

std::vector<const CaseEntry*> chosenCases(const std::vector<std::string>& names) {
  std::vector<const CaseEntry*> chosen;
  std::vector<std::string_view> known;
  for (const CaseEntry& entry : contactCases()) {
    known.push_back(entry.name);
    if (names.empty() || std::find(names.begin(), names.end(), entry.name) != names.end()) {
      chosen.push_back(&entry);
    }
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    throw usageError("the bench has no scene '" + name + "'",
                     suggestionFor(name, known, "it has " + joined(known)));
  }
  return chosen;
}

std::vector<RendererKind> chosenRenderers(const std::string& name) {
  if (name == "constraint") return {RendererKind::kConstraint};
  if (name == "paper") return {RendererKind::kPaper};
  return {RendererKind::kConstraint, RendererKind::kPaper};
}

std::vector<BenchRow> measureAll(const BenchOptions& options, Console& console) {
  const auto entries = chosenCases(options.scenes);
  const auto renderers = chosenRenderers(options.renderer);
  std::vector<BenchRow> rows;
  const auto total = static_cast<double>(entries.size());
  const Progress progress = console.progress();
  const MeasureSettings settings{options.repeats, options.paced, options.cold};
  std::optional<CacheFlood> flood;
  if (options.cold > 0) flood.emplace();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const CaseEntry& entry = *entries[i];
    const Progress inner = [&](std::string_view what, double fraction) {
      return progress(entry.name + ": " + std::string(what),
                      (static_cast<double>(i) + std::max(fraction, 0.0)) / total);
    };
    report(inner, "making the scene", 0.0);
    const ContactCase what = entry.make();
    for (const RendererKind kind : renderers) {
      BenchRow row{&entry, static_cast<int>(i + 1), kind};
      row.figures = measure(what, kind, settings, flood ? &*flood : nullptr, inner, row.why);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

Report servoReport(const BenchOptions& options, Console& console) {
  std::vector<double> rates = options.rates;
  if (rates.empty()) rates = {1000.0, 4000.0};
  std::vector<int> loads = {0, static_cast<int>(std::max(1U, std::thread::hardware_concurrency()))};
  if (options.load) loads = {*options.load};
  std::vector<ServoFigures> figures;
  for (const int load : loads) {
    for (const double rate : rates) {
      console.note(formatNumber(rate) + " Hz for " + formatSeconds(options.seconds) + " beside " +
                   std::to_string(load) + " busy threads");
      figures.push_back(measureServo(rate, load, options.seconds));
    }
  }
  const Machine machine = thisMachine();
  Report out;
  out.json = {{"schema", "palpate.bench/1"},
              {"bench", "servo"},
              {"machine", machineJson(machine)},
              {"seconds", options.seconds},
              {"results", servoJson(figures)}};
  out.text = machineText(machine) + "\n" + servoText(figures);
  for (const ServoFigures& f : figures) out.is_yes = out.is_yes && f.isGood();
  return out;
}

}  // namespace

Report run(const BenchOptions& options, const GeneralOptions& general, Console& console) {
  if (options.what == "stability") return runStabilityBench(options, general, console);
  const bool is_servo = options.what == "servo";
  if (options.what != "contact" && !is_servo) {
    throw usageError("there is no bench '" + options.what + "'",
                     "write palpate bench contact, stability or servo");
  }
  if (options.full || !options.devices.empty() || !options.curvature_svg.empty() ||
      (!is_servo && !options.rates.empty())) {
    throw usageError(
        "--full, --device, --rate and --curvature-svg do not apply to bench " + options.what,
        "write palpate bench stability");
  }
  if (is_servo) return servoReport(options, console);
  if (!options.renderer.empty() && options.renderer != "constraint" &&
      options.renderer != "paper") {
    throw usageError("bench contact has no renderer '" + options.renderer + "'",
                     "it has constraint and paper");
  }
  (void)chosenCases(options.scenes);
  OutputFiles files(general);
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) files.announce(path, {}, OutputFiles::Streams::kYes);
  }
  const Machine machine = thisMachine();
  if (!machine.optimized) {
    console.warn("this is a " + machine.build_type +
                 " build: its errors are valid, its times are not");
  }
  const std::vector<BenchRow> rows = measureAll(options, console);
  if (!options.csv.empty()) files.write(options.csv, csvText(rows));
  if (!options.svg.empty()) files.write(options.svg, svgText(rows, machine));
  checkStop();
  files.commit();

  Report out;
  out.json = {{"schema", "palpate.bench/1"},
              {"bench", "contact"},
              {"machine", machineJson(machine)},
              {"repeats", options.repeats},
              {"paced_ticks", options.paced},
              {"cold_ticks", options.cold},
              {"results", Json::array()},
              {"csv", options.csv.empty() ? Json() : Json(options.csv)},
              {"svg", options.svg.empty() ? Json() : Json(options.svg)}};
  for (const BenchRow& row : rows) out.json["results"].push_back(rowJson(row));
  out.text = machineText(machine) + "\nHot: shortest of " + std::to_string(options.repeats) +
             " runs for each tick. Paced: one tick a millisecond. Cold: after other data went "
             "through the caches.\nOf each time " +
             formatNumber(machine.clock_ns, 3) + " ns are for the clock\n\n" + tablesText(rows);
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) out.text += "\nWritten  " + path + "\n";
  }
  return out;
}

}  // namespace palpate::tools
