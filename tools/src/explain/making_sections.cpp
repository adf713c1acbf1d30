#include <optional>

#include "budget_report.h"
#include "explain/explain_sections.h"
#include "json_parts.h"
#include "map_coverage.h"
#include "open_device.h"
#include "palpate/devices/scene_budget.h"
#include "report_rows.h"
#include "saving.h"
#include "scene_parameters.h"
#include "text.h"
#include "wall_notes.h"

// Sections on the sources of a scene's parameters and fields, on notes about them, and on their
// cost.

namespace palpate::tools {

void addMaps(const Scene& scene, const SceneDescription& description, Report& report) {
  ReportRows rows({"parameter", "values", "from", "stored in", "off by at most"});
  for (const SceneParameter& found : sceneParameters(description)) {
    const std::string unit = found.unit == "1" ? "" : " " + found.unit;
    const vdb::MaterialGridPtr grid = found.grid();
    Json json = grid ? mapJson(*grid) : parameterJson(found.map);
    json["name"] = found.name();
    json["unit"] = found.unit;
    rows.add({found.name(), formatParameter(found.map) + unit, grid ? grid->info().source : "-",
              grid ? std::to_string(grid->info().quantisation.bits) + " bits, " +
                         formatBytes(grid->info().memory)
                   : "-",
              grid ? formatNumber(grid->info().quantisation.error, 2) + unit : "-"},
             std::move(json));
  }
  rows.writeTo(report, "maps", "Parameters that differ from place to place");
  report.json["map_gaps"] = Json::array();
  for (const MapGap& gap : mapGaps(description, scene)) {
    report.notes.push_back(gapText(gap, scene.lengthUnit(), scene.metersPerUnit()));
    report.text += "  " + report.notes.back() + "\n";
    report.json["map_gaps"].push_back({{"name", gap.parameter},
                                       {"source", gap.source},
                                       {"share", gap.share},
                                       {"away_m", gap.away},
                                       {"size_ratio", gap.size_ratio}});
  }
}

void addWallNotes(const Scene& scene, Report& report) {
  report.json["contrasts"] = Json::array();
  report.json["shading_gaps"] = Json::array();
  std::string notes;
  for (WallNote& note : wallNotes(scene)) {
    notes += "  " + note.text + "\n";
    report.notes.push_back(note.text);
    report.json[note.code == "scene.contrast" ? "contrasts" : "shading_gaps"].push_back(
        std::move(note.json));
  }
  if (!notes.empty()) report.text += "\nOf the walls\n" + notes;
}

void addStability(const Scene& scene, const DeviceOptions& device, double rate, Report& report) {
  report.json["loop"] = deviceJson(device, rate);
  report.json["hand_limits"] = Json::array();
  report.json["budget"] = Json::array();
  const auto simulation = simulationOf(device, rate);
  if (!simulation) return;
  const devices::LoopModel loop = loopOf(*simulation);
  const auto items = devices::sceneBudget(scene, loop);
  report.json["hand_limits"] = handLimitsJson(loop);
  report.json["budget"] = budgetJson(items);
  const std::string at = "at " + formatNumber(rate) + " Hz" + delayText(simulation->delay);
  report.tables.push_back({"What is felt, at the hand, beside what " + device.name + " holds " + at,
                           budgetTable(items).rows()});
  report.tables.push_back({"Walls without damping that it holds", handLimitsTable(loop).rows()});
  report.text += "\nStability " + at + "\n" + deviceText(device) + handLimitsText(loop) +
                 "What is felt, at the hand in N/m or N.s/m\n" + budgetText(items);
}

void addSources(const Scene& scene, const LoadedScene& loaded, Report& report) {
  const SceneDescription& description = loaded.description();
  ReportRows rows({"field or layer", "made from", "made"});
  const auto add = [&](const std::string& name, const FieldSource& from,
                       const std::string& left_out) {
    if (from.summary().empty()) return;
    const std::string why = left_out.empty() ? "nothing needs it" : left_out;
    const bool is_made = from.isMade() || from.part();
    const bool is_cut = !from.isMade() && from.part() && !from.part()->bounds().isBounded();
    rows.add({name, from.summary(),
              !is_made ? "no: " + why
              : is_cut ? "what the device reaches"
                       : "yes"},
             {{"name", name},
              {"source", from.summary()},
              {"made", is_made},
              {"only_in_reach", is_cut},
              {"why_not", is_made ? Json() : Json(why)}});
  };
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    add(description.layers[i].name, *description.layers[i].inside, scene.regions()[i + 1].left_out);
  }
  for (const auto& field : description.fields) add(field.name, *field.source, {});
  rows.writeTo(report, "sources", "Made for this scene");
  report.json["grids"] = loaded.gridsJson();
  const std::string grids = loaded.gridsText();
  if (!grids.empty()) report.text += "\nGrids\n" + grids;
  const std::optional<Saving> saving = savingOf(loaded, scene);
  report.json["saved_estimate"] =
      saving ? Json{{"memory_bytes", saving->bytes}, {"seconds", saving->seconds}} : Json();
  if (saving) {
    report.text +=
        "\nSaved by leaving these out, estimated from their boxes and the grids above: " +
        formatBytes(saving->bytes) + ", " + formatSeconds(saving->seconds) + "\n";
  }
}

void addMeasured(const std::string& file, Console& console, Report& report) {
  const Saving whole = costOf(file, Purpose::kShow, console);
  const Saving needed = costOf(file, Purpose::kTouch, console);
  const auto json = [](const Saving& cost) {
    return Json{{"memory_bytes", cost.bytes}, {"seconds", cost.seconds}};
  };
  report.json["measured"] = {{"whole", json(whole)}, {"needed", json(needed)}};
  Table costs({"measured", "grids in the loop", "read and made in"});
  costs.add({"all of it", formatBytes(whole.bytes), formatSeconds(whole.seconds)});
  costs.add({"what is needed", formatBytes(needed.bytes), formatSeconds(needed.seconds)});
  report.text += "\nWhat a touch needs, compared with all of it\n" + costs.text("  ");
}

}  // namespace palpate::tools
