#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include "palpate/devices/scene_budget.h"
#include "palpate/scene/felt_walls.h"

namespace palpate::devices {
namespace {

const Material* materialOf(const Scene& scene, int index) {
  return index < 0 ? nullptr : &scene.materials()[static_cast<std::size_t>(index)];
}

double mostOf(const Parameter& parameter) { return parameter.range().most; }

/// [N/m] The largest slope of a wall's spring up to `force` [N] (SpringCurve in material.h); its
/// exponent is at least 1.
double steepest(const Material& wall, double force) {
  const double stiffness = mostOf(wall.stiffness);
  const double stiffening = mostOf(wall.curve.stiffening);
  const double exponent = wall.curve.exponent;
  const double reference = wall.curve.reference;
  if (exponent == 1.0 && stiffening == 0.0) return stiffness;
  const auto pushes = [&](double depth) {
    return stiffness * reference * std::pow(depth / reference, exponent) +
           stiffening * depth * depth;
  };
  double depth = reference;
  while (pushes(depth) < force && depth < 1.0) depth *= 2.0;
  double less = 0.0;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (less + depth);
    (pushes(middle) < force ? less : depth) = middle;
  }
  return stiffness * exponent * std::pow(depth / reference, exponent - 1.0) +
         2.0 * stiffening * depth;
}

/// Collects items; each parameter of a material appears once, with all its places.
class Items {
 public:
  Items(const Scene& scene, const DeviceModel& device) : scene_(scene), device_(device) {}

  void add(FeltItem item, const std::string& place) {
    item.most.stiffness *= scene_.device().stiffnessAtHand();
    item.most.damping *= scene_.device().stiffnessAtHand();
    if (!(item.most.stiffness > 0.0 || item.most.damping > 0.0)) return;
    for (FeltItem& each : all_) {
      const bool is_same = each.kind == item.kind && each.material == item.material &&
                           each.parameter == item.parameter &&
                           each.most.stiffness == item.most.stiffness &&
                           each.most.damping == item.most.damping;
      if (!is_same) continue;
      each.places.push_back(place);
      return;
    }
    item.places = {place};
    all_.push_back(std::move(item));
  }

  void addWall(FeltAs kind, const Material& wall, const std::string& place) {
    const double force = device_.max_force / scene_.device().force;
    FeltItem item = itemOf(kind, wall, "stiffness", {steepest(wall, force), mostOf(wall.damping)});
    const bool is_curved = wall.curve.exponent != 1.0 || mostOf(wall.curve.stiffening) > 0.0;
    if (is_curved) {
      item.parameter = "curve";
      item.note = "the slope of the force where it reaches the device's greatest force";
    }
    if (wall.composite.radius > 0.0) {
      item.most.stiffness = std::max(item.most.stiffness, stiffestWall(force));
      item.parameter = "composite";
      item.note = "the stiffest wall of the scene, which may be felt through it";
    }
    if (mostOf(wall.maxwell.stiffness) > 0.0) {
      item.most.stiffness += mostOf(wall.maxwell.stiffness);
      item.note += (item.note.empty() ? "" : "; ") + std::string("with its Maxwell branch");
    }
    if (mostOf(wall.texture.amplitude) > 0.0) {
      const double slope =
          mostOf(wall.texture.amplitude) * 2.0 * std::numbers::pi / wall.texture.wavelength;
      item.most.stiffness *= 1.0 + slope;
      item.note += (item.note.empty() ? "" : "; ") + std::string("with its texture's slope");
    }
    add(std::move(item), place);
  }

  void addContent(const Region& region, const Material& content) {
    const double drag = mostOf(content.viscosity);
    add(itemOf(FeltAs::kContent, content, "viscosity", {0.0, drag}), region.name);
    if (content.lattice.hasWaves() && mostOf(content.lattice.force) > 0.0) {
      // highestForce(K) is K wavelength / (2 pi), so this is the stiffness of the spring that a
      // lattice is where its force changes fastest.
      const double stiffness = mostOf(content.lattice.force) / content.lattice.highestForce(1.0);
      FeltItem item = itemOf(FeltAs::kContent, content, "lattice", {stiffness, drag});
      item.note = "2 pi force / wavelength";
      add(std::move(item), region.name);
    }
    if (mostOf(content.cutting) > 0.0) {
      FeltItem item =
          itemOf(FeltAs::kNeedle, content, "cutting", {mostOf(content.stiffness), drag});
      item.note = "until it is cut the tip presses with the material's stiffness";
      add(std::move(item), region.name);
    }
    const ShaftFriction& shaft = content.shaft;
    const double length = extentOf(region);
    const double damping = std::max(mostOf(shaft.in.damping), mostOf(shaft.out.damping));
    if (shaft.stiffness > 0.0) {
      addShaft(content, "shaft", {shaft.stiffness * length, damping * length}, length, region);
    }
    if (shaft.lateral.stiffness > 0.0) {
      addShaft(content, "shaft.lateral", {shaft.lateral.stiffness * length, 0.0}, length, region);
    }
  }

  std::vector<FeltItem> take() { return std::move(all_); }

 private:
  static FeltItem itemOf(FeltAs kind, const Material& material, const char* parameter,
                         const WallModel& most) {
    FeltItem item;
    item.kind = kind;
    item.material = material.name;
    item.parameter = parameter;
    item.most = most;
    return item;
  }
  void addShaft(const Material& content, const char* parameter, const WallModel& most,
                double length, const Region& region) {
    FeltItem item = itemOf(FeltAs::kNeedle, content, parameter, most);
    item.length = length;
    add(std::move(item), region.name);
  }
  [[nodiscard]] double stiffestWall(double force) const {
    double most = 0.0;
    for (const Region& region : scene_.regions()) {
      if (const Material* wall = materialOf(scene_, region.wall)) {
        most = std::max(most, steepest(*wall, force));
      }
    }
    return most;
  }
  /// [m] The longest shaft that fits into the region: the diagonal of its box, or of the workspace.
  [[nodiscard]] double extentOf(const Region& region) const {
    Box3 workspace = device_.workspace;
    if (!workspace.isBounded()) workspace = scene_.device().workspace;
    const double reach = glm::length(workspace.size()) * scene_.device().scale;
    const Box3 box = region.field ? region.field->bounds() : Box3();
    const double extent = region.field && box.isBounded() ? glm::length(box.size()) : kInfinity;
    return std::min(extent, reach);
  }

  const Scene& scene_;
  const DeviceModel& device_;
  std::vector<FeltItem> all_;
};

}  // namespace

std::vector<FeltItem> feltItems(const Scene& scene, const DeviceModel& device) {
  Items items(scene, device);
  for (const FeltWall& wall : feltWalls(scene)) {
    items.addWall(wall.is_sheet ? FeltAs::kSheet : FeltAs::kWall, *materialOf(scene, wall.material),
                  wall.place);
  }
  for (const Region& region : scene.regions()) {
    const Material* content = region.reachable ? materialOf(scene, region.content) : nullptr;
    if (content != nullptr) items.addContent(region, *content);
  }
  return items.take();
}

}  // namespace palpate::devices
