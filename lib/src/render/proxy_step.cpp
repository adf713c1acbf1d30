#include <algorithm>
#include <cmath>

#include "proxy_solver.h"
#include "step_checks.h"

// One step of the proxy: to the best point of a cell that a tangent, curved and restored step gets to.

namespace palpate {

WallThere ProxySolver::wallAt(std::size_t near, const Vec3& p) const noexcept {
  const LeafId id = near_.walls()[near].leaf;
  return wallOf(id, walker_.leaf(id), walker_.leaf(id).field->sample(p));
}

/// sum of multiplier * Hessian of the distances to the walls that hold the solution.
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

/// [m] How far the walls that hold the solution let the proxy go before their normals have turned as much as one step may.
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

/// A step in one of the cells that hold the proxy; kRests if there is none to make in any.
ProxySolver::Try ProxySolver::moveOn() noexcept {
  double longest = 0.0;
  for (std::size_t i = 0; i < problems_; ++i) {
    const CellProblem& problem = problem_[i];
    const CurvedStep curved = curvedStep(aim_, problem.given(), problem.solution, bendOf(problem),
                                         limits::kLeastEigenvalue);
    longest = std::max({longest, glm::length(problem.solution.step), glm::length(curved.step)});
    if (curved.lowest < limits::kSaddle) longest = std::max(longest, turningLength(problem));
  }
  // No better point is further away than twice the distance to the aim.
  const double whole = std::min(limits::kBallOverStep * longest, 2.0 * glm::length(aim_));
  double ball = whole;
  bool rests = false;
  for (int shrink = 0; shrink <= limits::kShrinks && batches_left_ > 0; ++shrink) {
    while (!lookWithin(limits::kReachOverStep * ball)) {
      ball *= 0.5;
      if (ball <= rest_) return Try::kRefused;
    }
    poseAll(aim_);
    rests = true;
    for (std::size_t i = 0; i < problems_; ++i) {
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

/// Just before a sharp edge of one leaf no step along its wall ends on a wall again: over the edge, into free space.
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
  for (int round = 0; round < limits::kCutRounds && batches_left_ > 0; ++round) {
    if (glm::length(problem.solution.step) <= rest_) {
      // What was met far off is known only so well: asked for again close by before it counts as rest.
      if (is_refined || !lookClose(problem, first)) return Try::kRests;
      is_refined = true;
      pose(problem.cell, problem);
      solve(problem, aim_);
      continue;
    }
    const Mat3 bend = bendOf(problem);
    const CurvedStep curved =
        curvedStep(aim_, problem.given(), problem.solution, bend, limits::kLeastEigenvalue);
    step = curved.step;
    if (curved.lowest < limits::kSaddle) {
      // Down from a saddle every step gains, and the farther the better: as far as the normal may turn.
      const double far = std::min(turningLength(problem), ball);
      const double length = glm::length(step);
      if (far > limits::kFarther * length && length > 0.0 &&
          tryStep(problem, (far / length) * step, ball, StepRule::kUsual)) {
        return Try::kMoved;
      }
    }
    const Vec3& plain = problem.solution.step;
    // Near a singular point the curvature is that of another scale.
    if (glm::length(step) < limits::kSingularStep * glm::length(plain) &&
        glm::length(bend * plain) > limits::kSingularTurn * glm::length(aim_)) {
      step = plain;
    }
    if (tryStep(problem, step, ball, StepRule::kUsual)) return Try::kMoved;
    if (!addCuts(problem)) break;
    pose(problem.cell, problem);
    solve(problem, aim_);
  }
  for (const double share : limits::kShorter) {
    if (batches_left_ <= 0) break;
    if (tryStep(problem, share * step, ball, StepRule::kUsual)) return Try::kMoved;
  }
  return Try::kRefused;
}

/// Shortens a step to the ball, to what the walls' features allow, and to the largest turn.
Vec3 ProxySolver::limited(const CellProblem& problem, const Vec3& step,
                          double ball) const noexcept {
  double most = ball;
  double turn = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    const NearWall& wall = near_.walls()[from.near];
    if (from.isCut()) continue;
    const Leaf& leaf = walker_.leaf(wall.leaf);
    // What stays nearer than a wall is cannot land on its other side.
    const double safe = std::fabs(wall.distance) * std::min(1.0, wall.slope / leaf.lipschitz);
    if (!leaf.is_flat) {
      // A longer step is looked at in strides, as many as there are, where the wall turns little over it.
      const double turned = limits::kLargestTurn / std::max(wall.bend_size, 1.0 / ball);
      const double seen = std::min(turned, limits::kMostStrides * limits::kStride * leaf.feature);
      most = std::min(most, std::max({limits::kShareOfFeature * leaf.feature, safe, seen}));
    }
    if (problem.holds(i)) turn = std::max(turn, glm::length(wall.bend * step));
  }
  // Of a wall out of its band only a bound of the distance is known.
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
  // A step that was cut short does not get to all the walls that hold the whole one.
  reached_ = 0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const double left = problem.plane[i].gap + glm::dot(problem.plane[i].normal, by);
    if (problem.holds(i) && std::fabs(left) <= limits::kGain * length) {
      reached_ |= std::uint64_t{1} << i;
    }
  }
  Vec3 y = x_ + by + bentBack(problem, by);
  has_landed_ = false;
  if (!restore(problem, y, length)) {
    if (rule != StepRule::kMayFly || !hasLandedFree(problem)) return false;
    y = landed_at_;
  }
  const Vec3 moved = y - x_;
  if (glm::length(moved) > limits::kReachOverStep * ball) return false;
  // How far the proxy is from its aim before and after, and by how much the step promised to change that.
  const Vec3 after = aim_ - moved;
  const Vec3 promised = aim_ - by;
  const double before = glm::dot(aim_, aim_);
  const double promise = std::max(0.0, before - glm::dot(promised, promised));
  double noise = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    noise = std::max(noise, near_.walls()[problem.source[i].near].tolerance);
  }
  noise *= limits::kNoise * std::sqrt(before);
  const double gain = before - glm::dot(after, after);
  // A proxy beyond its walls comes back whatever it costs.
  const double least = rule == StepRule::kMustGain ? noise : limits::kGain * promise - noise;
  if (!trusts_sides_ && gain < least) return false;
  return keepsOnWay(problem, y) && go(problem, y);
}

/// Whether the last step landed on the free side of all walls of its cell.
bool ProxySolver::hasLandedFree(const CellProblem& problem) const noexcept {
  if (!has_landed_) return false;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    if (!from.isCut() && !(landed_[i].gap(from.inside) >= 0.0)) return false;
  }
  return true;
}

/// What brings a tangent step back onto the walls that hold it, as far as their curvature here tells. At a fold of one
/// field only this tells how far off the wall it is that the field does not show there.
Vec3 ProxySolver::bentBack(const CellProblem& problem, const Vec3& step) const noexcept {
  std::array<Plane, 6> planes{};
  std::size_t count = 0;
  for (int k = 0; k < problem.solution.count; ++k) {
    const auto i = static_cast<std::size_t>(problem.solution.plane[static_cast<std::size_t>(k)]);
    const Source& from = problem.source[i];
    const Mat3& bend = from.isCut() ? cut_[static_cast<std::size_t>(from.cut)].bend
                                    : near_.walls()[from.near].bend;
    const Vec3 turn = (from.inside ? -1.0 : 1.0) * (bend * step);
    if (!isReached(i)) continue;
    const double left = problem.plane[i].gap + glm::dot(problem.plane[i].normal, step);
    const Vec3 normal = unitOr(problem.plane[i].normal + turn, problem.plane[i].normal);
    const double off = left + 0.5 * glm::dot(step, turn);
    planes[count++] = {normal, off};
    planes[count++] = {-normal, -off};
  }
  if (count == 0) return Vec3(0.0);
  const Vec3 back = closestStep(Vec3(0.0), {planes.data(), count}).step;
  const double most = limits::kRestoredShare * glm::length(step);
  return glm::dot(back, back) <= most * most ? back : Vec3(0.0);
}

/// Brings `y` [m] onto the walls that hold the solution and to the free side of all others of the cell, by the
/// shortest way. False if that takes more than a share of `length` [m].
bool ProxySolver::restore(const CellProblem& problem, Vec3& y, double length) noexcept {
  double moved = 0.0;
  // Where a wall folds its field tells one of the planes that meet there at a time: those seen are kept.
  std::array<Plane, kMaxSeen> seen{};  // gap at the world's origin
  std::size_t seen_count = 0;
  for (int round = 0; round < limits::kRestorations && batches_left_ > 0; ++round) {
    --batches_left_;
    std::array<Plane, kMaxPlanes> planes{};
    std::size_t count = 0;
    bool is_done = true;
    double tolerance = 0.0;
    for (std::size_t i = 0; i < problem.planes && count + 3 < kMaxPlanes; ++i) {
      const Source& from = problem.source[i];
      if (from.isCut()) continue;
      const WallThere wall = wallAt(from.near, y);
      const double gap = wall.gap(from.inside);
      if (round == 0) landed_[i] = wall;
      if (!(wall.slope > 0.0)) {
        if (gap < 0.0) return false;
        continue;
      }
      tolerance = std::max(tolerance, wall.tolerance);
      const Vec3 normal = from.inside ? -wall.normal : wall.normal;
      const double left = gap - limits::kRest * wall.tolerance;
      planes[count++] = {normal, left};
      const bool is_held = isReached(i);
      const bool floats = is_held && left > wall.tolerance;
      // What is held already stays so while the others come down.
      if (floats || (is_held && left > -limits::kNoise * wall.tolerance)) {
        planes[count++] = {-normal, -left};
      }
      is_done = is_done && gap >= 0.0 && !floats;
      if (gap >= 0.0) continue;
      std::size_t slot = 0;
      while (slot < seen_count && glm::length(seen[slot].normal - normal) > limits::kCutTurn) {
        ++slot;
      }
      if (slot == kMaxSeen) slot = static_cast<std::size_t>(round) % kMaxSeen;
      seen[slot] = {normal, left - glm::dot(normal, y)};
      seen_count = std::max(seen_count, slot + 1);
    }
    if (rim_ >= 0) {
      const auto id = static_cast<LeafId>(rim_);
      const WallThere wall = wallOf(id, walker_.leaf(id), walker_.leaf(id).field->sample(y));
      if (!(wall.slope > 0.0)) return false;
      const double side = walker_.side(id);
      const double left = side * wall.distance - limits::kRest * wall.tolerance;
      planes[count++] = {side * wall.normal, left};
      planes[count++] = {-side * wall.normal, -left};
      is_done = is_done && std::fabs(left) <= wall.tolerance;
    }
    if (is_done) return true;
    if (round == 0 && rim_ < 0) {
      landed_at_ = y;
      has_landed_ = true;
      if (foundCrease(problem, length)) return false;
    }
    const std::size_t here = count;
    for (std::size_t i = 0; i < seen_count && count < kMaxPlanes; ++i) {
      // The same wall as it is here knows better.
      const bool is_here = std::any_of(planes.begin(), planes.begin() + here, [&](const Plane& p) {
        return glm::length(p.normal - seen[i].normal) <= limits::kCutTurn;
      });
      if (is_here) continue;
      planes[count++] = {seen[i].normal, seen[i].gap + glm::dot(seen[i].normal, y)};
    }
    const Vec3 by = closestStep(Vec3(0.0), {planes.data(), count}).step;
    moved += glm::length(by);
    if (!(moved <= limits::kRestoredShare * length + limits::kRestoredLeast * tolerance)) {
      return false;
    }
    y += by;
  }
  return false;
}

/// Whether the chord to `y` [m] keeps to the cell, but for what the walls' own curvature makes it dip.
bool ProxySolver::keepsOnWay(const CellProblem& problem, const Vec3& y) noexcept {
  const double length = glm::length(y - x_);
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    const NearWall& wall = near_.walls()[from.near];
    if (from.isCut()) continue;
    const Leaf& own = walker_.leaf(wall.leaf);
    if (!own.is_flat && length > limits::kShareOfFeature * own.feature &&
        std::fabs(wall.distance) < length) {
      // Less than what a thin wall is deep: a chord through one is not a way along another.
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

/// Goes to `y` [m]; or up to where an opening on the way lets go of a wall that holds the proxy.
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
  // To where the opening begins: on the walls that hold the proxy, and on the leaf that was passed there.
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

/// Whether the wall of plane `i` where the last step landed is one that the proxy has to respect here: the step ended
/// beyond it, its plane is not the one here, and carried back it does not cut off the proxy.
bool ProxySolver::isCut(const CellProblem& problem, std::size_t i, Cut& out) const noexcept {
  const Source& from = problem.source[i];
  const WallThere& wall = landed_[i];
  if (from.isCut() || !(wall.slope > 0.0) || wall.gap(from.inside) >= 0.0) return false;
  const NearWall& here = near_.walls()[from.near];
  if (glm::length(wall.normal - here.normal) < limits::kCutTurn) return false;
  const double side = from.inside ? -1.0 : 1.0;
  const Vec3 off = x_ - landed_at_;
  out = {};
  out.leaf = here.leaf;
  out.inside = from.inside;
  out.away = glm::length(off);
  out.plane.normal = side * wall.normal;
  double left = wall.gap(from.inside) + glm::dot(out.plane.normal, off);
  double slack = limits::kOnWall * here.tolerance;
  // A wall that bends little between there and here is carried back with its curvature: along a crease the bends of
  // both its walls decide how far to go.
  const Leaf& leaf = walker_.leaf(here.leaf);
  const FieldJet jet = leaf.field->jet(landed_at_);
  const double slope = glm::length(jet.gradient);
  if (jet.in_band && slope > 0.0) {
    Mat3 bend = jet.hessian / slope;
    unfoldBend(leaf, side, landed_at_, jet.gradient / slope, bend);
    const Vec3 turn = bend * off;
    const double size = glm::length(turn);
    if (size <= limits::kCarries) {
      out.bend = bend;
      out.plane.normal = unitOr(out.plane.normal + side * turn, out.plane.normal);
      left += 0.5 * side * glm::dot(off, turn);
      slack += limits::kCarriedShare * size * out.away;
    }
  }
  out.plane.gap = std::max(0.0, left);
  return left >= -slack;
}

/// Whether a wall that the cell has as one smooth leaf stands more in the way than its curvature explains.
bool ProxySolver::foundCrease(const CellProblem& problem, double length) const noexcept {
  Cut cut;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    if (from.isCut()) continue;
    const NearWall& here = near_.walls()[from.near];
    const double explained = here.bend_size * length * length + limits::kNoise * here.tolerance;
    const double ahead = problem.plane[i].gap + glm::dot(problem.plane[i].normal, landed_at_ - x_);
    if (landed_[i].gap(from.inside) < std::min(0.0, ahead) - explained && isCut(problem, i, cut)) {
      return true;
    }
  }
  return false;
}

/// Looks just ahead along `way` for the walls of cuts that hold the solution and were met far off. True if that
/// found them anew.
bool ProxySolver::lookClose(const CellProblem& problem, const Vec3& way) noexcept {
  double feature = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    if (!from.isCut() || !problem.holds(i)) continue;
    const double size = walker_.leaf(near_.walls()[from.near].leaf).feature;
    if (cut_[static_cast<std::size_t>(from.cut)].away > limits::kNearer * limits::kClose * size) {
      feature = std::max(feature, size);
    }
  }
  if (feature == 0.0) return false;
  landed_at_ = x_ + limits::kClose * feature * unitOr(way, Vec3(0.0));
  has_landed_ = true;
  --batches_left_;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    if (!problem.source[i].isCut()) landed_[i] = wallAt(problem.source[i].near, landed_at_);
  }
  return addCuts(problem);
}

/// Keeps the tangent planes of the cell's walls that the last step ended beyond. Of walls that are hollow towards the
/// proxy they hold everywhere. False if there is none.
bool ProxySolver::addCuts(const CellProblem& problem) noexcept {
  bool has_new = false;
  if (!has_landed_) return false;
  for (std::size_t i = 0; i < problem.planes && cuts_ < limits::kMaxCuts; ++i) {
    Cut cut;
    if (!isCut(problem, i, cut)) continue;
    // Met again from nearer by, the same wall is better known; met as it was, there is nothing new.
    std::size_t slot = cuts_;
    bool is_new = true;
    for (std::size_t c = 0; c < cuts_; ++c) {
      if (cut_[c].leaf != cut.leaf || cut_[c].inside != cut.inside) continue;
      const double turn = glm::length(cut_[c].plane.normal - cut.plane.normal);
      if (turn < limits::kSameCut && cut_[c].plane.gap <= cut.plane.gap) is_new = false;
      const bool is_nearer = limits::kNearer * cut.away < cut_[c].away;
      if (turn < limits::kSameWall || (is_nearer && turn < limits::kCarries)) slot = c;
    }
    if (!is_new) continue;
    cut_[slot] = cut;
    cuts_ = std::max(cuts_, slot + 1);
    has_new = true;
  }
  return has_new;
}

/// At rest by the first order: looks whether the proxy can come closer by the second.
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
