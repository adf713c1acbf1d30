#include <algorithm>
#include <cmath>

#include "proxy_solver.h"
#include "step_checks.h"

// One step of the proxy: along the tangent, corrected for curvature and brought back onto the
// walls, to the best point of a cell that it reaches. The way back onto the walls is in
// proxy_restore.cpp; cuts, which are learned from refused steps, are in proxy_cuts.cpp.

namespace palpate {

/// The sum of multiplier * Hessian of the distance over the walls that hold the solution.
Mat3 ProxySolver::bendOf(const CellProblem& problem) const noexcept {
  Mat3 sum(0.0);
  const PlaneSolution& s = problem.solution;
  for (int k = 0; k < s.count; ++k) {
    const Source& from =
        problem.source[static_cast<std::size_t>(s.plane[static_cast<std::size_t>(k)])];
    const Mat3& bend = from.isCut() ? cut_[static_cast<std::size_t>(from.cut)].bend
                                    : near_.walls()[from.near].bend;
    const double weight = s.multiplier[static_cast<std::size_t>(k)];
    sum += (from.inside ? -weight : weight) * bend;
  }
  return sum;
}

/// [m] How far the proxy may go along the walls that hold the solution before their normals have
/// turned as much as one step may.
double ProxySolver::turningLength(const CellProblem& problem) const noexcept {
  double bend = 0.0;
  double feature = kInfinity;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    if (problem.source[i].isCut() || !problem.holds(i)) continue;
    const NearWall& wall = near_.walls()[problem.source[i].near];
    bend = std::max(bend, wall.bend_size);
    feature = std::min(feature, walker_.leaf(wall.leaf).feature);
  }
  const double most = limits::kShareOfFeature * feature;
  return bend > 0.0 ? std::min(most, limits::kLargestTurn / bend) : 0.0;
}

/// [m] How far apart two places on the walls may be that are equally good within the tolerances.
double ProxySolver::noiseOf(const CellProblem& problem) const noexcept {
  double out = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    out = std::max(out, limits::kNoise * near_.walls()[problem.source[i].near].tolerance);
  }
  return out;
}

/// [m] Distance from the end of the step to the nearest wall of the cell that does not hold it.
double ProxySolver::roomOf(const CellProblem& problem) noexcept {
  double room = kInfinity;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    if (problem.holds(i)) continue;
    const Plane& plane = problem.plane[i];
    room = std::min(room, plane.gap + glm::dot(plane.normal, problem.solution.step));
  }
  return room;
}

/// Whether the same walls hold both solutions.
bool ProxySolver::areHeldAlike(const CellProblem& a, const CellProblem& b) noexcept {
  if (a.solution.count != b.solution.count) return false;
  for (std::size_t k = 0; k < static_cast<std::size_t>(a.solution.count); ++k) {
    const Source& of_a = a.source[static_cast<std::size_t>(a.solution.plane[k])];
    const Source& of_b = b.source[static_cast<std::size_t>(b.solution.plane[k])];
    if (of_a.near != of_b.near || of_a.inside != of_b.inside || of_a.cut != of_b.cut) return false;
  }
  return true;
}

/// Returns the cell with the most room among those whose solutions are held by the same walls as
/// the first cell's solution. So the result does not depend on the order of the walls, for example
/// of the faces of a box, which changes when the scene is rotated.
std::size_t ProxySolver::roomiest() const noexcept {
  std::size_t best = 0;
  for (std::size_t i = 1; i < problems_; ++i) {
    if (areHeldAlike(problem_[i], problem_[0]) && roomOf(problem_[i]) > roomOf(problem_[best])) {
      best = i;
    }
  }
  return best;
}

/// A step in one of the cells that hold the proxy; kRests if there is no step to make in any of
/// them.
ProxySolver::Try ProxySolver::moveOn() noexcept {
  double longest = 0.0;
  double noise = 0.0;
  for (std::size_t i = 0; i < problems_; ++i) {
    const CellProblem& problem = problem_[i];
    noise = std::max(noise, noiseOf(problem));
    const CurvedStep curved = curvedStep(aim_, problem.given(), problem.solution, bendOf(problem),
                                         limits::kLeastEigenvalue);
    longest = std::max({longest, glm::length(problem.solution.step), glm::length(curved.step)});
    if (curved.lowest < limits::kSaddle) longest = std::max(longest, turningLength(problem));
  }
  // No better point is further away than twice the distance to the aim. The ball is at least as
  // large as the noise of the walls, since the way back onto them may be that long however short
  // the step.
  const double whole =
      std::max(std::min(limits::kBallOverStep * longest, 2.0 * glm::length(aim_)), noise);
  double ball = whole;
  bool rests = false;
  for (int shrink = 0; shrink <= limits::kShrinks && batches_left_ > 0; ++shrink) {
    while (!lookWithin(limits::kReachOverStep * ball)) {
      ball *= 0.5;
      if (ball <= rest_) return Try::kRefused;
    }
    poseAll(aim_);
    rests = true;
    const std::size_t first = roomiest();
    for (std::size_t n = 0; n < problems_; ++n) {
      const std::size_t i = n == 0 ? first : n == first ? 0 : n;
      const Try outcome = tryCell(problem_[i], ball);
      if (outcome == Try::kMoved) return outcome;
      rests = rests && outcome == Try::kRests;
    }
    if (rests) {
      takeContact(problem_[0]);
      contact_.lag = wish_ - aim_;
      return Try::kRests;
    }
    ball *= limits::kShrink;
    if (ball <= rest_) break;
  }
  return flyOff(whole) ? Try::kMoved : Try::kRefused;
}

/// Just before a sharp edge of one leaf, no step along its wall ends on a wall again: step over the
/// edge into free space.
bool ProxySolver::flyOff(double ball) noexcept {
  if (!lookWithin(limits::kReachOverStep * ball)) return false;
  poseAll(aim_);
  for (std::size_t i = 0; i < problems_; ++i) {
    for (const double share : limits::kFlights) {
      if (batches_left_ <= 0) return false;
      const Vec3 step = share * problem_[i].solution.step;
      if (tryStep(problem_[i], step, ball, StepRule::kMayFly)) return true;
    }
  }
  return false;
}

ProxySolver::Try ProxySolver::tryCell(CellProblem& problem, double ball) noexcept {
  Vec3 step(0.0);
  const Vec3 first = problem.solution.step;
  bool is_refined = false;
  bool ends_free = false;
  for (int round = 0; round < limits::kCutRounds && batches_left_ > 0; ++round) {
    // A cut that was met far away is not exact: before a short step or rest it is met again from
    // close by.
    if (!is_refined && lookCloser(problem, first)) {
      is_refined = true;
      pose(problem.cell, problem);
      solve(problem, aim_);
      continue;
    }
    if (glm::length(problem.solution.step) <= rest_) return Try::kRests;
    const Mat3 bend = bendOf(problem);
    const CurvedStep curved =
        curvedStep(aim_, problem.given(), problem.solution, bend, limits::kLeastEigenvalue);
    step = curved.step;
    if (curved.lowest < limits::kSaddle) {
      // Down from a saddle every step gains, and a longer one gains more: go as far as the normal
      // may turn.
      const double far = std::min(turningLength(problem), ball);
      const double length = glm::length(step);
      if (far > limits::kFarther * length && length > 0.0 &&
          tryStep(problem, (far / length) * step, ball, StepRule::kUsual)) {
        return Try::kMoved;
      }
    }
    const Vec3& plain = problem.solution.step;
    // Near a singular point the curvature does not describe the wall over the length of the step.
    if (glm::length(step) < limits::kSingularStep * glm::length(plain) &&
        glm::length(bend * plain) > limits::kSingularTurn * glm::length(aim_)) {
      step = plain;
    }
    // A proxy that approaches a sharp edge by ever shorter steps goes over it after a few of them.
    if (tryStep(problem, step, ball,
                hops_ < limits::kHops ? StepRule::kUsual : StepRule::kMayFly)) {
      return Try::kMoved;
    }
    if (leads_nowhere_) return Try::kRests;
    ends_free = hasLandedFree(problem);
    if (!addCuts(problem) && !lookFar(problem, plain, ball)) break;
    pose(problem.cell, problem);
    solve(problem, aim_);
  }
  for (const double share : limits::kShorter) {
    if (batches_left_ <= 0) break;
    if (!tryStep(problem, share * step, ball, StepRule::kUsual)) continue;
    hops_ += ends_free ? 1 : 0;
    return Try::kMoved;
  }
  return Try::kRefused;
}

/// Shortens a step to the ball, to the walls' feature sizes, and to the largest turn of a normal.
Vec3 ProxySolver::limited(const CellProblem& problem, const Vec3& step,
                          double ball) const noexcept {
  double most = ball;
  double turn = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    const NearWall& wall = near_.walls()[from.near];
    if (from.isCut()) continue;
    const Leaf& leaf = walker_.leaf(wall.leaf);
    // A step shorter than the distance to a wall cannot land on its other side.
    const double safe = std::fabs(wall.distance) * std::min(1.0, wall.slope / leaf.lipschitz);
    if (!leaf.is_flat) {
      // A longer step is possible in up to kMostStrides strides, if the wall turns little over it.
      const double turned = limits::kLargestTurn / std::max(wall.bend_size, 1.0 / ball);
      const double seen = std::min(turned, limits::kMostStrides * limits::kStride * leaf.feature);
      most = std::min(most, std::max({limits::kShareOfFeature * leaf.feature, safe, seen}));
    }
    if (problem.holds(i)) turn = std::max(turn, glm::length(wall.bend * step));
  }
  // For a wall outside its band only a bound of the distance is known.
  const std::span<const NearWall> walls = near_.walls();
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const std::uint32_t bit = std::uint32_t{1} << i;
    if (((problem.cell.inside | problem.cell.outside) & bit) == 0 || walls[i].slope > 0.0) continue;
    most = std::min(most,
                    std::max(limits::kFlattest * std::fabs(walls[i].distance), walls[i].tolerance));
  }
  double share = 1.0;
  const double length = glm::length(step);
  if (length > most) share = most / length;
  if (turn * share > limits::kLargestTurn) share = limits::kLargestTurn / turn;
  return share < 1.0 ? share * step : step;
}

bool ProxySolver::tryStep(const CellProblem& problem, const Vec3& step, double ball,
                          StepRule rule) noexcept {
  const Vec3 by = limited(problem, step, ball);
  const double length = glm::length(by);
  if (!(length > 0.0)) return false;
  // A step that was cut short does not reach all the walls that hold the full step.
  reached_ = 0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const double left = problem.plane[i].gap + glm::dot(problem.plane[i].normal, by);
    if (problem.holds(i) && std::fabs(left) <= limits::kGain * length) {
      reached_ |= std::uint64_t{1} << i;
    }
  }
  Vec3 y = x_ + by + bentBack(problem, by);
  has_landed_ = false;
  leads_nowhere_ = false;
  if (!restore(problem, y, length)) {
    if (rule != StepRule::kMayFly || !hasLandedFree(problem)) return false;
    y = landed_at_;
  }
  const Vec3 moved = y - x_;
  if (glm::length(moved) > limits::kReachOverStep * ball) return false;
  // The squared distance to the aim before and after the step, and the reduction that the step
  // promised.
  const Vec3 after = aim_ - moved;
  const Vec3 promised = aim_ - by;
  const double before = glm::dot(aim_, aim_);
  const double promise = std::max(0.0, before - glm::dot(promised, promised));
  const double noise = noiseOf(problem);
  const double slack = noise * std::sqrt(before);
  const double gain = before - glm::dot(after, after);
  if (!trusts_sides_) {
    // This does not apply to a proxy beyond its walls, which must come back at any cost.
    const double least = rule == StepRule::kMustGain ? slack : limits::kGain * promise - slack;
    if (gain < least) return false;
    if (glm::length(moved) <= limits::kNowhere * rest_) {
      leads_nowhere_ = length <= noise;
      return false;
    }
  }
  if (!keepsOnWay(problem, y) || !go(problem, y)) return false;
  const double left = glm::dot(after, after);
  nearest_ = std::min(nearest_, before);
  const bool is_back = std::any_of(before_.begin(), before_.end(), [&](const Vec3& p) {
    return glm::length(y - p) <= limits::kNowhere * rest_;
  });
  const bool is_nearer = left < (1.0 - limits::kRoundedGain) * nearest_;
  const bool is_idle = is_back || (glm::length(moved) <= noise && !is_nearer);
  idle_steps_ = is_idle ? idle_steps_ + 1 : 0;
  wander_.in_vain += is_nearer ? 0 : 1;
  wander_.farthest = std::max(wander_.farthest, glm::length(y - wander_.from) / noise);
  is_nearest_ = left <= (1.0 + limits::kRoundedGain) * nearest_;
  nearest_ = std::min(nearest_, left);
  std::rotate(before_.begin(), before_.end() - 1, before_.end());
  before_.front() = y - moved;
  return true;
}

/// Whether the chord to `y` [m] stays in the cell, except where the curvature of the walls makes it
/// dip.
bool ProxySolver::keepsOnWay(const CellProblem& problem, const Vec3& y) noexcept {
  const double length = glm::length(y - x_);
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    const NearWall& wall = near_.walls()[from.near];
    if (from.isCut()) continue;
    const Leaf& own = walker_.leaf(wall.leaf);
    if (!own.is_flat && length > limits::kShareOfFeature * own.feature &&
        std::fabs(wall.distance) < length) {
      // Less than the thickness of a thin wall: a chord through a wall is not a way along another.
      const double dip =
          std::min(dipOfChord(wall.bend_size, length), limits::kShareOfFeature * own.feature);
      const int strides = static_cast<int>(std::ceil(length / (limits::kStride * own.feature)));
      batches_left_ -= strides / limits::kStridesPerBatch;
      for (int k = 1; k < strides; ++k) {
        const Vec3 p = x_ + (static_cast<double>(k) / strides) * (y - x_);
        const double gap = (from.inside ? -1.0 : 1.0) * own.field->value(p) / wall.slope;
        if (gap < -dip - wall.tolerance) return false;
      }
      continue;
    }
    const double scale = (from.inside ? -1.0 : 1.0) / wall.slope;
    if (!keepsOnChord(*own.field, x_, y, scale, wall.bend_size, wall.tolerance)) return false;
  }
  return true;
}

/// Goes to `y` [m], or up to the first opening on the way in a wall that holds the proxy.
bool ProxySolver::go(const CellProblem& problem, const Vec3& y) noexcept {
  std::array<LeafId, kMaxNear> near{};
  const std::span<const NearWall> walls = near_.walls();
  for (std::size_t i = 0; i < walls.size(); ++i) near[i] = walls[i].leaf;
  std::array<LeafId, 3> held{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < problem.planes && count < held.size(); ++i) {
    if (isReached(i)) held[count++] = walls[problem.source[i].near].leaf;
  }
  const std::span<const LeafId> leaves(near.data(), walls.size());
  const CellWalker::Slid slid = walker_.slideTo(y, problem.cell, leaves, {held.data(), count});
  if (slid.arrived) return true;
  // The point where the opening begins: on the walls that hold the proxy, and on the leaf that was
  // passed there.
  Vec3 rim = x_ + slid.share * (y - x_);
  const double length = std::max(glm::length(y - x_), rest_);
  rim_ = static_cast<int>(slid.leaf);
  const bool is_there = restore(problem, rim, length);
  rim_ = -1;
  if (is_there) {
    walker_.jump(rim);
  } else {
    (void)walker_.slideTo(y, problem.cell, leaves, {});
  }
  return true;
}

/// Called at a first-order minimum: checks whether the proxy can come closer by the second order.
bool ProxySolver::kick() noexcept {
  const CellProblem& first = problem_[0];
  const PlaneSolution& s = first.solution;
  double bend = 0.0;
  double feature = kInfinity;
  for (int k = 0; k < s.count; ++k) {
    const auto index = static_cast<std::size_t>(s.plane[static_cast<std::size_t>(k)]);
    if (first.source[index].isCut()) return false;
    const NearWall& wall = near_.walls()[first.source[index].near];
    bend += s.multiplier[static_cast<std::size_t>(k)] * wall.bend_size;
    feature = std::min(feature, walker_.leaf(wall.leaf).feature);
  }
  if (bend < 1.0) return false;
  const CurvedStep curved =
      curvedStep(aim_, first.given(), s, bendOf(first), limits::kLeastEigenvalue);
  if (curved.lowest >= limits::kSaddle) return false;
  for (const double share : limits::kKicks) {
    const double length = share * feature;
    if (!lookWithin(limits::kReachOverStep * length)) continue;
    poseAll(aim_);
    for (std::size_t i = 0; i < problems_; ++i) {
      for (const double way : {length, -length}) {
        if (batches_left_ <= 0) return false;
        if (tryStep(problem_[i], way * curved.downhill, length, StepRule::kMustGain)) return true;
      }
    }
  }
  return false;
}

}  // namespace palpate
