#include <algorithm>
#include <cmath>

#include "proxy_solver.h"

// Cuts: tangent planes at points beyond a wall where a step ended. Near a fold one field has
// several such planes.

namespace palpate {

/// Whether the wall of plane `i`, as it is where the last step landed, is one that the proxy has to
/// respect here: the step ended beyond it, its plane differs from the plane here, and carried back
/// to the proxy the plane does not cut the proxy off.
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
  // A wall that turns little between there and here is carried back with its curvature: along a
  // crease the curvatures of both walls decide how far to go.
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

/// Whether a wall that the cell has as one smooth leaf obstructs the step more than is explained by
/// its curvature, or by the curvature of a known cut.
bool ProxySolver::foundCrease(const CellProblem& problem, double length) const noexcept {
  Cut cut;
  const Vec3 by = landed_at_ - x_;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    if (from.isCut()) continue;
    const NearWall& here = near_.walls()[from.near];
    const double noise = limits::kNoise * here.tolerance;
    const auto is_explained = [&](const Plane& plane, double bend) {
      const double ahead = plane.gap + glm::dot(plane.normal, by);
      return landed_[i].gap(from.inside) >= std::min(0.0, ahead) - bend * length * length - noise;
    };
    if (is_explained(problem.plane[i], here.bend_size) || !isCut(problem, i, cut)) continue;
    const bool is_known = std::any_of(cut_.begin(), cut_.begin() + cuts_, [&](const Cut& known) {
      return known.leaf == cut.leaf && known.inside == cut.inside &&
             glm::length(known.plane.normal - cut.plane.normal) < limits::kSameWall &&
             is_explained(known.plane, sizeOf(known.bend));
    });
    if (!is_known) return true;
  }
  return false;
}

/// Looks along `way` from close by for the walls of those cuts that hold the solution and were
/// found far away, if the remaining step is short. True if that found them anew.
bool ProxySolver::lookCloser(const CellProblem& problem, const Vec3& way) noexcept {
  double feature = 0.0;
  double away = 0.0;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    const Source& from = problem.source[i];
    if (!from.isCut() || !problem.holds(i)) continue;
    feature = std::max(feature, walker_.leaf(near_.walls()[from.near].leaf).feature);
    away = std::max(away, cut_[static_cast<std::size_t>(from.cut)].away);
  }
  double length = limits::kClose * feature;
  if (glm::length(problem.solution.step) > std::max(length, rest_)) return false;
  // If the wall is farther away than expected, these close places do not meet it.
  for (; limits::kNearer * length < away && batches_left_ > 0; length *= limits::kNearer) {
    if (lookAt(problem, x_ + length * unitOr(way, Vec3(0.0)))) return true;
  }
  return false;
}

/// Looks where `step` would end if walls did not turn. Beside an apex they turn so much that only
/// short steps are tried, and these never see the apex's other side. True if that found cuts.
bool ProxySolver::lookFar(const CellProblem& problem, const Vec3& step, double ball) noexcept {
  const double length = glm::length(step);
  const double far = std::min(length, ball);
  if (!has_landed_ || far <= limits::kNearer * glm::length(landed_at_ - x_)) return false;
  return lookAt(problem, x_ + (far / length) * step);
}

/// Evaluates the walls at `p` [m] as if a step had ended there. True if that found cuts.
bool ProxySolver::lookAt(const CellProblem& problem, const Vec3& p) noexcept {
  landed_at_ = p;
  has_landed_ = true;
  --batches_left_;
  for (std::size_t i = 0; i < problem.planes; ++i) {
    if (!problem.source[i].isCut()) landed_[i] = wallAt(problem.source[i].near, landed_at_);
  }
  return addCuts(problem);
}

/// Keeps the tangent planes of those walls of the cell that the last step ended beyond. Where the
/// region is convex at such a wall, the plane is valid everywhere. False if there is none.
bool ProxySolver::addCuts(const CellProblem& problem) noexcept {
  bool has_new = false;
  if (!has_landed_) return false;
  for (std::size_t i = 0; i < problem.planes && cuts_ < limits::kMaxCuts; ++i) {
    Cut cut;
    if (!isCut(problem, i, cut)) continue;
    // If the same wall was met from nearer by, replace the old cut; if nothing is new, skip it.
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

}  // namespace palpate
