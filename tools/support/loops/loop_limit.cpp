#include "support/loops/loop_limit.h"

#include <algorithm>

#include "palpate/devices/device_presets.h"
#include "support/rivals/rivals.h"

namespace palpate::loops {
namespace {

/// The surfaces of all layers, for renderers that need triangles: their edges are a fortieth of the
/// scene.
rivals::TriangleMesh meshOfScene(const Scene& scene) {
  rivals::TriangleMesh all;
  for (const Region& region : scene.regions()) {
    if (!region.field || !region.field->bounds().isBounded()) continue;
    const Box3 box = region.field->bounds();
    const Vec3 size = box.size();
    const double edge = std::max({size.x, size.y, size.z}) / 40.0;
    const rivals::TriangleMesh mesh = rivals::meshOf(*region.field, box.grownBy(1.3 * edge), edge);
    const auto first = static_cast<std::uint32_t>(all.points.size());
    all.points.insert(all.points.end(), mesh.points.begin(), mesh.points.end());
    all.normals.insert(all.normals.end(), mesh.normals.begin(), mesh.normals.end());
    for (const auto& t : mesh.triangles) {
      all.triangles.push_back({t[0] + first, t[1] + first, t[2] + first});
    }
  }
  return all;
}

double voxelOf(const Scene& scene) {
  const Vec3 size = scene.bounds().size();
  return std::max({size.x, size.y, size.z}) / 100.0;
}

}  // namespace

const std::vector<std::string>& loopRenderers() {
  static const std::vector<std::string> all = {
      "constraint", "paper",         "closest-point", "potential-field", "tangent-tracking",
      "god-object", "force-shading", "slow-plane",    "voxels"};
  return all;
}

bool canRender(const std::string& renderer, const HardScene& scene) {
  return renderer == "constraint" || !scene.is_ours;
}

std::unique_ptr<HapticRenderer> makeLoopRenderer(const std::string& renderer,
                                                 const ScenePtr& scene) {
  if (renderer == "closest-point") return rivals::closestPoint(scene);
  if (renderer == "potential-field") return rivals::potentialField(scene);
  if (renderer == "tangent-tracking") return rivals::tangentTracking(scene);
  if (renderer == "god-object") return rivals::godObject(scene, meshOfScene(*scene));
  if (renderer == "force-shading") return rivals::forceShading(scene, meshOfScene(*scene));
  if (renderer == "slow-plane") return rivals::slowPlane(scene, {.period = 0.01});
  if (renderer == "voxels") {
    return rivals::voxelOccupancy(scene, {.size = voxelOf(*scene), .ramp = 4.0});
  }
  RendererSettings settings;
  settings.kind = renderer == "paper" ? RendererKind::kPaper : RendererKind::kConstraint;
  return makeRenderer(scene, settings);
}

devices::LoopModel loopModelOf(const LoopCase& what) {
  devices::LoopModel loop;
  loop.device = devices::devicePreset(what.device).model();
  loop.hand = devices::handPreset(what.hand);
  loop.period = 1.0 / what.rate;
  loop.delay = what.delay;
  return loop;
}

LoopLimit findLimit(const LoopCase& what, const HardScene& scene, HapticRenderer& renderer,
                    const std::function<void()>& poll) {
  LoopLimit out;
  out.what = what;
  const devices::LoopModel loop = loopModelOf(what);
  const devices::StabilityBudget budget = devices::budgetOf(loop);
  out.linear = budget.linear;
  out.budget = budget.stiffness();
  const auto run = [&](double stiffness) {
    constexpr double kForce = 1.0;  // [N]
    const double depth = depthOfForce(loop, stiffness, kForce);
    LoopSetting setting{.loop = loop, .hand = pressOn(scene.at, scene.out, depth, 1.3)};
    setting.gain = stiffness / kHardStiffness;
    setting.poll = poll;
    return runLoop(renderer, setting, kHardStiffness);
  };
  out.found = largestGain(
      [&](double stiffness) {
        const LoopOutcome felt = run(stiffness);
        return felt.isQuiet() && felt.touches;
      },
      LoopLimit::kLeast, LoopLimit::kMost);
  const LoopOutcome above = run(1.15 * std::max(out.found, LoopLimit::kLeast));
  out.cycle = above.chatter;
  out.frequency = above.frequency;
  const double used = out.found > 0.0 ? std::min(out.budget, out.found) : out.budget;
  // A budget may be 0 or infinite, and no hand presses on such a wall; therefore it is clamped.
  const LoopOutcome at = run(std::clamp(used, LoopLimit::kLeast, LoopLimit::kMost));
  out.to_hand = at.to_hand;
  out.largest_step = at.largest_step;
  out.tick_ns = at.tick_ns;
  out.holds = at.touches;
  return out;
}

}  // namespace palpate::loops
