#include <algorithm>
#include <cmath>

#include "proxy_solver.h"

// The place where a step landed, and the way back from there onto the walls that it has to keep to.

namespace palpate {

WallThere ProxySolver::wallAt(std::size_t near, const Vec3& p) const noexcept {
  const LeafId id = near_.walls()[near].leaf;
  return wallOf(id, walker_.leaf(id), walker_.leaf(id).field->sample(p));
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

/// The correction that brings a tangent step back onto the walls that hold it, as far as their
/// curvature here predicts it. At a fold of one field this is the only estimate for the wall that
/// the field does not show there.
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

/// Brings `y` [m] onto the walls that hold the solution and to the free side of all others of the
/// cell, by the shortest way. False if that takes more than a share of `length` [m].
bool ProxySolver::restore(const CellProblem& problem, Vec3& y, double length) noexcept {
  double moved = 0.0;
  // Where a wall folds, its field shows only one of the planes that meet there at a time: keep
  // those seen before.
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
      // A wall that already holds the proxy keeps doing so while the others are approached.
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
      // If the same wall is among the present planes, the present plane is the better one.
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

}  // namespace palpate
