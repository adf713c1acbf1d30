#include <algorithm>

#include "budget_report.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "map_coverage.h"
#include "open_device.h"
#include "output_files.h"
#include "palpate/core/error.h"
#include "palpate/devices/scene_budget.h"
#include "palpate/interior/port_machine.h"
#include "palpate/scene/transitions.h"
#include "saving.h"
#include "scene_parameters.h"
#include "text.h"
#include "transition_graph.h"
#include "verbs.h"
#include "wall_notes.h"

namespace palpate::tools {
namespace {

const Material* materialOf(const Scene& scene, int index) {
  return index < 0 ? nullptr : &scene.materials()[static_cast<std::size_t>(index)];
}

std::string wallText(const Scene& scene, const Wall& wall) {
  if (wall.absent) return "absent";
  const Material* m = materialOf(scene, wall.material);
  return m == nullptr ? "-" : m->name + " (" + formatParameter(m->stiffness) + " N/m)";
}

Json wallJson(const Scene& scene, const Wall& wall) {
  const Material* m = wall.absent ? nullptr : materialOf(scene, wall.material);
  return {{"absent", wall.absent}, {"material", m == nullptr ? Json() : materialJson(*m)}};
}

const PortDescription* describedPort(const SceneDescription& description, const std::string& name) {
  for (const auto& port : description.ports) {
    if (port.name == name) return &port;
  }
  return nullptr;
}

/// Where and when a port is open, in words.
std::vector<std::string> conditions(const Transition& t, const Scene& scene,
                                    const SceneDescription& description) {
  std::vector<std::string> all;
  if (!t.port) return all;
  const Port& port = scene.ports()[*t.port];
  const PortDescription* described = describedPort(description, port.name);
  if (!port.on.empty()) {
    all.push_back("on " + (described != nullptr && !described->on_name.empty()
                               ? described->on_name
                               : std::string("one face")));
  }
  if (port.mask >= 0) all.emplace_back("within its extent");
  for (const PassedBefore& before : port.after) {
    all.push_back("after " + scene.ports()[before.port].name);
    if (before.times > 1) all.back() += " " + std::to_string(before.times) + " times";
  }
  if (t.force != 0.0) {
    all.push_back("pressed with " + formatParameter(t.force) + " N");
    if (port.hole_radius > 0.0 && port.reopens_at.range().least < t.force.range().most) {
      all.back() += " (in a hole: " + formatParameter(port.reopens_at) + " N)";
    }
    if (port.rate.ratio != 1.0) {
      all.back() += " (by a fast hand: " + formatNumber(port.rate.ratio) + " times as much)";
    }
  }
  return all;
}

std::string joined(const std::vector<std::string>& parts) {
  std::string text;
  for (const auto& part : parts) text += (text.empty() ? "" : ", ") + part;
  return text.empty() ? "always" : text;
}

const char* directionName(PortDirection direction) {
  switch (direction) {
    case PortDirection::kBoth:
      return "both";
    case PortDirection::kIn:
      return "in";
    case PortDirection::kOut:
      return "out";
  }
  return "";
}

const char* reachName(Reach reach) {
  switch (reach) {
    case Reach::kNo:
      return "no";
    case Reach::kUndecided:
      return "undecided";
    case Reach::kYes:
      return "yes";
  }
  return "";
}

/// Why the probe cannot get into a region.
std::string whyUnreachable(const Scene& scene, RegionId region) {
  bool touched = false;
  std::string closed;
  for (std::size_t i = 0; i < scene.regions().size(); ++i) {
    const auto from = static_cast<RegionId>(i);
    if (!scene.touches(from, region)) continue;
    touched = true;
    for (const PortId id : scene.passages().portsOf(from)) {
      if (scene.ports()[id].leads(from, region)) {
        closed += (closed.empty() ? "" : ", ") + scene.ports()[id].name;
      }
    }
  }
  if (!scene.regions()[region].has_seed) {
    return "no point of it was found: later layers cover it, or it is very small";
  }
  if (!touched) return "it touches no other region";
  if (closed.empty()) return "no port leads into it";
  return "its ports (" + closed +
         ") start in regions that cannot be reached either, or what they come after is never "
         "passed when they could be";
}

std::string contentText(const Material& content) {
  std::string text = content.name + " (" + formatParameter(content.viscosity) + " N.s/m";
  const auto add = [&](const Parameter& parameter, const char* what, const char* unit) {
    if (parameter.range().most > 0.0) text += what + formatParameter(parameter) + unit;
  };
  add(content.lattice.force, ", lattice ", " N");
  add(content.cutting, ", cut by ", " N");
  add(content.shaft.in.kinetic_force, ", holds a shaft by ", " N/m");
  add(content.shaft.lateral.stiffness, ", sideways by ", " N/m^2");
  return text + ")";
}

/// The table of transitions as a picture.
std::string graphOf(const Scene& scene, const SceneDescription& description,
                    const std::string& title) {
  std::vector<GraphState> states;
  for (std::size_t i = 0; i < scene.regions().size(); ++i) {
    const Region& region = scene.regions()[i];
    const Material* content = materialOf(scene, region.content);
    states.push_back({region.name,
                      !region.reachable    ? "cannot be reached"
                      : content == nullptr ? std::string()
                                           : content->name,
                      i == scene.startRegion(), region.reachable});
  }
  std::vector<GraphArrow> arrows;
  for (const Transition& t : transitions(scene)) {
    GraphArrow arrow{t.from, t.to, {}, !t.port};
    arrow.label.push_back(t.port ? scene.ports()[*t.port].name : "no wall");
    for (std::string& condition : conditions(t, scene, description)) {
      arrow.label.push_back(std::move(condition));
    }
    arrows.push_back(std::move(arrow));
  }
  return transitionSvg(title, states, arrows);
}

}  // namespace

Report run(const ExplainOptions& options, const GeneralOptions& general, Console& console) {
  const double rate = options.rate.value_or(1000.0);
  const auto simulation = simulationOf(options.device, rate);
  if (options.rate && !simulation) {
    throw Error(ErrorKind::kUsage, {"usage.explain", "--rate is of a device", "add --device NAME"});
  }
  OutputFiles files(general);
  if (!options.svg.empty())
    files.announce(options.svg, {options.scene}, OutputFiles::Streams::kYes);
  LoadedScene loaded(options.scene, console);
  const ScenePtr compiled = loaded.compile(Purpose::kTouch);
  const Scene& scene = *compiled;
  const SceneDescription& description = loaded.description();
  const auto regions = scene.regions();
  const double unit = scene.metresPerUnit();

  Report report;
  report.json = {{"schema", "palpate.explain/1"},
                 {"scene", options.scene},
                 {"length_unit", scene.lengthUnit()},
                 {"renderer", scene.renderer() == RendererKind::kPaper ? "paper" : "constraint"},
                 {"start", regions[scene.startRegion()].name},
                 {"memory", scene.keepsMemory() ? "keep" : "until outside"}};

  const DeviceMapping& device = scene.device();
  const Box3 reach = device.reach();
  const Mat3& axes = device.rotation;
  report.json["device"] = {
      {"offset", vectorJson(device.offset / unit)},
      {"axes", Json::array({vectorJson(axes[0]), vectorJson(axes[1]), vectorJson(axes[2])})},
      {"scale", device.scale},
      {"force", device.force},
      {"stiffness_at_hand", device.stiffnessAtHand()},
      {"clutch", device.clutch},
      {"reach", reach.isBounded()
                    ? Json::array({vectorJson(reach.lo / unit), vectorJson(reach.hi / unit)})
                    : Json()}};

  report.text = options.scene + ": the probe starts in " + regions[scene.startRegion()].name +
                "; renderer " + report.json["renderer"].get<std::string>() + "; lengths in " +
                scene.lengthUnit() + "\n";
  if (reach.isBounded()) {
    report.text += "The device reaches from " + formatVector(reach.lo / unit) + " to " +
                   formatVector(reach.hi / unit) + "\n";
  }
  if (axes != Mat3(1.0)) {
    report.text += "The device's x, y and z point along " + formatDirection(axes[0]) + ", " +
                   formatDirection(axes[1]) + " and " + formatDirection(axes[2]) + "\n";
  }
  if (device.stiffnessAtHand() != 1.0) {
    report.text += "At the hand a stiffness is " + formatNumber(device.stiffnessAtHand(), 4) +
                   " times that of the scene\n";
  }
  report.text += "\n";

  report.json["regions"] = Json::array();
  Table region_table({"region", "made from", "content", "wall", "can be entered", "a point of it"});
  std::string unreachable;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region& r = regions[i];
    const Material* content = materialOf(scene, r.content);
    const std::string source = i == kOutside ? "-" : r.source.empty() ? "formula" : r.source;
    region_table.add({r.name, source, content == nullptr ? "-" : contentText(*content),
                      i == kOutside ? "-" : wallText(scene, {r.wall_absent, r.wall}),
                      r.reach == Reach::kNo ? "NO" : reachName(r.reach),
                      r.has_seed ? formatVector(r.seed / unit, 3) : "-"});
    Json json = {{"name", r.name},
                 {"source", source},
                 {"left_out", r.left_out.empty() ? Json() : Json(r.left_out)},
                 {"content", content == nullptr ? Json() : materialJson(*content)},
                 {"reachable", r.reachable},
                 {"reach", reachName(r.reach)},
                 {"seed", r.has_seed ? vectorJson(r.seed / unit) : Json()}};
    if (!r.reachable) {
      const std::string why =
          r.left_out.empty() ? whyUnreachable(scene, static_cast<RegionId>(i)) : r.left_out;
      json["why_unreachable"] = why;
      unreachable += "  " + r.name + ": " + why + "\n";
    }
    report.json["regions"].push_back(std::move(json));
  }
  report.text += "Regions (outermost first)\n" + region_table.text("  ");
  if (!unreachable.empty()) report.text += "\nThe probe can never get into\n" + unreachable;

  report.json["walls"] = Json::array();
  Table wall_table({"between", "and", "felt from the first", "felt from the second"});
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = i + 1; j < regions.size(); ++j) {
      const auto a = static_cast<RegionId>(i);
      const auto b = static_cast<RegionId>(j);
      if (!scene.touches(a, b)) continue;
      const Wall& from_a = scene.passages().wall(a, b);
      const Wall& from_b = scene.passages().wall(b, a);
      wall_table.add(
          {regions[a].name, regions[b].name, wallText(scene, from_a), wallText(scene, from_b)});
      report.json["walls"].push_back({{"between", Json::array({regions[a].name, regions[b].name})},
                                      {"from_first", wallJson(scene, from_a)},
                                      {"from_second", wallJson(scene, from_b)}});
    }
  }
  report.text += "\nWalls (between regions that touch)\n" + wall_table.text("  ");

  report.json["sheets"] = Json::array();
  Table sheet_table({"sheet", "wall", "extent", "ports"});
  for (const Sheet& sheet : scene.passages().sheets()) {
    std::string openings;
    for (const Port& port : scene.ports()) {
      if (port.sheet < 0) continue;
      if (&scene.passages().sheets()[static_cast<std::size_t>(port.sheet)] != &sheet) continue;
      openings += (openings.empty() ? "" : ", ") + port.name;
    }
    sheet_table.add({sheet.name, wallText(scene, {false, sheet.material}),
                     sheet.mask < 0 ? "all of its surface" : "limited",
                     openings.empty() ? "-" : openings});
    report.json["sheets"].push_back({{"name", sheet.name},
                                     {"where", sheet.mask >= 0},
                                     {"wall", wallJson(scene, {false, sheet.material})}});
  }
  if (!sheet_table.empty()) {
    report.text += "\nSheets (the same region on both sides)\n" + sheet_table.text("  ");
  }

  report.json["ports"] = Json::array();
  for (std::size_t id = 0; id < scene.ports().size(); ++id) {
    const Port& port = scene.ports()[id];
    const PortDescription* described = describedPort(description, port.name);
    Json json = {{"name", port.name}};
    json["between"] = described == nullptr || port.sheet >= 0
                          ? Json()
                          : Json::array({described->from, described->to});
    json["sheet"] =
        port.sheet < 0 ? Json()
                       : Json(scene.passages().sheets()[static_cast<std::size_t>(port.sheet)].name);
    json["reach"] = reachName(scene.reachOf(static_cast<PortId>(id)));
    json["on"] =
        described == nullptr || described->on_name.empty() ? Json() : Json(described->on_name);
    json["where"] = port.mask >= 0;
    json["direction"] = directionName(port.direction);
    json["after"] = Json::array();
    json["after_times"] = Json::array();
    for (const PassedBefore& before : port.after) {
      json["after"].push_back(scene.ports()[before.port].name);
      json["after_times"].push_back(before.times);
    }
    json["opens_at_N"] = parameterJson(port.opens_at);
    json["back_N"] = parameterJson(port.back);
    json["hole"] = port.hole_radius > 0.0 ? Json{{"radius_m", port.hole_radius},
                                                 {"reopens_at_N", parameterJson(port.reopens_at)}}
                                          : Json();
    json["rate"] = port.rate.ratio != 1.0
                       ? Json{{"ratio", port.rate.ratio}, {"speed_m_per_s", port.rate.speed}}
                       : Json();
    json["rearm_m"] = port.rearm;
    report.json["ports"].push_back(std::move(json));
  }

  report.json["transitions"] = Json::array();
  Table move_table({"from", "through", "to", "direction", "open when"});
  for (const Transition& t : transitions(scene)) {
    const auto when = conditions(t, scene, description);
    const Port* port = t.port ? &scene.ports()[*t.port] : nullptr;
    move_table.add({regions[t.from].name, port == nullptr ? "(no wall)" : port->name,
                    regions[t.to].name, port == nullptr ? "both" : directionName(port->direction),
                    joined(when)});
    report.json["transitions"].push_back({{"from", regions[t.from].name},
                                          {"port", port == nullptr ? Json() : Json(port->name)},
                                          {"to", regions[t.to].name},
                                          {"opens_at_N", parameterJson(t.force)},
                                          {"conditions", when}});
  }
  report.text += "\nTransitions\n" +
                 (move_table.empty() ? "  none: every wall is closed\n" : move_table.text("  "));

  report.json["maps"] = Json::array();
  Table map_table({"parameter", "values", "from", "stored in", "off by at most"});
  for (const SceneParameter& found : sceneParameters(description)) {
    const std::string values_unit = found.unit == "1" ? "" : " " + found.unit;
    const vdb::MaterialGridPtr grid = found.grid();
    map_table.add({found.name(), formatParameter(found.map) + values_unit,
                   grid ? grid->info().source : "-",
                   grid ? std::to_string(grid->info().quantisation.bits) + " bits, " +
                              formatBytes(grid->info().memory)
                        : "-",
                   grid ? formatNumber(grid->info().quantisation.error, 2) + values_unit : "-"});
    Json json = grid ? mapJson(*grid) : parameterJson(found.map);
    json["name"] = found.name();
    json["unit"] = found.unit;
    report.json["maps"].push_back(std::move(json));
  }
  if (!map_table.empty()) {
    report.text += "\nParameters that differ from place to place\n" + map_table.text("  ");
  }
  report.json["map_gaps"] = Json::array();
  for (const MapGap& gap : mapGaps(description, scene)) {
    report.text += "  " + gapText(gap, scene.lengthUnit(), unit) + "\n";
    report.json["map_gaps"].push_back({{"name", gap.parameter},
                                       {"source", gap.source},
                                       {"share", gap.share},
                                       {"away_m", gap.away},
                                       {"size_ratio", gap.size_ratio}});
  }

  report.json["contrasts"] = Json::array();
  report.json["shading_gaps"] = Json::array();
  std::string notes;
  for (WallNote& note : wallNotes(scene)) {
    notes += "  " + note.text + "\n";
    report.json[note.code == "scene.contrast" ? "contrasts" : "shading_gaps"].push_back(
        std::move(note.json));
  }
  if (!notes.empty()) report.text += "\nOf the walls\n" + notes;

  report.json["loop"] = deviceJson(options.device, rate);
  report.json["hand_limits"] = Json::array();
  report.json["budget"] = Json::array();
  if (simulation) {
    const devices::LoopModel loop = loopOf(*simulation);
    const auto items = devices::sceneBudget(scene, loop);
    report.json["hand_limits"] = handLimitsJson(loop);
    report.json["budget"] = budgetJson(items);
    report.text += "\nStability at " + formatNumber(rate) + " Hz" + delayText(simulation->delay) +
                   "\n" + deviceText(options.device) + handLimitsText(loop) +
                   "What is felt, at the hand in N/m or N.s/m\n" + budgetText(items);
  }

  report.json["sources"] = Json::array();
  Table source_table({"field or layer", "made from", "made"});
  const auto source = [&](const std::string& name, const FieldSource& from,
                          const std::string& left_out) {
    if (from.summary().empty()) return;
    const std::string why = left_out.empty() ? "nothing needs it" : left_out;
    const bool is_made = from.isMade() || from.part();
    const bool is_cut = !from.isMade() && from.part() && !from.part()->bounds().isBounded();
    source_table.add({name, from.summary(),
                      !is_made ? "no: " + why
                      : is_cut ? "what the device reaches"
                               : "yes"});
    report.json["sources"].push_back({{"name", name},
                                      {"source", from.summary()},
                                      {"made", is_made},
                                      {"only_in_reach", is_cut},
                                      {"why_not", is_made ? Json() : Json(why)}});
  };
  for (std::size_t i = 0; i < description.layers.size(); ++i) {
    source(description.layers[i].name, *description.layers[i].inside, regions[i + 1].left_out);
  }
  for (const auto& field : description.fields) source(field.name, *field.source, {});
  if (!source_table.empty()) report.text += "\nMade for this scene\n" + source_table.text("  ");
  report.json["grids"] = loaded.gridsJson();
  const std::string grids = loaded.gridsText();
  if (!grids.empty()) report.text += "\nGrids\n" + grids;
  const std::optional<Saving> saving = savingOf(loaded, scene);
  report.json["saved_estimate"] =
      saving ? Json{{"memory_bytes", saving->bytes}, {"seconds", saving->seconds}} : Json();
  if (saving) {
    report.text +=
        "\nSaved by what was left out, estimated from the grids above by the size of its box: " +
        formatBytes(saving->bytes) + ", " + formatSeconds(saving->seconds) + "\n";
  }
  report.json["measured"] = Json();
  if (options.measure) {
    const Saving whole = costOf(options.scene, Purpose::kShow, console);
    const Saving needed = costOf(options.scene, Purpose::kTouch, console);
    const auto json = [](const Saving& cost) {
      return Json{{"memory_bytes", cost.bytes}, {"seconds", cost.seconds}};
    };
    report.json["measured"] = {{"whole", json(whole)}, {"needed", json(needed)}};
    Table costs({"measured", "grids in the loop", "read and made in"});
    costs.add({"all of it", formatBytes(whole.bytes), formatSeconds(whole.seconds)});
    costs.add({"what is needed", formatBytes(needed.bytes), formatSeconds(needed.seconds)});
    report.text += "\nTo touch it, against all of it\n" + costs.text("  ");
  }
  report.json["svg"] = options.svg.empty() ? Json() : Json(options.svg);
  if (!options.svg.empty()) {
    files.write(options.svg, graphOf(scene, description, options.scene));
    files.commit();
    report.text += "\nWritten  " + options.svg + "\n";
  }
  return report;
}

}  // namespace palpate::tools
