#include "support/rest_judge.h"

#include <algorithm>
#include <cmath>

namespace palpate::testing {

const char* nameOf(Fault fault) {
  switch (fault) {
    case Fault::kNotFinite:
      return "not finite";
    case Fault::kRegion:
      return "left its region";
    case Fault::kInside:
      return "inside a wall";
    case Fault::kForce:
      return "force is not K (x - P)";
    case Fault::kContact:
      return "contact flag";
    case Fault::kStep:
      return "force more than 10 mN off the oracle's";
    case Fault::kPlace:
      return "proxy off the oracle's minimum";
    case Fault::kFrozen:
      return "does not settle at rest";
    case Fault::kNone:
    case Fault::kCount:
      break;
  }
  return "none";
}

std::string causeOf(const Verdict& verdict) {
  static constexpr std::array<const char*, 4> kHeldBy = {"free", "one wall", "two walls",
                                                         "three walls"};
  std::string out = kHeldBy[static_cast<std::size_t>(std::clamp(verdict.touching, 0, 3))];
  if (verdict.has_kink) out = "apex or kink";
  return out + (verdict.is_minimum ? ", at a minimum" : ", no minimum");
}

bool RestJudge::isDirect(const Vec3& from, const Vec3& to, double moved) const {
  // The chord of a convex wall goes below the wall by at most moved^2 / (8 R).
  const double dip = moved * moved / (8.0 * tree_.feature()) + 4.0 * tree_.onSurface();
  constexpr int kLooks = 12;
  for (int i = 1; i < kLooks; ++i) {
    if (tree_.value(from + (static_cast<double>(i) / kLooks) * (to - from)) < -dip) return false;
  }
  return true;
}

Verdict RestJudge::judge(const TickResult& before, const Vec3& previous_hip, const TickResult& now,
                         const Vec3& hip, bool sampled) const {
  Verdict out;
  const auto is_at_fault = [&](Fault fault, double off) {
    out.fault = fault;
    out.off = off;
    return out;
  };
  if (!isFinite(now.force) || !isFinite(now.proxy)) return is_at_fault(Fault::kNotFinite, 0.0);
  if (now.region != region_) return is_at_fault(Fault::kRegion, 0.0);
  const double on_surface = tree_.onSurface();
  const double inside = -tree_.value(now.proxy);
  if (inside > 2.0 * on_surface) return is_at_fault(Fault::kInside, inside);
  const Vec3 way = now.proxy - hip;
  const double depth = glm::length(way);
  // Rounding of positions, multiplied by the stiffness.
  const double least = stiffness_ * (1e-15 * glm::length(hip) + 1e-17);
  const double force_off = glm::length(now.force - stiffness_ * way);
  if (depth > atHand()) {
    out.is_contact = true;
    if (force_off > kTolerance * stiffness_ * depth + least) {
      const RestCheck checked = oracle_.check(now.proxy, hip);
      out.touching = checked.touching;
      out.has_kink = checked.has_kink;
      out.is_minimum = checked.residual <= 1e-6 * depth;
      return is_at_fault(Fault::kForce, force_off);
    }
    if (!now.contact) return is_at_fault(Fault::kContact, depth);
  } else {
    if (force_off > stiffness_ * atHand()) return is_at_fault(Fault::kForce, force_off);
    if (now.contact && depth == 0.0) return is_at_fault(Fault::kContact, depth);
  }
  const double moved = glm::length(now.proxy - before.proxy);
  bool is_suspect = !isDirect(before.proxy, now.proxy, moved);
  bool& is_minimum = out.is_minimum;
  bool is_rest = false;    // judged by the walls' normals
  bool is_pinned = false;  // judged by them and by values
  if (out.is_contact) {
    is_suspect |= moved > 4.0 * glm::length(hip - previous_hip) + 1e-3 * depth;
    const RestCheck checked = oracle_.check(now.proxy, hip);
    out.is_unjudged = !checked.is_judged;
    out.touching = checked.touching;
    out.has_kink = checked.has_kink;
    is_rest = checked.residual <= (3e-8 + checked.doubt) * depth + 1e-15;
    if (!is_rest && checked.has_kink && checked.residual <= 10.0 * kTolerance * depth) {
      // The normals about a crease come from places beside it. Newton's step tells how far off the
      // minimum is, and values confirm that it is one.
      is_pinned = checked.residual <= kTolerance * depth * oracle_.leastCurvature(now.proxy, hip) &&
                  oracle_.gainNear(now.proxy, hip, 1e-4 * depth) == 0.0;
      is_rest = is_pinned;
    }
    is_minimum = is_rest;
    if (is_minimum && (sampled || is_suspect)) {
      // By the tree alone: within a ten-thousandth of the depth no allowed point is nearer by more
      // than the bulge of a wall explains.
      is_minimum = oracle_.gainNear(now.proxy, hip, 1e-4 * depth) <= 0.02 &&
                   oracle_.leastCurvature(now.proxy, hip) >= -1e-4;
    }
    is_suspect |= !is_minimum;
  }
  if (!is_suspect) return out;
  out.ran_oracle = true;
  // Walls are met within onSurface(); in a wedge the distance along it is longer.
  const auto allowed_of = [&](const Rest& rest) {
    return kTolerance * glm::length(rest.point - hip) +
           6.0 * on_surface / std::max(rest.blunt, 1e-3);
  };
  Rest rest = oracle_.solveOnce(before.proxy, hip);
  if (glm::length(now.proxy - rest.point) <= allowed_of(rest)) {
    out.is_unjudged = false;
    return out;
  }
  rest = oracle_.solve(before.proxy, hip);
  const double allowed = allowed_of(rest);
  double off = glm::length(now.proxy - rest.point);
  for (const Vec3& other : rest.others) {
    out.is_ambiguous |= glm::length(other - rest.point) > 10.0 * allowed;
    off = std::min(off, glm::length(now.proxy - other));
  }
  // The oracle passes through parts thinner than its steps. Then it is started again at the proxy,
  // with equally small steps.
  if (is_rest && off > allowed) {
    out.is_ambiguous |=
        is_pinned || glm::length(oracle_.stay(now.proxy, hip) - now.proxy) <= allowed;
    is_minimum |= out.is_ambiguous;
  }
  // Either end is accepted, or another minimum between them, but not a point that is not a minimum.
  if (off <= allowed || (out.is_ambiguous && is_minimum)) return out;
  if (!rest.has_settled) {
    // The oracle does not know where it ends; values can still reveal a place nearby that is nearer
    // to the hand.
    for (const double share : {1e-2, 1e-3, 1e-4}) {
      const double gain = oracle_.gainNear(now.proxy, hip, share * depth);
      if (gain > 0.02) return is_at_fault(Fault::kPlace, gain * share * depth);
    }
    out.is_unjudged = true;
    return out;
  }
  out.is_unjudged = false;
  return is_at_fault(stiffness_ * off > 0.01 ? Fault::kStep : Fault::kPlace, off);
}

}  // namespace palpate::testing
