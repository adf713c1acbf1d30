#include "proxy_solver.h"

#include <algorithm>
#include <cmath>

// The tick: look around, and go on until the proxy rests. How one step is made: proxy_step.cpp.

namespace palpate {

double ContactSet::load() const noexcept {
  Vec3 sum(0.0);
  for (const WallContact& each : walls()) sum += each.held.multiplier * each.held.normal;
  return glm::length(sum);
}

HeldWalls ContactSet::held() const noexcept {
  HeldWalls out;
  for (const WallContact& each : walls()) out.wall[out.count++] = each.held;
  return out;
}

bool ProxySolver::CellProblem::holds(std::size_t plane_index) const noexcept {
  for (int k = 0; k < solution.count; ++k) {
    if (solution.plane[static_cast<std::size_t>(k)] == static_cast<int>(plane_index)) return true;
  }
  return false;
}

bool ProxySolver::track(const Vec3& hip, FrictionState& friction, WallOpener& opener) noexcept {
  batches_left_ = limits::kMaxBatches;
  idle_steps_ = 0;
  nearest_ = kInfinity;
  before_.fill(Vec3(kInfinity));
  hops_ = 0;
  crossed_ = {};
  trusts_sides_ = false;
  contact_.clear();
  if (goQuickly(hip, friction) && !opener.open(contact_)) return true;
  bool may_fly = true;
  for (bool is_first = true; batches_left_ > 0; is_first = false) {
    x_ = walker_.position();
    wish_ = hip - x_;
    aim_ = wish_;
    if (wish_ == Vec3(0.0)) {
      contact_.clear();
      friction.sticks = false;
      return true;
    }
    Try outcome = Try::kMoved;
    switch (lookAround(friction, is_first)) {
      case Look::kNowhere:
        takeLastContact(hip);
        return false;
      case Look::kCrossed:
        may_fly = true;
        continue;
      case Look::kFree: {
        friction.sticks = false;
        contact_.clear();
        if (may_fly) {
          const CellWalker::Stop stop = walker_.move(hip, false);
          if (stop == CellWalker::Stop::kArrived) return true;
          const double flown = glm::length(walker_.position() - x_);
          if (stop == CellWalker::Stop::kSpent && flown <= rest_) return false;
          // Stopped at once by a wall that it leads along: from here in steps that keep to the walls.
          may_fly = flown > rest_;
          continue;
        }
        outcome = moveOn();
        break;
      }
      case Look::kMoves:
        outcome = moveOn();
        break;
      case Look::kRests:
        outcome = Try::kRests;
        break;
    }
    if (outcome == Try::kMoved) {
      if (idle_steps_ >= limits::kIdleSteps + (is_nearest_ ? 0 : limits::kIdleMore)) {
        takeLastContact(hip);
        return true;
      }
      may_fly = true;
      continue;
    }
    // Only at rest does the spring of the wall have the length that is felt: a tangent plane that one tick's
    // motion left behind may be pressed harder, and must not open what was never pressed so.
    if (opener.open(contact_)) continue;
    if (outcome == Try::kRefused) return false;
    if (friction.sticks || !kick()) return true;
  }
  takeLastContact(hip);
  return false;
}

double ProxySolver::restLength(const Vec3& x, const Vec3& wish) noexcept {
  const double size = std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
  return std::max(limits::kSettled * glm::length(wish), limits::kRounding * size);
}

/// Out of budget on the way: the walls that hold the proxy where it got to.
void ProxySolver::takeLastContact(const Vec3& hip) noexcept {
  x_ = walker_.position();
  wish_ = hip - x_;
  cuts_ = 0;
  const Vec3 lag = contact_.lag;
  const bool is_known = lookWithin(rest_);
  if (is_known) poseAll(wish_);
  if (!is_known || problems_ == 0 || problem_[0].solution.count == 0) {
    contact_.clear();
    return;
  }
  takeContact(problem_[0]);
  contact_.lag = lag;
}

/// Looks at what touches the proxy: whether it is free to go, rests, stands at an opening, or has to slide.
ProxySolver::Look ProxySolver::lookAround(FrictionState& friction, bool is_first) noexcept {
  --batches_left_;
  rest_ = restLength(x_, wish_);
  cuts_ = 0;
  if (!lookWithin(rest_)) return Look::kNowhere;
  poseAll(wish_);
  for (std::size_t i = 0; i < problems_; ++i) {
    if (problem_[i].solution.count == 0) return Look::kFree;
  }
  for (std::size_t i = 0; i < problems_; ++i) {
    const CellProblem& problem = problem_[i];
    for (int k = 0; k < problem.solution.count; ++k) {
      const Source& from = problem.source[static_cast<std::size_t>(
          problem.solution.plane[static_cast<std::size_t>(k)])];
      const NearWall& wall = near_.walls()[from.near];
      if (wall.gap(from.inside) > limits::kOnWall * wall.tolerance + rest_) continue;
      const Facet facet = walker_.facetAt(wall.leaf);
      if (facet.isClosed() || facet.kind == Facet::Kind::kInternal) continue;
      if (!goesOnInto(facet.beyond, problem)) continue;
      if (!walker_.mayCross()) return Look::kNowhere;
      walker_.cross(wall.leaf, facet);
      return Look::kCrossed;
    }
  }
  takeContact(problem_[0]);
  holdByFriction(friction, is_first);
  if (contact_.lag != Vec3(0.0)) {
    aim_ = wish_ - contact_.lag;
    for (std::size_t i = 0; i < problems_; ++i) solve(problem_[i], aim_);
  }
  for (std::size_t i = 0; i < problems_; ++i) {
    if (glm::length(problem_[i].solution.step) > rest_) return Look::kMoves;
  }
  return Look::kRests;
}

/// Whether the proxy goes on into `beyond`, which is open. At an edge where two regions that lead freely into each other
/// both end at walls, the hand may draw it into each from the other. Back where it was at this place it does not go, unless
/// a step leads on from there and none does from here; then it does not come again.
bool ProxySolver::goesOnInto(RegionId beyond, const CellProblem& problem) noexcept {
  if (crossed_.place != x_) crossed_ = {.place = x_};
  const bool leads_on = glm::length(problem.solution.step) > rest_;
  auto* const end = crossed_.from.begin() + static_cast<std::ptrdiff_t>(crossed_.count);
  const auto* const back = std::find_if(
      crossed_.from.begin(), end, [&](const Crossed::From& each) { return each.region == beyond; });
  if (back != end) {
    if (leads_on || !back->leads_on || crossed_.is_last) return false;
    crossed_.is_last = true;
  }
  if (crossed_.count == crossed_.from.size()) return false;
  crossed_.from[crossed_.count++] = {walker_.region(), leads_on};
  return true;
}

/// Near walls and cells within `radius` [m]. Where no cell holds the proxy (a field that lies about its bound
/// let it through), the walker's sides say where it belongs. False if it cannot be told.
bool ProxySolver::lookWithin(double radius) noexcept {
  trusts_sides_ = false;
  if (!near_.look(radius, false)) return false;
  if (!near_.cells().empty()) return true;
  trusts_sides_ = true;
  return near_.look(radius, true) && !near_.cells().empty();
}

void ProxySolver::poseAll(const Vec3& wish) noexcept {
  problems_ = 0;
  for (const NearCell& cell : near_.cells()) {
    CellProblem& problem = problem_[problems_++];
    pose(cell, problem);
    solve(problem, wish);
  }
  if (problems_ > 1) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < problems_; ++i) {
      if (problem_[i].gain > problem_[best].gain) best = i;
    }
    if (best != 0) std::swap(problem_[0], problem_[best]);
  }
}

void ProxySolver::pose(const NearCell& cell, CellProblem& out) const noexcept {
  out.cell = cell;
  out.planes = 0;
  const std::span<const NearWall> walls = near_.walls();
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    if (((cell.inside | cell.outside) & bit) == 0 || !(walls[i].slope > 0.0)) continue;
    const bool inside = (cell.inside & bit) != 0;
    const NearWall& wall = walls[i];
    const double left = wall.gap(inside) - limits::kRest * wall.tolerance;
    const bool is_on = std::fabs(left) <= (limits::kOnWall - limits::kRest) * wall.tolerance;
    out.add({inside ? -wall.normal : wall.normal, is_on ? 0.0 : left},
            {static_cast<std::uint8_t>(i), inside, -1});
    for (std::size_t c = 0; c < cuts_; ++c) {
      if (cut_[c].leaf == wall.leaf && cut_[c].inside == inside) {
        out.add(cut_[c].plane,
                {static_cast<std::uint8_t>(i), inside, static_cast<std::int16_t>(c)});
      }
    }
  }
}

void ProxySolver::solve(CellProblem& problem, const Vec3& wish) const noexcept {
  problem.solution = closestStep(wish, problem.given());
  const Vec3 left = wish - problem.solution.step;
  problem.gain = glm::dot(wish, wish) - glm::dot(left, left);
}

namespace {

/// The part of `wish` along the planes that hold `solution`.
Vec3 tangentialStep(const Vec3& wish, const std::array<Plane, 3>& planes,
                    const PlaneSolution& solution) noexcept {
  HeldWalls held;
  for (int k = 0; k < solution.count; ++k) {
    const auto i = static_cast<std::size_t>(k);
    held.wall[held.count++].normal = planes[static_cast<std::size_t>(solution.plane[i])].normal;
  }
  return tangentialPart(wish, held.walls());
}

}  // namespace

/// The walls that hold the solution. How hard each is pressed is measured from its surface: the proxy stands
/// off by half a tolerance.
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
  // Walls that are almost parallel may meet far off: then they are taken to meet where the proxy stands.
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
  contact_.left = tangentialPart(wish_, contact_.held().walls());
}

/// On the rim of a union the facet of one part leads into the other, and the walker may be on either side of the leaves that
/// meet there. Seen from the cell the facet is a wall on one side or the other of the leaves that the cell leaves open: the
/// material of that wall; -1 if none was found.
int ProxySolver::materialAside(const CellProblem& problem, std::size_t near) noexcept {
  const std::span<const NearWall> walls = near_.walls();
  const LeafId surface = walls[near].leaf;
  // First those that the cell has on the other side than the walker, then those that it leaves open.
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
  const auto materialBeyond = [&](std::span<const LeafId> others) {
    std::copy(others.begin(), others.end(), turned.begin() + static_cast<std::ptrdiff_t>(asked));
    return walker_
        .facetAside({turned.data(), asked + others.size()}, {&surface, 1}, walker_.position())
        .material;
  };
  int material = -1;
  for (std::size_t i = 0; i < opens && material < 0; ++i) material = materialBeyond({&open[i], 1});
  return material < 0 ? materialBeyond({open.data(), opens}) : material;
}

/// A wall of which that is not known is of the material of another that holds the proxy; else as in this tick's `last`
/// contact; else as some wall that its region has.
void ProxySolver::nameMaterials(int last) noexcept {
  const auto end = contact_.wall.begin() + static_cast<std::ptrdiff_t>(contact_.count);
  const auto known = std::find_if(contact_.wall.begin(), end,
                                  [](const WallContact& each) { return each.facet.material >= 0; });
  int material = known != end ? known->facet.material : last;
  const std::size_t regions = scene_.regions().size();
  for (std::size_t to = 0; material < 0 && to < regions; ++to) {
    if (to == walker_.region()) continue;
    material = scene_.passages().wall(walker_.region(), static_cast<RegionId>(to)).material;
  }
  for (auto each = contact_.wall.begin(); each != end; ++each) {
    if (each->facet.material < 0) each->facet.material = std::max(material, 0);
  }
}

/// Of several walls the roughest counts, for the load of all.
void ProxySolver::holdByFriction(FrictionState& friction, bool is_first) noexcept {
  ContactSet& c = contact_;
  FrictionRatios ratios;
  for (const WallContact& each : c.walls()) ratios.take(frictionOf(each.facet), x_);
  const Vec3 rest = tangentialPart(friction.lean, c.held().walls());
  c.lag = lagOf(ratios, c.left, rest, c.load(), is_first, friction);
}

/// The cone: while it sticks the proxy may lag by static_ratio of the load, else it slides until it lags
/// by kinetic_ratio of it. Where stiffness varies, its own lean pulls at the proxy too: the cone is about where the
/// proxy would rest without friction. So the lean is felt through the lag, the same whether it sticks or slides.
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
  // What slides sticks again when the hand no longer pulls it on, which shows when a tick begins: at the
  // end of its own slide it is always where the cone just holds it, and a hand that moves on would
  // feel a saw.
  if (!friction.sticks && is_first && pull <= kinetic * (1.0 + limits::kSticksWithin)) {
    friction.sticks = true;
  }
  return friction.sticks || pull <= kinetic ? pulled : rest + off * (kinetic / pull);
}

}  // namespace palpate
