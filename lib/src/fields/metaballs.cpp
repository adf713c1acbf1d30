#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "fields/checks.h"
#include "fields/fall_off.h"
#include "fields/level_bounds.h"
#include "fields/vector.h"
#include "palpate/core/bounds_tree.h"
#include "palpate/core/error.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

/// The distance from its center [radii] up to which a ball counts. A Gaussian is cut off where all
/// of them together are below half a unit in the last place of `iso`; the inverse square is never
/// cut off.
double reachOfInfluence(const std::vector<Metaball>& balls, FallOff fall_off, double iso) {
  if (fall_off == FallOff::kWyvill) return 1.0;
  if (fall_off == FallOff::kInverseSquare) return kInfinity;
  double total = 0.0;
  for (const Metaball& ball : balls) total += std::fabs(ball.strength);
  return std::sqrt(std::log(std::max(total / iso, 1.0) * 1e17));
}

/// Finds the balls that count at a point. It always visits them in the same order, in which the
/// balls are also stored, so that sums do not depend on which balls were left out.
class BallTree {
 public:
  /// Sorts `balls` into the order of the tree; does not store them.
  BallTree(std::vector<Metaball>& balls, FallOff fall_off, double iso) {
    const double reach = reachOfInfluence(balls, fall_off, iso);
    if (balls.size() < kFewest || !std::isfinite(reach)) return;
    std::vector<Box3> boxes;
    for (const Metaball& ball : balls) {
      const Vec3 half(ball.radius * reach * (1.0 + 1e-12));
      boxes.push_back({ball.center - half, ball.center + half});
    }
    tree_ = BoundsTree(boxes);
    place_.resize(balls.size());
    std::vector<Metaball> ordered;
    tree_.visit(balls.front().center, kInfinity, [&](std::uint32_t item) {
      place_[item] = static_cast<std::uint32_t>(ordered.size());
      ordered.push_back(balls[item]);
    });
    balls = std::move(ordered);
  }

  /// Calls f(index) for those of the `count` balls that may count at `p`.
  template <typename F>
  void visit(const Vec3& p, std::size_t count, F&& f) const noexcept {
    if (tree_.isEmpty()) {
      for (std::size_t i = 0; i < count; ++i) f(i);
    } else {
      tree_.visit(p, 0.0, [&](std::uint32_t item) { f(std::size_t{place_[item]}); });
    }
  }

 private:
  static constexpr std::size_t kFewest = 12;
  BoundsTree tree_;
  std::vector<std::uint32_t> place_;  ///< by item of the tree: its index among the balls
};

/// The term that is added outside the bounds, at distance d from them, so that the field has a
/// gradient everywhere: almost nothing close to the bounds, as the surface may touch them, and as
/// steep as the distance far away. d - w atan(d / w) is twice differentiable across the bounds,
/// monotonic, and never steeper than 1.
class Rise {
 public:
  explicit Rise(double width) : width_(width) {}

  [[nodiscard]] double value(double d) const noexcept { return d - width_ * std::atan(d / width_); }
  [[nodiscard]] double slope(double d) const noexcept {
    const double q = width_ / d;  // may overflow, but is never 0 / 0 or infinite / infinite
    return d > 0.0 ? 1.0 / (1.0 + q * q) : 0.0;
  }
  [[nodiscard]] double bend(double d) const noexcept {
    return d > 0.0 ? 2.0 * slope(d) * (1.0 - slope(d)) / d : 0.0;
  }
  /// The largest distance at which the term is at most `level`, or a little more than that.
  [[nodiscard]] double reach(double level) const {
    double lo = 0.0;
    double hi = level + 2.0 * width_;  // atan stays below pi / 2
    for (int i = 0; i < 60; ++i) {
      const double middle = 0.5 * (lo + hi);
      (value(middle) > level ? hi : lo) = middle;
    }
    return hi;
  }

 private:
  double width_;  ///< [m]
};

/// scale * (iso - sum of strength * kernel) + the term outside the bounds.
template <FallOff kFallOff>
class Metaballs final : public Field, public fields::LevelBounded {
 public:
  Metaballs(std::vector<Metaball> balls, double iso, double scale, double lipschitz,
            const Box3& bounds)
      : balls_(std::move(balls)),
        tree_(balls_, kFallOff, iso),
        iso_(iso),
        scale_(scale),
        lipschitz_(lipschitz),
        bounds_(bounds),
        rise_(riseWidth(balls_)) {
    for (const Metaball& ball : balls_) {
      feature_ = std::min(feature_, 0.1 * ball.radius);
      inverse_squares_.push_back(1.0 / (ball.radius * ball.radius));
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    double sum = 0.0;
    Vec3 slope(0.0);
    tree_.visit(p, balls_.size(), [&](std::size_t i) {
      const Vec3 d = p - balls_[i].center;
      const fields::Kernel k = fields::kernelAt<kFallOff>(glm::dot(d, d) * inverse_squares_[i]);
      sum += balls_[i].strength * k.value;
      if (k.first != 0.0) slope += d * (balls_[i].strength * k.first * inverse_squares_[i]);
    });
    FieldSample out{scale_ * (iso_ - sum), slope * (-2.0 * scale_)};
    const Vec3 beyond = beyondBounds(p);
    if (beyond != Vec3(0.0)) {
      const fields::Polar away = fields::polar(beyond, Vec3(1.0, 0.0, 0.0));
      out.value += rise_.value(away.length);
      out.gradient += rise_.slope(away.length) * away.direction;
    }
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    double sum = 0.0;
    tree_.visit(p, balls_.size(), [&](std::size_t i) {
      const Vec3 d = p - balls_[i].center;
      sum += balls_[i].strength *
             fields::kernelAt<kFallOff>(glm::dot(d, d) * inverse_squares_[i]).value;
    });
    const double inner = scale_ * (iso_ - sum);
    const Vec3 beyond = beyondBounds(p);
    return beyond != Vec3(0.0) ? inner + rise_.value(fields::length(beyond)) : inner;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldSample here = sample(p);
    FieldJet out{here.value, here.gradient, Mat3(0.0)};
    tree_.visit(p, balls_.size(), [&](std::size_t i) {
      const double inverse = inverse_squares_[i];
      const Vec3 d = p - balls_[i].center;
      const fields::Kernel k = fields::kernelAt<kFallOff>(glm::dot(d, d) * inverse);
      if (k.first == 0.0) return;
      const double share = -2.0 * scale_ * balls_[i].strength * inverse;
      out.hessian += Mat3(share * k.first) + outer(d, d) * (2.0 * share * inverse * k.second);
    });
    const Vec3 beyond = beyondBounds(p);
    const fields::Polar away = fields::polar(beyond, Vec3(0.0));
    if (away.length > 1e-100) {
      const double across = rise_.slope(away.length) / away.length;
      out.hessian += outer(away.direction, away.direction) * (rise_.bend(away.length) - across);
      for (int axis = 0; axis < 3; ++axis) {
        if (beyond[axis] != 0.0) out.hessian[axis][axis] += across;
      }
    }
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }
  /// Outside the bounds the field is at least the added term.
  [[nodiscard]] Box3 boundsBelow(double level) const override {
    return bounds_.grownBy(rise_.reach(level));
  }

 private:
  /// Half the smallest radius: as smooth as the surface, and small compared with the shape.
  static double riseWidth(const std::vector<Metaball>& balls) {
    double least = kInfinity;
    for (const Metaball& ball : balls) least = std::min(least, ball.radius);
    return 0.5 * least;
  }

  [[nodiscard]] Vec3 beyondBounds(const Vec3& p) const noexcept {
    return glm::min(p - bounds_.lo, Vec3(0.0)) + glm::max(p - bounds_.hi, Vec3(0.0));
  }

  std::vector<Metaball> balls_;  ///< in the order of the tree
  BallTree tree_;
  std::vector<double> inverse_squares_;  ///< [1/m^2] of the radii
  double iso_;
  double scale_;  ///< [m]
  double lipschitz_;
  Box3 bounds_;
  Rise rise_;
  double feature_ = kInfinity;
};

/// The union of boxes in each of which one ball alone reaches its share of `iso`: where the sum
/// reaches `iso`, at least one ball does.
Box3 boundsOf(const std::vector<Metaball>& balls, FallOff fall_off, double iso) {
  double count = 0.0;
  double most = 0.0;
  for (const Metaball& ball : balls) {
    if (ball.strength <= 0.0) continue;
    count += 1.0;
    most += ball.strength;
  }
  if (!(most > iso)) {
    throw inputError("field.no_surface",
                     "metaballs: the positive strengths add up to " + std::to_string(most) +
                         "; they must add up to more than iso = " + std::to_string(iso));
  }
  Box3 box;
  for (const Metaball& ball : balls) {
    if (ball.strength <= 0.0) continue;
    const double share = iso / (count * ball.strength);
    if (share >= 1.0) continue;
    const double reach = ball.radius * fields::reachOf(fall_off, share) * (1.0 + 1e-12);
    box = box.unitedWith({ball.center - Vec3(reach), ball.center + Vec3(reach)});
  }
  return box;
}

}  // namespace

FieldPtr metaballs(std::vector<Metaball> balls, FallOff fall_off, double iso) {
  if (balls.empty()) {
    throw inputError("field.too_few_operands",
                     "metaballs: there are 0 balls; there must be 1 or more");
  }
  fields::checkRange("metaballs", "iso", iso, 1e-9, 1e9);
  double scale = kInfinity;
  for (const Metaball& ball : balls) {
    fields::checkPoint("metaballs", "center", ball.center);
    fields::checkLength("metaballs", "radius", ball.radius);
    fields::checkRange("metaballs", "strength", ball.strength, -1e9, 1e9);
    // Chosen so that the steepest ball alone has slope 1.
    const double slope = std::fabs(ball.strength) * fields::steepest(fall_off, 0.0, kInfinity);
    if (slope > 0.0) scale = std::min(scale, ball.radius / slope);
  }
  const Box3 bounds = boundsOf(balls, fall_off, iso);
  const double lipschitz = 1.0 + scale * fields::steepestSum(balls, fall_off);
  switch (fall_off) {
    case FallOff::kWyvill:
      return std::make_shared<Metaballs<FallOff::kWyvill>>(std::move(balls), iso, scale, lipschitz,
                                                           bounds);
    case FallOff::kGaussian:
      return std::make_shared<Metaballs<FallOff::kGaussian>>(std::move(balls), iso, scale,
                                                             lipschitz, bounds);
    case FallOff::kInverseSquare:
      break;
  }
  return std::make_shared<Metaballs<FallOff::kInverseSquare>>(std::move(balls), iso, scale,
                                                              lipschitz, bounds);
}

}  // namespace palpate
