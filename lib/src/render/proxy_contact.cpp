// ProxySolver's contact: the walls that hold the proxy, each with its own material, and the effect
// of friction on them.

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <span>

#include "palpate/interior/port_machine.h"
#include "proxy_solver.h"
#include "solver_limits.h"

namespace palpate {
namespace {

/// The part of `wish` along the planes that hold `solution`.
Vec3 tangentialStep(const Vec3& wish, const std::array<Plane, 3>& planes,
                    const PlaneSolution& solution) noexcept {
  std::array<Vec3, 3> normals;
  const auto count = static_cast<std::size_t>(solution.count);
  for (std::size_t k = 0; k < count; ++k) {
    normals[k] = planes[static_cast<std::size_t>(solution.plane[k])].normal;
  }
  return partAcross(wish, {normals.data(), count});
}

}  // namespace

/// Takes the walls that hold the solution. The pressure on each is measured from its surface, since
/// the proxy stands off by half a tolerance.
void ProxySolver::takeContact(const CellProblem& problem) noexcept {
  const PlaneSolution& s = problem.solution;
  const int last = contact_.count > 0 ? contact_.wall[0].facet.material : -1;
  contact_.count = 0;
  contact_.lag = Vec3(0.0);
  contact_.snug = Vec3(0.0);
  double most = 0.0;
  std::array<Plane, 3> planes{};
  std::array<const Source*, 3> source{};
  const auto count = static_cast<std::size_t>(s.count);
  for (std::size_t k = 0; k < count; ++k) {
    const auto index = static_cast<std::size_t>(s.plane[k]);
    source[k] = &problem.source[index];
    planes[k] = problem.plane[index];
    const NearWall& wall = near_.walls()[source[k]->near];
    if (!source[k]->isCut() && planes[k].gap == 0.0) planes[k].gap = wall.gap(source[k]->inside);
    most = std::max(most, limits::kNoise * wall.tolerance + planes[k].gap);
  }
  PlaneSolution exact = closestStep(wish_, {planes.data(), count});
  // Walls that are almost parallel may meet far away: then they are taken to meet where the proxy
  // stands.
  const Vec3 onto = exact.step - tangentialStep(wish_, planes, exact);
  if (glm::length(onto) > most) {
    for (Plane& plane : planes) plane.gap = 0.0;
    exact = closestStep(wish_, {planes.data(), count});
  } else {
    contact_.snug = onto;
  }
  for (std::size_t e = 0; e < static_cast<std::size_t>(exact.count); ++e) {
    const auto k = static_cast<std::size_t>(exact.plane[e]);
    const Source& from = *source[k];
    const NearWall& wall = near_.walls()[from.near];
    WallContact& out = contact_.wall[contact_.count++];
    out.leaf = wall.leaf;
    out.facet = walker_.facetAt(wall.leaf);
    if (out.facet.material < 0) out.facet.material = materialAside(problem, from.near);
    out.held.field = walker_.leaf(wall.leaf).field.get();
    out.held.side = from.inside ? -1.0 : 1.0;
    out.held.jet = walker_.jetHere(wall.leaf);
    out.held.normal = planes[k].normal;
    if (from.isCut()) {
      out.held.jet.gradient = out.held.side * wall.slope * out.held.normal;
      out.held.jet.hessian = wall.slope * cut_[static_cast<std::size_t>(from.cut)].bend;
    }
    out.held.multiplier = exact.multiplier[e];
  }
  nameMaterials(last);
  contact_.left = contact_.along(wish_);
}

/// On the rim of a union the facet of one part leads into the other, and the walker may be on
/// either side of the leaves that meet there. Seen from the cell, the facet is a wall on one of the
/// sides of the leaves that the cell leaves undecided. Returns the material of that wall; -1 if
/// none was found.
int ProxySolver::materialAside(const CellProblem& problem, std::size_t near) noexcept {
  const std::span<const NearWall> walls = near_.walls();
  const LeafId surface = walls[near].leaf;
  // First the leaves whose side differs between the cell and the walker, then those that the cell
  // leaves undecided.
  std::array<LeafId, kMaxNear> turned{};
  std::array<LeafId, kMaxNear> open{};
  std::size_t asked = 0;
  std::size_t opens = 0;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const LeafId leaf = walls[i].leaf;
    const bool inside = ((problem.cell.inside >> i) & 1U) != 0;
    if (inside || ((problem.cell.outside >> i) & 1U) != 0) {
      if (inside != (walker_.side(leaf) < 0.0)) turned[asked++] = leaf;
    } else if (std::fabs(walls[i].distance) <= limits::kOnWall * walls[i].tolerance + rest_) {
      open[opens++] = leaf;
    }
  }
  const auto material_beyond = [&](std::span<const LeafId> others) {
    std::copy(others.begin(), others.end(), turned.begin() + static_cast<std::ptrdiff_t>(asked));
    return walker_
        .facetAside({turned.data(), asked + others.size()}, {&surface, 1}, walker_.position())
        .material;
  };
  int material = -1;
  for (std::size_t i = 0; i < opens && material < 0; ++i) material = material_beyond({&open[i], 1});
  return material < 0 ? material_beyond({open.data(), opens}) : material;
}

/// A wall whose material is unknown takes that of another wall that holds the proxy, else that of
/// this tick's `last` contact, else that of any wall of the region.
void ProxySolver::nameMaterials(int last) noexcept {
  auto* const end = contact_.wall.begin() + static_cast<std::ptrdiff_t>(contact_.count);
  const auto* const known = std::find_if(
      contact_.wall.begin(), end, [](const WallContact& each) { return each.facet.material >= 0; });
  int material = known != end ? known->facet.material : last;
  const std::size_t regions = scene_.regions().size();
  for (std::size_t to = 0; material < 0 && to < regions; ++to) {
    if (to == walker_.region()) continue;
    material = scene_.passages().wall(walker_.region(), static_cast<RegionId>(to)).material;
  }
  for (auto* each = contact_.wall.begin(); each != end; ++each) {
    if (each->facet.material < 0) each->facet.material = std::max(material, 0);
  }
}

/// If several walls hold the proxy, the largest friction ratios apply to the load of all.
void ProxySolver::holdByFriction(FrictionState& friction, bool is_first) noexcept {
  ContactSet& c = contact_;
  FrictionRatios ratios;
  for (const WallContact& each : c.walls()) ratios.take(frictionOf(each.facet), x_);
  const Vec3 rest = c.along(friction.lean);
  c.lag = lagOf(ratios, c.left, rest, c.load(), is_first, friction);
}

/// The friction cone: while it sticks, the proxy may lag by static_ratio of the load; else it
/// slides until it lags by kinetic_ratio of it. Where stiffness varies, its gradient pulls at the
/// proxy too, so the cone is centered on where the proxy would rest without friction. Thus this
/// pull acts through the lag, the same whether the proxy sticks or slides.
Vec3 ProxySolver::lagOf(const FrictionRatios& ratios, const Vec3& pulled, const Vec3& rest,
                        double load, bool is_first, FrictionState& friction) const noexcept {
  friction.is_felt = ratios.at_rest > 0.0 && !walker_.isSealed();
  if (!friction.is_felt) {
    friction.sticks = false;
    return Vec3(0.0);
  }
  const Vec3 off = pulled - rest;
  const double pull = glm::length(off);
  const double kinetic = std::min(ratios.sliding, ratios.at_rest) * load;
  if (friction.sticks && pull > ratios.at_rest * load) friction.sticks = false;
  // A sliding proxy sticks again when the hand no longer pulls it on. This is tested only at the
  // beginning of a tick: at the end of its slide the proxy is always on the border of the cone, and
  // if it stuck there, a steadily moving hand would feel a sawtooth.
  if (!friction.sticks && is_first && pull <= kinetic * (1.0 + limits::kSticksWithin)) {
    friction.sticks = true;
  }
  return friction.sticks || pull <= kinetic ? pulled : rest + off * (kinetic / pull);
}

}  // namespace palpate
