#include <algorithm>
#include <array>
#include <cmath>

#include "constraint_renderer.h"
#include "palpate/contact/crease.h"

// How the proxy moves along the walls that hold it.

namespace palpate {
namespace {

/// A slide that another sheet of the same wall stops within this share of the feature size got nowhere.
constexpr double kStuck = 1e-6;
constexpr int kMaxHalvings = 12;
/// The quadratic model of a slide promises a gain between 0.5 and 1.5 of pull . step. One that gains more
/// than this has left where the model holds.
constexpr double kMostGain = 3.0;
/// A slide that gets no further than this share of its way goes above it instead.
constexpr double kWinding = 0.1;

/// Whether the middle of the way from one point of `walls` to another is on their free side.
bool isOpenHalfway(const Vec3& a, const Vec3& b, std::span<const HeldWall> walls) noexcept {
  const Vec3 middle = 0.5 * (a + b);
  return std::all_of(walls.begin(), walls.end(), [&](const HeldWall& wall) {
    return wall.side * wall.field->value(middle) >= -wall.tolerance;
  });
}

}  // namespace

bool ConstraintRenderer::slide(const Vec3& hip) noexcept {
  const Contact& c = contact_;
  const SlideStep newton = slideStep(c.pull, c.walls());
  Vec3 by = newton.step;
  // Newton looks at the held walls only; where another wall is at hand, the first-order step respects it.
  for (std::size_t k = 0; k < c.planes; ++k) {
    const Plane& plane = c.plane[k];
    if (!c.slides[k] && glm::dot(plane.normal, by) < -plane.gap - 1e-12 * glm::length(by)) {
      by = c.pull;
      break;
    }
  }
  for (int halving = 0; halving < kMaxHalvings; ++halving) {
    if (slideBy(hip, by, true, c.walls(), kMostGain * glm::dot(c.pull, by))) return true;
    if (unfold(hip, walker_.position() + by)) return true;
    by *= 0.5;
  }
  if (unfoldAround(hip)) return true;
  // Nothing along the wall comes closer: only settle onto it, where it is not there yet.
  return !isOnWalls() && slideBy(hip, Vec3(0.0), false, c.walls());
}

/// Moves along `walls` by about `by`, on a path that stays on the free side of them. False if
/// that would not come closer, or by more than `most_gain` [m^2] of half the square of the distance (then
/// nothing moved).
bool ConstraintRenderer::slideBy(const Vec3& hip, const Vec3& by, bool must_improve,
                                 std::span<const HeldWall> walls, double most_gain) noexcept {
  const Contact& c = contact_;
  const Vec3 x = walker_.position();
  const Vec3 ahead = x + by;
  Vec3 landed = ahead;
  bool above = true;
  const bool in_crease = std::any_of(walls.begin(), walls.end(),
                                     [](const HeldWall& wall) { return wall.probe != Vec3(0.0); });
  if (in_crease ? !pullBackToCrease(landed, walls, glm::length(by), above)
                : !pullBack(landed, walls, above)) {
    return false;
  }
  if (must_improve) {
    // What comes back this far met another wall, not the bend of its own.
    if (glm::length(landed - x) < 0.5 * glm::length(by)) return false;
    // With friction the aim is not P but the point that lags behind it by what the cone holds.
    const Vec3 aim = hip - c.lag;
    const Vec3 before = x - aim;
    const Vec3 after = landed - aim;
    double sunk = 0.0;  // a proxy beyond the wall, by rounding, looks closer than it may be
    for (std::size_t i = 0; i < c.count; ++i) {
      sunk = std::max(sunk, std::fabs(c.plane[c.index[i]].gap));
    }
    const double limit = glm::dot(before, before) + 4.0 * sunk * glm::length(before);
    if (glm::dot(after, after) > limit * (1.0 + 1e-13)) return false;
    const double gain = 0.5 * (glm::dot(before, before) - glm::dot(after, after));
    if (gain > most_gain + 4.0 * sunk * glm::length(before) + 1e-13 * limit) return false;
  }
  const std::span<const LeafId> sliding(c.sliding.data(), c.sliding_count);
  // The wall that holds the proxy may stand in its way as well, further on.
  bool is_clipped = false;
  const auto go = [&](const Vec3& from, const Vec3& to) {
    double share = 1.0;
    for (const LeafId leaf : sliding) share = std::min(share, walker_.freeShare(leaf, from, to));
    const CellWalker::Stop stop = walker_.move(from + share * (to - from), sliding, true);
    if (stop == CellWalker::Stop::kCrossed) letGoAtRim();
    is_clipped = share < 1.0 && stop == CellWalker::Stop::kArrived;
    return stop == CellWalker::Stop::kArrived && !is_clipped;
  };
  if (!must_improve) {
    (void)walker_.move(landed, sliding, true);
    return true;
  }
  const auto goAbove = [&] {
    Vec3 up(0.0);
    for (const HeldWall& wall : walls) up += wall.normal;
    const Vec3 lift = 2.0 * glm::length(landed - ahead) * unitOr(up, Vec3(0.0));
    return go(walker_.position(), walker_.position() + lift) &&
           go(walker_.position(), landed + lift);
  };
  // Over a bulge the tangent runs in the open and comes down; in a hollow the chord is the open way.
  bool on_way = !above || go(x, ahead);
  // Of several walls one may bulge and another be hollow: then only above all of them it is open.
  const bool is_mixed = !above && walls.size() > 1 && !isOpenHalfway(x, landed, walls);
  if (is_mixed) on_way = goAbove();
  if (on_way) (void)go(walker_.position(), landed);
  // So may one wall along a valley that winds: tangent and chord are open further on, and closed where they begin.
  if (is_clipped && !is_mixed && glm::length(walker_.position() - x) < kWinding * glm::length(by) &&
      goAbove()) {
    (void)go(walker_.position(), landed);
  }
  const double moved = glm::length(walker_.position() - x);
  return !is_clipped || moved > kStuck * walker_.leaf(c.leaf[c.index[0]]).feature;
}

/// Where a slide failed, a held leaf may fold on the way to `toward`: then goes to the crease, whose other
/// wall takes part in the local problem from now on. True if there is one.
bool ConstraintRenderer::unfold(const Vec3& hip, const Vec3& toward) noexcept {
  const Contact& c = contact_;
  for (std::size_t i = 0; i < c.count; ++i) {
    const LeafId leaf = c.leaf[c.index[i]];
    if (i > 0 && leaf == c.leaf[c.index[i - 1]]) continue;
    if (unfoldLeaf(hip, leaf, toward)) return true;
  }
  return false;
}

bool ConstraintRenderer::unfoldLeaf(const Vec3& hip, LeafId leaf, const Vec3& toward) noexcept {
  const Contact& c = contact_;
  if (unfolds_left_ <= 0) return false;
  const Vec3 x = walker_.position();
  std::array<Vec3, kMaxPlanes> known{};
  std::size_t count = 0;
  for (std::size_t k = 0; k < c.planes; ++k) {
    if (c.leaf[k] == leaf) known[count++] = c.plane[k].normal;
  }
  const Field& field = *walker_.leaf(leaf).field;
  const double side = walker_.side(leaf);
  const double reach = reachOf(leaf);
  Fold fold;
  const bool is_creased = count > 1;
  if (piece_count_ + (is_creased ? 1 : 2) > kMaxPieces ||
      !findFold(field, side, std::span(known.data(), count), x, toward, 0.1 * reach, fold)) {
    return false;
  }
  --unfolds_left_;
  const std::size_t before = piece_count_;
  if (!is_creased) pieces_[piece_count_++] = {leaf, known[0], Vec3(0.0)};
  pieces_[piece_count_++] = {leaf, fold.normal, Vec3(0.0)};
  aimProbes();
  const Vec3 by = fold.at - x;
  if (glm::length(by) <= 0.5 * reach) return true;

  // On to the crease, along what holds the proxy now.
  std::array<HeldWall, 3> walls{};
  std::size_t held = 0;
  for (std::size_t i = 0; i < c.count && held < 2; ++i) {
    walls[held] = c.held[i];
    for (std::size_t k = 0; k < piece_count_; ++k) {
      if (c.leaf[c.index[i]] == leaf && pieces_[k].leaf == leaf &&
          glm::dot(pieces_[k].normal, c.held[i].normal) > 1.0 - 1e-9) {
        walls[held].probe = pieces_[k].probe;
      }
    }
    ++held;
  }
  walls[held].field = &field;
  walls[held].side = side;
  walls[held].tolerance = walker_.tolerance(leaf);
  walls[held].normal = fold.normal;
  walls[held].jet.gradient = side * fold.normal;
  walls[held].probe = pieces_[piece_count_ - 1].probe;
  walls[held].reach = reach;
  ++held;
  if (slideBy(hip, by, true, std::span(walls.data(), held))) return true;
  piece_count_ = before;
  if (before > 0) aimProbes();
  return false;
}

/// Close around the proxy.
bool ConstraintRenderer::unfoldAround(const Vec3& hip) noexcept {
  const Contact& c = contact_;
  const Vec3 along = unitOr(c.pull, Vec3(0.0));
  const Vec3 across = glm::cross(c.held[0].normal, along);
  const double reach = reachOf(c.leaf[c.index[0]]);
  const Vec3 x = walker_.position();
  return unfold(hip, x + reach * along) || unfold(hip, x + reach * across) ||
         unfold(hip, x - reach * across) || unfold(hip, x - reach * along);
}

}  // namespace palpate
