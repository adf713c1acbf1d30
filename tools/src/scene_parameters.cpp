#include "scene_parameters.h"

#include <algorithm>
#include <utility>

namespace palpate::tools {
namespace {

class Collector {
 public:
  void add(const std::string& owner, std::string parameter, std::string unit,
           const Parameter& value) {
    if (value.isConstant()) return;
    found_.push_back({owner, std::move(parameter), std::move(unit), value.map()});
  }
  std::vector<SceneParameter> take() { return std::move(found_); }

 private:
  std::vector<SceneParameter> found_;
};

const Material* named(const SceneDescription& description, const std::string& name) {
  const auto found = std::find_if(description.materials.begin(), description.materials.end(),
                                  [&](const Material& m) { return m.name == name; });
  return found == description.materials.end() ? nullptr : &*found;
}

void addShaft(const std::string& layer, const std::string& way, const ShaftFriction::Way& friction,
              Collector& all) {
  all.add(layer, "shaft_" + way + "_static", "N/m", friction.static_force);
  all.add(layer, "shaft_" + way + "_kinetic", "N/m", friction.kinetic_force);
  all.add(layer, "shaft_" + way + "_damping", "N.s/m^2", friction.damping);
}

}  // namespace

std::vector<SceneParameter> sceneParameters(const SceneDescription& description) {
  Collector all;
  for (const LayerDescription& layer : description.layers) {
    if (const Material* wall = named(description, layer.wall.material)) {
      all.add(layer.name, "stiffness", "N/m", wall->stiffness);
      all.add(layer.name, "damping", "N.s/m", wall->damping);
      all.add(layer.name, "static_friction", "1", wall->friction.static_ratio);
      all.add(layer.name, "kinetic_friction", "1", wall->friction.kinetic_ratio);
      all.add(layer.name, "texture_amplitude", "m", wall->texture.amplitude);
      all.add(layer.name, "stiffening", "N/m^2", wall->curve.stiffening);
      all.add(layer.name, "maxwell_stiffness", "N/m", wall->maxwell.stiffness);
    }
    if (const Material* content = named(description, layer.content)) {
      all.add(layer.name, "viscosity", "N.s/m", content->viscosity);
      all.add(layer.name, "flow_x", "m/s", content->flow.x);
      all.add(layer.name, "flow_y", "m/s", content->flow.y);
      all.add(layer.name, "flow_z", "m/s", content->flow.z);
      all.add(layer.name, "lattice_force", "N", content->lattice.force);
      all.add(layer.name, "cutting", "N", content->cutting);
      addShaft(layer.name, "in", content->shaft.in, all);
      addShaft(layer.name, "out", content->shaft.out, all);
    }
  }
  for (const PortDescription& port : description.ports) {
    all.add(port.name, "opens_at", "N", port.opens_at);
    if (port.back) all.add(port.name, "back", "N", *port.back);
    all.add(port.name, "reopens_at", "N", port.reopens_at);
  }
  return all.take();
}

}  // namespace palpate::tools
