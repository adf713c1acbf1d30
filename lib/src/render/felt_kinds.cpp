#include <algorithm>

#include "convex_leaf.h"
#include "felt_walls.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"
#include "palpate/render/contrast.h"

// Finds which walls of a scene feel the same, when a renderer is made.

namespace palpate {
namespace {

/// The stop's stiffness over that of the stiffest law: low enough that walls of about one stiffness
/// feel like one.
constexpr double kStop = 1.05;
/// The tangent of a law is limited to this many times the stiffest linear spring.
constexpr double kStiffest = 1e3;

double tangentOf(const WallSpring& spring, double depth) noexcept {
  WallLaw law;
  law.spring = spring;
  return law.tangent(depth);
}

bool feelAlike(const Material& a, const Material& b) noexcept {
  return a.stiffness == b.stiffness && a.curve.stiffening == b.curve.stiffening &&
         a.curve.exponent == b.curve.exponent &&
         (a.curve.exponent == 1.0 || a.curve.reference == b.curve.reference) &&
         a.texture.amplitude == b.texture.amplitude &&
         a.texture.wavelength == b.texture.wavelength && a.shading == b.shading &&
         a.composite.radius == b.composite.radius && a.composite.depth == b.composite.depth;
}

}  // namespace

FeltWalls::FeltWalls(const Scene& scene, CellWalker& walker)
    : scene_(scene),
      walker_(walker),
      near_(scene, walker),
      beneath_(scene, walker),
      seams_(scene, walker) {
  sortKinds();
  if (std::find(may_differ_.begin(), may_differ_.end(), true) != may_differ_.end()) {
    findConvexLeaves();
  }
}

void FeltWalls::findConvexLeaves() {
  const std::span<const Leaf> leaves = scene_.partition().leaves();
  Box3 scene;
  for (const Region& region : scene_.regions()) {
    if (region.field == nullptr) continue;
    const Box3 own = region.field->bounds();
    if (own.isBounded()) scene = scene.unitedWith(own);
  }
  is_convex_.assign(leaves.size(), false);
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (leaves[i].is_flat) continue;
    const Box3 own = leaves[i].field->bounds();
    const Box3& box = own.isBounded() ? own : scene;
    if (box.isBounded()) is_convex_[i] = isConvex(*leaves[i].field, box);
  }
}

/// Whether the region's walls may be of several kinds.
bool FeltWalls::mayDiffer(RegionId region) const {
  int first = -1;
  bool out = false;
  const auto add = [&](int material) {
    if (material < 0) return;
    const Material& own = scene_.materials()[static_cast<std::size_t>(material)];
    const int kind = kind_[static_cast<std::size_t>(material)];
    if (own.composite.radius > 0.0 || own.shading > 0.0) out = true;
    if (first >= 0 && kind != first) out = true;
    first = kind;
  };
  for (std::size_t i = 0; i < scene_.regions().size(); ++i) {
    const auto other = static_cast<RegionId>(i);
    const Wall& wall = scene_.passages().wall(region, other);
    if (other != region && !wall.absent) add(wall.material);
  }
  for (const Sheet& sheet : scene_.passages().sheets()) add(sheet.material);
  return out;
}

/// Two regions may share a neighbor, with an open way between the two beside its wall. That wall
/// may have one material seen from one region and another seen from the other: then walls differ
/// across the seam.
void FeltWalls::sortSeams() {
  const std::size_t regions = scene_.regions().size();
  const Passages& passages = scene_.passages();
  const auto leads = [&](RegionId from, RegionId to) {
    if (passages.wall(from, to).absent) return true;
    const std::span<const PortId> ports = passages.portsOf(from);
    return std::any_of(ports.begin(), ports.end(),
                       [&](PortId port) { return passages.ports()[port].leads(from, to); });
  };
  const auto kind_of = [&](RegionId from, RegionId to) {
    const Wall& wall = passages.wall(from, to);
    return wall.absent || wall.material < 0 ? -1 : kind_[static_cast<std::size_t>(wall.material)];
  };
  for (std::size_t a = 0; a < regions; ++a) {
    for (std::size_t b = 0; b < regions; ++b) {
      const auto here = static_cast<RegionId>(a);
      const auto there = static_cast<RegionId>(b);
      if (a == b || may_differ_[a] || !leads(here, there)) continue;
      for (std::size_t c = 0; c < regions; ++c) {
        const auto beyond = static_cast<RegionId>(c);
        if (c == a || c == b) continue;
        const int one = kind_of(here, beyond);
        const int other = kind_of(there, beyond);
        if (one >= 0 && other >= 0 && one != other) may_differ_[a] = true;
      }
    }
  }
}

std::vector<bool> FeltWalls::usedByWalls() const {
  std::vector<bool> used(scene_.materials().size(), false);
  const auto use = [&](int material) {
    if (material >= 0) used[static_cast<std::size_t>(material)] = true;
  };
  const std::size_t regions = scene_.regions().size();
  for (std::size_t a = 0; a < regions; ++a) {
    use(scene_.regions()[a].wall);
    for (std::size_t b = 0; b < regions; ++b) {
      const Wall& wall = scene_.passages().wall(static_cast<RegionId>(a), static_cast<RegionId>(b));
      if (!wall.absent) use(wall.material);
    }
  }
  for (const Sheet& sheet : scene_.passages().sheets()) use(sheet.material);
  return used;
}

void FeltWalls::sortKinds() {
  const std::span<const Material> materials = scene_.materials();
  kind_.assign(materials.size(), 0);
  reach_.assign(materials.size(), kInfinity);
  double deepest = 0.0;
  double flat = 0.0;
  for (const Leaf& leaf : scene_.partition().leaves()) {
    (leaf.is_flat ? flat : deepest) = std::max(leaf.is_flat ? flat : deepest, leaf.feature);
  }
  if (deepest == 0.0) deepest = flat;
  const std::vector<bool> used = usedByWalls();
  std::vector<std::size_t> walls;
  double stiffest = 0.0;
  double straight = 0.0;
  for (std::size_t i = 0; i < materials.size(); ++i) {
    if (!used[i]) continue;
    const Material& own = materials[i];
    kind_[i] = static_cast<int>(i);
    for (const std::size_t other : walls) {
      if (feelAlike(materials[other], own)) kind_[i] = kind_[other];
    }
    walls.push_back(i);
    reach_[i] = own.shading > 0.0 ? kInfinity : textureReach(own.texture);
    const WallSpring spring{own.stiffness.range().most, own.curve.stiffening.range().most,
                            own.curve.exponent, own.curve.reference};
    double bumps = own.texture.amplitude.range().most > 0.0 ? 1.0 + kHeldTexture : 1.0;
    if (own.shading > 0.0) bumps = 1.0 + kHeldShading;
    stiffest = std::max(stiffest, bumps * tangentOf(spring, deepest));
    straight = std::max(straight, spring.stiffness);
  }
  contrast_.assign(materials.size(), kInfinity);
  for (const Contrast& each : contrastsOf(scene_)) {
    const auto i = static_cast<std::size_t>(each.material);
    // A composite is probed over a patch of its own.
    if (used[i] && !(materials[i].composite.radius > 0.0)) contrast_[i] = each.length;
  }
  is_plain_.assign(materials.size(), false);
  for (std::size_t i = 0; i < materials.size(); ++i) {
    const Material& own = materials[i];
    is_plain_[i] = own.stiffness.isConstant() && own.curve.exponent == 1.0 &&
                   own.curve.stiffening == Parameter(0.0) && !(own.texture.wavelength > 0.0) &&
                   !(own.shading > 0.0) && !(own.composite.radius > 0.0);
  }
  may_differ_.assign(scene_.regions().size(), false);
  for (std::size_t i = 0; i < may_differ_.size(); ++i) {
    may_differ_[i] = mayDiffer(static_cast<RegionId>(i));
  }
  sortSeams();
  stop_ = kStop * std::min(stiffest, kStiffest * straight);
}

}  // namespace palpate
