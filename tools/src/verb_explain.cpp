#include <algorithm>

#include "json_parts.h"
#include "loaded_scene.h"
#include "text.h"
#include "verbs.h"

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

/// One row of the table of transitions: from a region, by a port or an absent wall, to a region.
struct Transition {
  RegionId from = 0;
  RegionId to = 0;
  const Port* port = nullptr;  ///< null: no wall is there
  Parameter force;             ///< [N] at which it opens
};

std::vector<Transition> transitions(const Scene& scene) {
  std::vector<Transition> all;
  const std::size_t count = scene.regions().size();
  for (std::size_t a = 0; a < count; ++a) {
    const auto from = static_cast<RegionId>(a);
    for (std::size_t b = 0; b < count; ++b) {
      const auto to = static_cast<RegionId>(b);
      if (!scene.touches(from, to)) continue;
      if (scene.passages().wall(from, to).absent) {
        all.push_back({from, to, nullptr, {}});
        continue;
      }
      for (const PortId id : scene.passages().portsOf(from)) {
        const Port& port = scene.ports()[id];
        if (!port.leads(from, to)) continue;
        const bool forward = std::find(port.from.begin(), port.from.end(), from) != port.from.end();
        all.push_back({from, to, &port, forward ? port.opens_at : port.back});
      }
    }
  }
  return all;
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
  if (t.port == nullptr) return all;
  const PortDescription* described = describedPort(description, t.port->name);
  if (!t.port->on.empty()) {
    all.push_back("on " + (described != nullptr && !described->on_name.empty()
                               ? described->on_name
                               : std::string("one face")));
  }
  if (t.port->mask >= 0) all.emplace_back("within its extent");
  for (const PortId before : t.port->after) all.push_back("after " + scene.ports()[before].name);
  if (t.force != 0.0) all.push_back("pressed with " + formatParameter(t.force) + " N");
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
         ") start in regions that cannot be reached either, or come after such";
}

std::string contentText(const Material& content) {
  std::string text = content.name + " (" + formatParameter(content.viscosity) + " N.s/m";
  const auto add = [&](const Parameter& parameter, const char* what, const char* unit) {
    if (parameter.range().most > 0.0) text += what + formatParameter(parameter) + unit;
  };
  add(content.lattice.force, ", lattice ", " N");
  add(content.cutting, ", cut by ", " N");
  add(content.shaft.in.kinetic_force, ", holds a shaft by ", " N/m");
  return text + ")";
}

}  // namespace

Report run(const ExplainOptions& options, const GeneralOptions&, Console& console) {
  LoadedScene loaded(options.scene, console);
  const ScenePtr compiled = loaded.compile();
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

  report.text = options.scene + ": the probe starts in " + regions[scene.startRegion()].name +
                "; renderer " + report.json["renderer"].get<std::string>() + "; lengths in " +
                scene.lengthUnit() + "\n\n";

  report.json["regions"] = Json::array();
  Table region_table({"region", "made from", "content", "wall", "can be entered", "a point of it"});
  std::string unreachable;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region& r = regions[i];
    const Material* content = materialOf(scene, r.content);
    const std::string source = i == kOutside ? "-" : r.source.empty() ? "formula" : r.source;
    region_table.add({r.name, source, content == nullptr ? "-" : contentText(*content),
                      i == kOutside ? "-" : wallText(scene, {r.wall_absent, r.wall}),
                      r.reachable ? "yes" : "NO",
                      r.has_seed ? formatVector(r.seed / unit, 3) : "-"});
    Json json = {{"name", r.name},
                 {"source", source},
                 {"content", content == nullptr ? Json() : materialJson(*content)},
                 {"reachable", r.reachable},
                 {"seed", r.has_seed ? vectorJson(r.seed / unit) : Json()}};
    if (!r.reachable) {
      const std::string why = whyUnreachable(scene, static_cast<RegionId>(i));
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
  Table sheet_table({"sheet", "wall", "extent"});
  for (const Sheet& sheet : scene.passages().sheets()) {
    sheet_table.add({sheet.name, wallText(scene, {false, sheet.material}),
                     sheet.mask < 0 ? "all of its surface" : "limited"});
    report.json["sheets"].push_back({{"name", sheet.name},
                                     {"where", sheet.mask >= 0},
                                     {"wall", wallJson(scene, {false, sheet.material})}});
  }
  if (!sheet_table.empty()) {
    report.text += "\nSheets (the same region on both sides)\n" + sheet_table.text("  ");
  }

  report.json["ports"] = Json::array();
  for (const Port& port : scene.ports()) {
    const PortDescription* described = describedPort(description, port.name);
    Json json = {{"name", port.name}};
    json["between"] = described == nullptr ? Json() : Json::array({described->from, described->to});
    json["on"] =
        described == nullptr || described->on_name.empty() ? Json() : Json(described->on_name);
    json["where"] = port.mask >= 0;
    json["direction"] = directionName(port.direction);
    json["after"] = Json::array();
    for (const PortId before : port.after) json["after"].push_back(scene.ports()[before].name);
    json["opens_at_N"] = parameterJson(port.opens_at);
    json["back_N"] = parameterJson(port.back);
    report.json["ports"].push_back(std::move(json));
  }

  report.json["transitions"] = Json::array();
  Table move_table({"from", "through", "to", "direction", "open when"});
  for (const Transition& t : transitions(scene)) {
    const auto when = conditions(t, scene, description);
    move_table.add({regions[t.from].name, t.port == nullptr ? "(no wall)" : t.port->name,
                    regions[t.to].name,
                    t.port == nullptr ? "both" : directionName(t.port->direction), joined(when)});
    report.json["transitions"].push_back({{"from", regions[t.from].name},
                                          {"port", t.port == nullptr ? Json() : Json(t.port->name)},
                                          {"to", regions[t.to].name},
                                          {"opens_at_N", parameterJson(t.force)},
                                          {"conditions", when}});
  }
  report.text += "\nTransitions\n" +
                 (move_table.empty() ? "  none: every wall is closed\n" : move_table.text("  "));

  report.json["sources"] = Json::array();
  Table source_table({"field or layer", "made from", "made"});
  const auto source = [&](const std::string& name, const FieldSource& from) {
    if (from.summary().empty()) return;
    source_table.add({name, from.summary(), from.isMade() ? "yes" : "no: nothing needs it"});
    report.json["sources"].push_back(
        {{"name", name}, {"source", from.summary()}, {"made", from.isMade()}});
  };
  for (const auto& layer : description.layers) source(layer.name, *layer.inside);
  for (const auto& field : description.fields) source(field.name, *field.source);
  if (!source_table.empty()) report.text += "\nMade for this scene\n" + source_table.text("  ");
  report.json["grids"] = loaded.gridsJson();
  const std::string grids = loaded.gridsText();
  if (!grids.empty()) report.text += "\nGrids\n" + grids;
  return report;
}

}  // namespace palpate::tools
