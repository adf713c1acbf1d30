#include <algorithm>

#include "bench/contact_case.h"
#include "bench/machine_json.h"
#include "bench/measure.h"
#include "bench/plot.h"
#include "input_kind.h"
#include "output_files.h"
#include "palpate/scene/scene_file.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.bench", std::move(message), std::move(hint)});
}

struct Row {
  const CaseEntry* entry = nullptr;
  int number = 0;  ///< of the case, from 1
  RendererKind renderer = RendererKind::kConstraint;
  std::optional<Measurement> figures = {};
  std::string why = {};  ///< there are no figures
};

const char* nameOf(RendererKind kind) {
  return kind == RendererKind::kPaper ? "paper" : "constraint";
}

std::vector<const CaseEntry*> chosenCases(const std::vector<std::string>& names) {
  std::vector<const CaseEntry*> chosen;
  std::vector<std::string_view> known;
  std::string list;
  for (const CaseEntry& entry : contactCases()) {
    known.push_back(entry.name);
    list += (list.empty() ? "" : ", ") + entry.name;
    if (names.empty() || std::find(names.begin(), names.end(), entry.name) != names.end()) {
      chosen.push_back(&entry);
    }
  }
  for (const std::string& name : names) {
    if (std::find(known.begin(), known.end(), name) != known.end()) continue;
    const std::string close = suggest(name, known);
    throw usageError("the bench has no scene '" + name + "'",
                     close.empty() ? "it has " + list : "did you mean '" + close + "'?");
  }
  return chosen;
}

std::vector<RendererKind> chosenRenderers(const std::string& name) {
  if (name == "constraint") return {RendererKind::kConstraint};
  if (name == "paper") return {RendererKind::kPaper};
  return {RendererKind::kConstraint, RendererKind::kPaper};
}

std::vector<Row> measureAll(const BenchOptions& options, Console& console) {
  const auto entries = chosenCases(options.scenes);
  const auto renderers = chosenRenderers(options.renderer);
  std::vector<Row> rows;
  const auto total = static_cast<double>(entries.size());
  const Progress progress = console.progress();
  for (std::size_t i = 0; i < entries.size(); ++i) {
    const CaseEntry& entry = *entries[i];
    const Progress inner = [&](std::string_view what, double fraction) {
      return progress(entry.name + ": " + std::string(what),
                      (static_cast<double>(i) + std::max(fraction, 0.0)) / total);
    };
    report(inner, "making the scene", 0.0);
    const ContactCase what = entry.make();
    for (const RendererKind kind : renderers) {
      Row row{&entry, static_cast<int>(i + 1), kind};
      row.figures = measure(what, kind, options.repeats, inner, row.why);
      rows.push_back(std::move(row));
    }
  }
  return rows;
}

Json spreadJson(const Spread& spread) { return {{"rms", spread.rms}, {"max", spread.most}}; }

Json rowJson(const Row& row) {
  Json json = {
      {"scene", row.entry->name}, {"about", row.entry->about}, {"renderer", nameOf(row.renderer)}};
  if (!row.figures) {
    json["why_not"] = row.why;
    return json;
  }
  const Measurement& m = *row.figures;
  json["ticks"] = m.ticks;
  json["judged"] = m.judged;
  json["missed"] = m.missed;
  json["tick_ns"] = {{"median", m.median}, {"p99", m.p99}, {"p99.9", m.p999}, {"max", m.most}};
  json["direction_error_degrees"] = spreadJson(m.direction);
  json["magnitude_error"] = spreadJson(m.magnitude);
  json["force_error"] = spreadJson(m.error);
  json["largest_step_N"] = m.step;
  json["true_largest_step_N"] = m.true_step ? Json(*m.true_step) : Json();
  json["largest_turn_degrees"] = m.turn;
  json["true_largest_turn_degrees"] = m.true_turn ? Json(*m.true_turn) : Json();
  return json;
}

/// Round numbers that read well beside one another, and read back within their digits.
std::string brief(double value) { return formatNumber(value, 2); }

std::string optional(const std::optional<double>& value, int digits, const char* otherwise) {
  return value ? formatNumber(*value, digits) : otherwise;
}

std::string tableText(const std::vector<Row>& rows) {
  Table table({"scene", "renderer", "ticks", "median ns", "p99", "p99.9", "max", "dir deg rms",
               "max", "mag rms", "max", "missed", "step N", "true", "turn deg", "true"});
  std::string refused;
  for (const Row& row : rows) {
    if (!row.figures) {
      refused += "  " + row.entry->name + ", " + nameOf(row.renderer) + ": " + row.why + "\n";
      continue;
    }
    const Measurement& m = *row.figures;
    const auto ns = [](double value) { return formatNumber(value, 6); };
    table.add({row.entry->name, nameOf(row.renderer), std::to_string(m.ticks), ns(m.median),
               ns(m.p99), ns(m.p999), ns(m.most), brief(m.direction.rms), brief(m.direction.most),
               brief(m.magnitude.rms), brief(m.magnitude.most), std::to_string(m.missed),
               formatNumber(m.step, 3), optional(m.true_step, 3, "-"), formatNumber(m.turn, 4),
               optional(m.true_turn, 4, "-")});
  }
  std::string text = table.empty() ? "" : table.text("");
  if (!refused.empty()) text += "\nNot done\n" + refused;
  return text;
}

std::string csvText(const std::vector<Row>& rows) {
  std::string text =
      "scene,renderer,ticks,judged,missed,median_ns,p99_ns,p99.9_ns,max_ns,direction_rms_degrees,"
      "direction_max_degrees,magnitude_rms,magnitude_max,force_error_rms,force_error_max,"
      "largest_step_N,true_largest_step_N,largest_turn_degrees,true_largest_turn_degrees\n";
  for (const Row& row : rows) {
    if (!row.figures) continue;
    const Measurement& m = *row.figures;
    text += row.entry->name + "," + nameOf(row.renderer);
    for (const std::size_t count : {m.ticks, m.judged, m.missed})
      text += "," + std::to_string(count);
    for (const double value :
         {m.median, m.p99, m.p999, m.most, m.direction.rms, m.direction.most, m.magnitude.rms,
          m.magnitude.most, m.error.rms, m.error.most, m.step}) {
      text += "," + formatNumber(value, 9);
    }
    text += "," + optional(m.true_step, 9, "");
    text += "," + formatNumber(m.turn, 9);
    text += "," + optional(m.true_turn, 9, "") + "\n";
  }
  return text;
}

std::string svgText(const std::vector<Row>& rows, const Machine& machine) {
  Plot plot;
  plot.title = "Contact: error against time";
  plot.subtitle = machineText(machine);
  plot.x_label = "median time of a tick [ns]";
  plot.y_label = "RMS error of the force, share of the true force (0 is drawn at the bottom)";
  plot.series = {"constraint", "paper"};
  for (const Row& row : rows) {
    if (static_cast<std::size_t>(row.number) > plot.key.size()) plot.key.push_back(row.entry->name);
    if (!row.figures) continue;
    plot.points.push_back({row.figures->median, row.figures->error.rms, row.number,
                           row.renderer == RendererKind::kPaper ? std::size_t{1} : std::size_t{0}});
  }
  return plotSvg(plot);
}

}  // namespace

Report run(const BenchOptions& options, const GeneralOptions& general, Console& console) {
  if (options.what != "contact") {
    throw usageError("there is no bench '" + options.what + "'", "write palpate bench contact");
  }
  (void)chosenCases(options.scenes);
  OutputFiles files(general);
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) files.announce(path, {}, OutputFiles::Streams::kYes);
  }
  const Machine machine = thisMachine();
  if (!machine.optimised) {
    console.warn("this is a " + machine.build_type +
                 " build: its errors are those of any other, its times say nothing");
  }
  const std::vector<Row> rows = measureAll(options, console);
  if (!options.csv.empty()) files.write(options.csv, csvText(rows));
  if (!options.svg.empty()) files.write(options.svg, svgText(rows, machine));
  checkStop();
  files.commit();

  Report out;
  out.json = {{"schema", "palpate.bench/1"},
              {"bench", "contact"},
              {"machine", machineJson(machine)},
              {"repeats", options.repeats},
              {"results", Json::array()},
              {"csv", options.csv.empty() ? Json() : Json(options.csv)},
              {"svg", options.svg.empty() ? Json() : Json(options.svg)}};
  for (const Row& row : rows) out.json["results"].push_back(rowJson(row));
  out.text = machineText(machine) + "\nShortest of " + std::to_string(options.repeats) +
             " runs for each tick, " + formatNumber(machine.clock_ns, 3) +
             " ns of it for the clock\n\n" + tableText(rows);
  for (const std::string& path : {options.csv, options.svg}) {
    if (!path.empty()) out.text += "\nWritten  " + path + "\n";
  }
  return out;
}

}  // namespace palpate::tools
