#include <array>
#include <cmath>

#include "proxy_solver.h"
#include "step_checks.h"

// The usual tick at a crease: the proxy glides along the line where two smooth walls meet, pressed
// against both.

namespace palpate {
namespace {

/// One of the two walls, at the place being examined.
struct CreaseWall {
  LeafId id = 0;
  const Leaf* leaf = nullptr;
  Facet facet;
  double side = 1.0;
  FieldJet jet;
  WallThere there;
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] on the free side
  double gap = 0.0;            ///< [m]
  double left = 0.0;           ///< [m] from the proxy to where it rests at this wall
  Mat3 bend{0.0};              ///< [1/m] positive towards the free side
  double bend_size = 0.0;      ///< [1/m]

  [[nodiscard]] bool isOn() const noexcept {
    return std::fabs(left) <= (limits::kOnWall - limits::kRest) * there.tolerance;
  }
  /// Updates the members from `jet`. False where the leaf has no normal, or a fold.
  [[nodiscard]] bool take() noexcept {
    there = wallOf(id, *leaf, {jet.value, jet.gradient, jet.in_band});
    if (!(there.slope > 0.0)) return false;
    normal = side * there.normal;
    gap = there.gap(side < 0.0);
    left = gap - limits::kRest * there.tolerance;
    bend = jet.hessian * (side / there.slope);
    bend_size = sizeOf(bend);
    return bend_size * leaf->feature <= limits::kFolds;
  }
};

/// Two walls that meet: finds the factors for which `a` n1 + `b` n2 has given components along the
/// normals n1 and n2.
struct Corner {
  double cosine = 0.0;
  double square = 0.0;  ///< of the sine of the angle between them

  Corner(const Vec3& n1, const Vec3& n2) noexcept
      : cosine(glm::dot(n1, n2)), square(1.0 - cosine * cosine) {}
  void solve(double along1, double along2, double& a, double& b) const noexcept {
    a = (along1 - cosine * along2) / square;
    b = (along2 - cosine * along1) / square;
  }
};

}  // namespace

/// Finds by Newton's method where the proxy rests in the crease of the leaves `a` and `b`, the only
/// ones near; it must be on at least one of them. Returns false, and changes nothing, if the result
/// is uncertain; if one of the two clearly does not hold the proxy from the start, other_ names it.
bool ProxySolver::glideBetween(LeafId a, LeafId b, const Vec3& hip,
                               FrictionState& friction) noexcept {
  other_ = -1;
  const Vec3 x = walker_.position();
  std::array<CreaseWall, 2> wall;
  wall[0].id = a;
  wall[1].id = b;
  for (CreaseWall& each : wall) {
    each.leaf = &walker_.leaf(each.id);
    each.side = walker_.side(each.id);
    each.jet = walker_.jetHere(each.id);
    if (!each.take() || each.gap < -each.there.tolerance) return false;
  }
  if (!wall[0].isOn() && !wall[1].isOn()) return false;
  if (!(Corner(wall[0].normal, wall[1].normal).square > limits::kSharp)) return false;
  // The proxy's region there must be exactly the one cell between the two walls.
  for (CreaseWall& each : wall) {
    each.facet = walker_.facetAt(each.id);
    if (!isPlainWall(*each.leaf, each.facet) || each.facet.beyond == walker_.region()) return false;
    const auto material = static_cast<std::size_t>(each.facet.material);
    const Parameter& ratio = scene_.materials()[material].friction.static_ratio;
    if (!ratio.isConstant() || ratio.at(x) > 0.0) return false;
  }
  if (walker_.isSameAcross(a, b)) return false;

  Vec3 y = x;
  double press[2] = {0.0, 0.0};
  for (int round = 0;; ++round) {
    if (round == limits::kGlides) return false;
    const Corner corner(wall[0].normal, wall[1].normal);
    if (!(corner.square > limits::kSharp)) return false;
    const Vec3 wish = hip - y;
    const double sink[2] = {wall[0].isOn() ? 0.0 : wall[0].left,
                            wall[1].isOn() ? 0.0 : wall[1].left};
    corner.solve(-sink[0] - glm::dot(wall[0].normal, wish),
                 -sink[1] - glm::dot(wall[1].normal, wish), press[0], press[1]);
    if (!(press[0] > rest_ && press[1] > rest_)) {
      if (round == 0) other_ = press[0] > press[1] ? b : a;
      return false;
    }
    const Vec3 along =
        glm::cross(wall[0].normal, wall[1].normal) * (1.0 / std::sqrt(corner.square));
    const double bend[2] = {glm::dot(along, wall[0].bend * along),
                            glm::dot(along, wall[1].bend * along)};
    // The place must be a minimum along the crease.
    const double firm = 1.0 - press[0] * bend[0] - press[1] * bend[1];
    if (!(firm > limits::kFirm)) return false;
    const double pull = glm::dot(along, wish);
    if (wall[0].isOn() && wall[1].isOn() && std::fabs(pull) <= rest_) break;

    // A step along the crease, and the correction that brings it back onto both curved walls.
    const double slide = pull / firm;
    const double back = 0.5 * slide * slide;
    double by[2];
    corner.solve(-sink[0] - back * bend[0], -sink[1] - back * bend[1], by[0], by[1]);
    const Vec3 step = slide * along + by[0] * wall[0].normal + by[1] * wall[1].normal;
    const Vec3 to = y + step;
    const double length = glm::length(step);
    const double way = glm::length(to - x);
    for (CreaseWall& each : wall) {
      if (!isShortFor(*each.leaf, each.bend_size, way)) return false;
      const WallThere here = each.there;
      const double bent = each.bend_size;
      const double meant = each.isOn() ? each.gap : limits::kRest * here.tolerance;
      each.jet = each.leaf->field->jet(to);
      if (!each.take() || !landedAsPromised(here, each.there, bent, length, each.gap - meant)) {
        return false;
      }
    }
    y = to;
  }

  if (y != x) {
    const Vec3 before = hip - x;
    const Vec3 after = hip - y;
    if (glm::dot(after, after) > glm::dot(before, before)) return false;
    for (const CreaseWall& each : wall) {
      if (!keepsOnChord(*each.leaf->field, x, y, each.side / each.there.slope, each.bend_size,
                        each.there.tolerance)) {
        return false;
      }
    }
    const std::array<LeafId, 2> both = {a, b};
    const double way = glm::length(y - x);
    if (walker_.metOnWay(both, y, way, rest_) >= 0) return false;
    walker_.jump(y, way);
    for (const CreaseWall& each : wall) walker_.know(each.id, each.jet);
  }
  friction.sticks = false;
  friction.is_felt = false;

  // The pressure on each is measured from the surfaces.
  const Corner corner(wall[0].normal, wall[1].normal);
  const Vec3 wish = hip - y;
  double onto[2];
  corner.solve(-wall[0].gap, -wall[1].gap, onto[0], onto[1]);
  corner.solve(-wall[0].gap - glm::dot(wall[0].normal, wish),
               -wall[1].gap - glm::dot(wall[1].normal, wish), press[0], press[1]);
  contact_.count = 2;
  contact_.lag = Vec3(0.0);
  contact_.snug = onto[0] * wall[0].normal + onto[1] * wall[1].normal;
  for (std::size_t k = 0; k < 2; ++k) {
    WallContact& out = contact_.wall[k];
    out.leaf = wall[k].id;
    out.facet = wall[k].facet;
    out.held.field = wall[k].leaf->field.get();
    out.held.side = wall[k].side;
    out.held.jet = wall[k].jet;
    out.held.normal = wall[k].normal;
    out.held.multiplier = press[k];
  }
  contact_.left = contact_.along(wish);
  return true;
}

}  // namespace palpate
