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
    }
    if (const Material* content = named(description, layer.content)) {
      all.add(layer.name, "viscosity", "N.s/m", content->viscosity);
    }
  }
  for (const PortDescription& port : description.ports) {
    all.add(port.name, "opens_at", "N", port.opens_at);
    if (port.back) all.add(port.name, "back", "N", *port.back);
  }
  return all.take();
}

}  // namespace palpate::tools
