#include "explain/scene_words.h"

#include "text.h"

namespace palpate::tools {

const Material* materialOf(const Scene& scene, int index) {
  return index < 0 ? nullptr : &scene.materials()[static_cast<std::size_t>(index)];
}

std::string wallText(const Scene& scene, const Wall& wall) {
  if (wall.absent) return "absent";
  const Material* m = materialOf(scene, wall.material);
  return m == nullptr ? "-" : materialText(*m);
}

std::string materialText(const Material& wall) {
  return wall.name + " (" + formatParameter(wall.stiffness) + " N/m)";
}

const PortDescription* describedPort(const SceneDescription& description, const std::string& name) {
  for (const auto& port : description.ports) {
    if (port.name == name) return &port;
  }
  return nullptr;
}

std::vector<std::string> conditionsOf(const Transition& t, const Scene& scene,
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
         ") start in regions that cannot be reached either, or their `after` is never fulfilled "
         "where they start";
}

std::string contentText(const Material& content) {
  std::string text = content.name + " (" + formatParameter(content.viscosity) + " N.s/m";
  const auto add = [&](const Parameter& parameter, const char* what, const char* unit) {
    if (parameter.range().most > 0.0) text += what + formatParameter(parameter) + unit;
  };
  add(content.lattice.force, ", lattice ", " N");
  add(content.cutting, ", cutting force ", " N");
  add(content.shaft.in.kinetic_force, ", shaft friction ", " N/m");
  add(content.shaft.lateral.stiffness, ", sideways shaft stiffness ", " N/m^2");
  return text + ")";
}

}  // namespace palpate::tools
