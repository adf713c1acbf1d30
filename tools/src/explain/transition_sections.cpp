#include <string>
#include <vector>

#include "explain/explain_sections.h"
#include "json_parts.h"
#include "palpate/core/text.h"
#include "report_rows.h"
#include "text.h"
#include "transition_graph.h"

// Sections on where the probe can go, and when.

namespace palpate::tools {
void addPorts(const Scene& scene, const SceneDescription& description, Report& report) {
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
}

void addTransitions(const Scene& scene, const SceneDescription& description, Report& report) {
  const auto regions = scene.regions();
  ReportRows rows({"from", "through", "to", "direction", "open when"});
  for (const Transition& t : transitions(scene)) {
    const auto when = conditionsOf(t, scene, description);
    const Port* port = t.port ? &scene.ports()[*t.port] : nullptr;
    rows.add({regions[t.from].name, port == nullptr ? "(no wall)" : port->name, regions[t.to].name,
              port == nullptr ? "both" : directionName(port->direction),
              when.empty() ? "always" : joined(when)},
             {{"from", regions[t.from].name},
              {"port", port == nullptr ? Json() : Json(port->name)},
              {"to", regions[t.to].name},
              {"opens_at_N", parameterJson(t.force)},
              {"conditions", when}});
  }
  rows.writeTo(report, "transitions", "Transitions", "  none: every wall is closed\n");
}

std::string transitionPicture(const Scene& scene, const SceneDescription& description,
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
    for (std::string& condition : conditionsOf(t, scene, description)) {
      arrow.label.push_back(std::move(condition));
    }
    arrows.push_back(std::move(arrow));
  }
  return transitionSvg(title, states, arrows);
}

}  // namespace palpate::tools
