#include "felt_walls.h"

#include <algorithm>
#include <cmath>

#include "palpate/contact/contact_patch.h"
#include "palpate/contact/planes.h"
#include "palpate/render/contrast.h"

namespace palpate {
namespace {

/// The stop, over the stiffest law of all: near enough that walls of about one stiffness feel like one, ...
constexpr double kStop = 1.05;
/// ... of all that are no stiffer than this many times the stiffest straight spring.
constexpr double kStiffest = 1e3;
/// Share of the depth to which a height may bring a wall down, or up.
constexpr double kHeldTexture = 0.5;
constexpr double kHeldShading = 0.9;

/// Of how deep the press is: walls that meet no nearer than this are felt one at a time.
constexpr double kFarthestMeeting = 30.0;
constexpr int kMeetingSteps = 12;
/// Of the farthest: so near to both walls is where they meet. And the least square of the sine of their angle.
constexpr double kMet = 1e-6;
constexpr double kFlattest = 1e-3;

bool holds(const ContactSet& contact, LeafId leaf) noexcept {
  const auto walls = contact.walls();
  return std::any_of(walls.begin(), walls.end(),
                     [&](const WallContact& each) { return each.leaf == leaf; });
}

/// Whether two walls meet within `farthest` [m] of `x`: a wall that lies behind another one, as a bone does
/// under skin, does not bound where the proxy may be. Newton's steps towards both.
bool meet(const Vec3& x, const HeldWall& a, const HeldWall& b, double farthest) noexcept {
  FieldSample at_a{a.jet.value, a.jet.gradient, a.jet.in_band};
  FieldSample at_b{b.jet.value, b.jet.gradient, b.jet.in_band};
  Vec3 p = x;
  for (int i = 0; i < kMeetingSteps; ++i) {
    const double slope_a = glm::length(at_a.gradient);
    const double slope_b = glm::length(at_b.gradient);
    if (!at_a.in_band || !at_b.in_band || !(slope_a > 0.0) || !(slope_b > 0.0)) return false;
    const Vec3 m = at_a.gradient / slope_a;
    const Vec3 n = at_b.gradient / slope_b;
    const double off_a = at_a.value / slope_a;
    const double off_b = at_b.value / slope_b;
    if (std::fabs(off_a) + std::fabs(off_b) <= kMet * farthest) return true;
    const double cosine = glm::dot(m, n);
    const double square = 1.0 - cosine * cosine;
    if (square < kFlattest) return false;
    p -= ((off_a - cosine * off_b) * m + (off_b - cosine * off_a) * n) / square;
    if (!(glm::length(p - x) <= farthest)) return false;
    at_a = a.field->sample(p);
    at_b = b.field->sample(p);
  }
  return false;
}

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
    : scene_(scene), walker_(walker), near_(scene, walker), beneath_(scene) {
  sortKinds();
}

/// Whether the walls that the region touches may be of several kinds.
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
    if (other != region && scene_.touches(region, other) && !wall.absent) add(wall.material);
  }
  for (const Sheet& sheet : scene_.passages().sheets()) add(sheet.material);
  return out;
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
  is_sheet_.assign(scene_.partition().leaves().size(), false);
  for (const Sheet& sheet : scene_.passages().sheets()) {
    for (const LeafId leaf : sheet.leaves) is_sheet_[leaf] = true;
  }
  contrast_.assign(materials.size(), kInfinity);
  for (const Contrast& each : contrastsOf(scene_)) {
    const auto i = static_cast<std::size_t>(each.material);
    // What lies beneath is looked at over a patch of its own.
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
  stop_ = kStop * std::min(stiffest, kStiffest * straight);
}

MaterialMap::Sample FeltWalls::stiffness(LeafId leaf, const Facet& facet, const HeldWall& held,
                                         const Vec3& x) noexcept {
  const Material& wall = material(facet);
  if (wall.composite.radius > 0.0 && facet.beyond != walker_.region()) {
    return beneath_.stiffness(leaf, x, held, facet, wall);
  }
  return wall.stiffness.sample(x);
}

FeltWall FeltWalls::felt(LeafId leaf, const Facet& facet, const HeldWall& held, const Vec3& x,
                         SmoothedField& smoothed) noexcept {
  FeltWall out;
  const Material& wall = material(facet);
  MaterialMap::Sample linear;
  const double contrast = contrast_[static_cast<std::size_t>(facet.material)];
  if (contrast < kInfinity) {
    const PatchSample patch = overPatch(wall.stiffness, x, press_, contrast);
    linear = {patch.value, patch.by_place + patch.by_press};
    out.stiffness_press = patch.by_press;
  } else {
    linear = stiffness(leaf, facet, held, x);
  }
  const MaterialMap::Sample stiffening = wall.curve.stiffening.sample(x);
  out.law.spring = {linear.value, stiffening.value, wall.curve.exponent, wall.curve.reference};
  out.stiffness_rise = linear.gradient;
  out.stiffening_rise = stiffening.gradient;
  if (wall.texture.wavelength > 0.0) {
    const FeltHeight bumps = textureHeight(wall.texture, x);
    out.law.height = bumps.value;
    out.law.held = kHeldTexture;
    out.law.reach = reach_[static_cast<std::size_t>(facet.material)];
    out.height_rise = bumps.gradient;
  }
  if (wall.shading > 0.0) {
    // Over the whole solid that the wall bounds: its facets may be leaves.
    const RegionId here = walker_.region();
    const Field* solid = held.field;
    double side = held.side;
    if (here != facet.beyond) {
      const RegionId inner = std::max(here, facet.beyond);
      solid = scene_.regions()[inner].field.get();
      side = here == inner ? -1.0 : 1.0;
    }
    const FeltHeight smooth = smoothed.at(*solid, wall.shading, x);
    out.law.height -= side * smooth.value;
    out.law.held = kHeldShading;
    out.law.reach = kInfinity;
    out.height_rise -= side * smooth.gradient;
  }
  return out;
}

/// Whether the proxy's region may end at this leaf: that of a layer which it touches, or of a sheet.
bool FeltWalls::mayBound(LeafId leaf) const noexcept {
  const RegionId here = walker_.region();
  const auto regions = scene_.partition().regionsOf(leaf);
  return is_sheet_[leaf] || std::any_of(regions.begin(), regions.end(), [&](RegionId each) {
           return each == here || scene_.touches(here, each);
         });
}

/// Whether the proxy's region ends at this facet, as far as the scene knows.
bool FeltWalls::isWall(const Facet& facet) const noexcept {
  const RegionId here = walker_.region();
  return facet.isClosed() && facet.material >= 0 &&
         (facet.beyond == here || scene_.touches(here, facet.beyond));
}

/// Walls of one material differ by what lies behind them, or by the solid whose shape is smoothed.
int FeltWalls::ownOf(const Near& wall) const noexcept {
  const Material& own = material(wall.facet);
  const RegionId here = walker_.region();
  const bool is_sheet = wall.facet.beyond == here;
  if (own.composite.radius > 0.0 || (own.shading > 0.0 && is_sheet)) return 1 + wall.leaf;
  return own.shading > 0.0 ? -1 - std::max(here, wall.facet.beyond) : 0;
}

void FeltWalls::add(const Near& wall) noexcept {
  const int kind = kind_[static_cast<std::size_t>(wall.facet.material)];
  const int own = ownOf(wall);
  std::size_t g = 0;
  while (g < count_ && (group_[g].kind != kind || group_[g].own != own)) ++g;
  if (g == kMost) return;
  Group& group = group_[g];
  if (g == count_) {
    ++count_;
    group.kind = kind;
    group.own = own;
    group.count = 0;
  }
  if (group.count == kMaxProjectionWalls) return;
  group.held[group.count] = wall.held;
  group.wall[group.count++] = wall;
}

bool FeltWalls::differ(const ContactSet& contact, double reach) noexcept {
  count_ = 0;
  if (!may_differ_[walker_.region()]) return false;
  for (const WallContact& each : contact.walls()) add({each.leaf, each.facet, each.held});
  // Most often there is nothing but what holds the proxy, and what lies beneath that.
  bool is_alone = true;
  walker_.forWithin(reach, [&](LeafId id) {
    if (!holds(contact, id) && mayBound(id)) is_alone = false;
  });
  if (is_alone) return count_ > 1;
  // By the sides that the walker knows: the proxy may be a little beyond what counts as on a wall.
  if (!near_.look(reach, true)) return count_ > 1;
  const std::span<const NearWall> walls = near_.walls();
  // The cell that the walls which hold the proxy bound: what else bounds it is felt as well.
  for (const NearCell& cell : near_.cells()) {
    const auto bounds = [&](const WallContact& each) {
      for (std::size_t i = 0; i < walls.size(); ++i) {
        if (walls[i].leaf != each.leaf) continue;
        return (((each.held.side < 0.0 ? cell.inside : cell.outside) >> i) & 1U) != 0;
      }
      return false;
    };
    const auto held = contact.walls();
    if (!std::all_of(held.begin(), held.end(), bounds)) continue;
    for (std::size_t i = 0; i < walls.size(); ++i) {
      const bool inside = ((cell.inside >> i) & 1U) != 0;
      if (!inside && ((cell.outside >> i) & 1U) == 0) continue;
      const LeafId leaf = walls[i].leaf;
      if (holds(contact, leaf) || !(walls[i].slope > 0.0)) continue;
      if (walls[i].gap(inside) > reach) continue;
      Near near{leaf, walker_.facetAt(leaf), {}};
      if (!isWall(near.facet)) continue;
      near.held.field = walker_.leaf(leaf).field.get();
      near.held.side = inside ? -1.0 : 1.0;
      near.held.jet = walker_.jetHere(leaf);
      near.held.normal = inside ? -walls[i].normal : walls[i].normal;
      if (std::none_of(held.begin(), held.end(), [&](const WallContact& each) {
            return meet(walker_.position(), each.held, near.held, kFarthestMeeting * reach);
          })) {
        continue;
      }
      add(near);
    }
    break;
  }
  return count_ > 1;
}

/// The walls as planes, as they are at the proxy: where they fold, or their fields end.
LocalProjection FeltWalls::ontoPlanes(const Group& group, const Vec3& place) const noexcept {
  LocalProjection out;
  std::array<Plane, kMaxProjectionWalls> planes{};
  const Vec3 x = walker_.position();
  for (std::size_t i = 0; i < group.count; ++i) {
    const HeldWall& held = group.held[i];
    const double slope = glm::length(held.jet.gradient);
    planes[i] = {held.normal,
                 slope > 0.0 ? std::max(0.0, held.side * held.jet.value / slope) : 0.0};
  }
  const PlaneSolution s = closestStep(place - x, {planes.data(), group.count});
  out.at = x + s.step;
  for (std::size_t k = 0; k < static_cast<std::size_t>(s.count); ++k) {
    out.held[k] = group.held[static_cast<std::size_t>(s.plane[k])];
    out.held[k].jet.hessian = Mat3(0.0);
    out.held[k].multiplier = s.multiplier[k];
  }
  out.count = static_cast<std::size_t>(s.count);
  out.settled = true;
  return out;
}

void FeltWalls::look(std::size_t index, const Vec3& from, const Vec3& place,
                     SoftWalls& out) noexcept {
  const Group& group = group_[index];
  const std::span<const HeldWall> held(group.held.data(), group.count);
  LocalProjection on = projectLocally(from, place, held);
  if (!on.settled) on = projectLocally(walker_.position(), place, held);
  if (!on.settled) on = ontoPlanes(group, place);
  if (on.count > 0) {
    const Near* wall = &group.wall[0];
    for (std::size_t i = 0; i < group.count; ++i) {
      if (group.held[i].field == on.held[0].field) wall = &group.wall[i];
    }
    out.felt = felt(wall->leaf, wall->facet, on.held[0], on.at, smoothed_[index]);
  }
  out.on = on;
}

}  // namespace palpate
