#include "proxy_solver.h"

#include <algorithm>
#include <cmath>

// The tick: look around, and go on until the proxy rests. A single step is in proxy_step.cpp.

namespace palpate {

double ContactSet::load() const noexcept {
  Vec3 sum(0.0);
  for (const WallContact& each : walls()) sum += each.held.multiplier * each.held.normal;
  return glm::length(sum);
}

Vec3 ContactSet::along(const Vec3& v) const noexcept {
  std::array<Vec3, 3> normals;
  for (std::size_t i = 0; i < count; ++i) normals[i] = wall[i].held.normal;
  return partAcross(v, {normals.data(), count});
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
  wander_ = {.from = walker_.position()};
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
        wander_ = {.from = x_};
        continue;
      case Look::kFree: {
        friction.sticks = false;
        contact_.clear();
        if (may_fly) {
          const CellWalker::Stop stop = walker_.move(hip, false);
          if (stop == CellWalker::Stop::kArrived) return true;
          const double flown = glm::length(walker_.position() - x_);
          if (stop == CellWalker::Stop::kSpent && flown <= rest_) return false;
          // A wall along the way stopped the flight at once: from here on take steps that follow
          // the walls.
          may_fly = flown > rest_;
          wander_ = {.from = walker_.position()};
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
    // A port may be opened only at rest, when the wall's spring has the length that is felt: before
    // that, the plane left from the last tick may be pressed harder by the motion of one tick, and
    // would open a port that was never really pressed so hard.
    if (opener.open(contact_)) continue;
    if (outcome == Try::kRefused) return goesNowhere();
    if (friction.sticks || !kick()) return true;
  }
  takeLastContact(hip);
  return goesNowhere();
}

/// At an apex in the plane of another wall, steps of a few times the noise may go around the tip
/// for ever.
bool ProxySolver::goesNowhere() const noexcept {
  return !trusts_sides_ && wander_.in_vain >= limits::kIdleSteps &&
         wander_.farthest <= limits::kWanders;
}

double ProxySolver::restLength(const Vec3& x, const Vec3& wish) noexcept {
  const double size = std::max({std::fabs(x.x), std::fabs(x.y), std::fabs(x.z)});
  return std::max(limits::kSettled * glm::length(wish), limits::kRounding * size);
}

/// If the budget ended on the way: takes the walls that hold the proxy where it stopped.
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

/// Looks at the walls that touch the proxy and decides whether it is free to go, rests, stands at
/// an opening, or has to slide.
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

/// Whether the proxy goes on into the open region `beyond`. At an edge where two regions that lead
/// freely into each other both end at walls, the hand may draw the proxy from each into the other.
/// So it does not go back into a region that it left at this place, unless a step leads on from
/// there and none does from here; after that it stays.
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

/// Finds near walls and cells within `radius` [m]. If no cell contains the proxy (a field with a
/// false Lipschitz bound let it through), the walker's sides decide where it belongs. False if they
/// do not decide it either.
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

}  // namespace palpate
