#include <algorithm>
#include <queue>
#include <string>
#include <utility>

#include "fields/checks.h"
#include "fields/level_bounds.h"
#include "fields/vector.h"
#include "palpate/core/error.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

/// A fall-off as a function of t = q^2, with derivatives by t.
struct Kernel {
  double value = 0.0;
  double first = 0.0;
  double second = 0.0;
};

template <FallOff kFallOff>
Kernel kernelAt(double t) noexcept {
  if constexpr (kFallOff == FallOff::kWyvill) {
    const double s = t < 1.0 ? 1.0 - t : 0.0;
    return {s * s * s, -3.0 * s * s, 6.0 * s};
  } else if constexpr (kFallOff == FallOff::kGaussian) {
    const double e = std::exp(-t);
    return {e, -e, e};
  } else {
    const double s = 1.0 / (1.0 + t);
    return {s, -s * s, 2.0 * s * s * s};
  }
}

/// q at which the fall-off has come down to `value`, 0 < value < 1.
double reachOf(FallOff fall_off, double value) {
  switch (fall_off) {
    case FallOff::kWyvill:
      return std::sqrt(1.0 - std::cbrt(value));
    case FallOff::kGaussian:
      return std::sqrt(-std::log(value));
    case FallOff::kInverseSquare:
      break;
  }
  return std::sqrt(1.0 / value - 1.0);
}

/// The steepest slope by q between `lo` and `hi`; each kernel is steepest at one q and less on both
/// sides of it.
double steepest(FallOff fall_off, double lo, double hi) {
  if (fall_off == FallOff::kWyvill) {
    const double q = std::clamp(std::sqrt(0.2), lo, hi);
    return -2.0 * q * kernelAt<FallOff::kWyvill>(q * q).first;
  }
  if (fall_off == FallOff::kGaussian) {
    const double q = std::clamp(std::sqrt(0.5), lo, hi);
    return -2.0 * q * kernelAt<FallOff::kGaussian>(q * q).first;
  }
  const double q = std::clamp(std::sqrt(1.0 / 3.0), lo, hi);
  return -2.0 * q * kernelAt<FallOff::kInverseSquare>(q * q).first;
}

/// An upper bound on the slope of the sum anywhere: the worst of boxes that are halved, the worst
/// one first, until it is tight to a twentieth or enough work was done.
double steepestSum(const std::vector<Metaball>& balls, FallOff fall_off) {
  const auto bound = [&](const Box3& box) {
    double sum = 0.0;
    for (const Metaball& ball : balls) {
      const double nearest = box.distanceTo(ball.center);
      const Vec3 far = glm::max(glm::abs(box.lo - ball.center), glm::abs(box.hi - ball.center));
      sum += std::fabs(ball.strength) / ball.radius *
             steepest(fall_off, nearest / ball.radius, glm::length(far) / ball.radius);
    }
    return sum;
  };
  // Farther than a radius from every ball all slopes go down with distance, so the worst point lies
  // in the box around the balls.
  Box3 start;
  for (const Metaball& ball : balls) {
    start = start.unitedWith({ball.center - Vec3(ball.radius), ball.center + Vec3(ball.radius)});
  }
  struct Item {
    double bound;
    Box3 box;
    bool operator<(const Item& other) const { return bound < other.bound; }
  };
  std::priority_queue<Item> queue;
  queue.push({bound(start), start});
  double found = 0.0;
  const std::size_t most = std::clamp<std::size_t>(20'000'000 / balls.size(), 200, 20'000);
  for (std::size_t i = 0; i < most && queue.top().bound > 1.05 * found; ++i) {
    const Item item = queue.top();
    queue.pop();
    const Vec3 middle = item.box.center();
    found = std::max(found, bound({middle, middle}));
    const Vec3 size = item.box.size();
    int axis = size.y > size.x ? 1 : 0;
    if (size.z > size[axis]) axis = 2;
    Box3 low = item.box;
    Box3 high = item.box;
    low.hi[axis] = high.lo[axis] = middle[axis];
    queue.push({bound(low), low});
    queue.push({bound(high), high});
  }
  return queue.top().bound;
}

/// scale * (iso - sum of strength * kernel) + distance to the bounds.
template <FallOff kFallOff>
class Metaballs final : public Field, public fields::LevelBounded {
 public:
  Metaballs(std::vector<Metaball> balls, double iso, double scale, double lipschitz,
            const Box3& bounds)
      : balls_(std::move(balls)), iso_(iso), scale_(scale), lipschitz_(lipschitz), bounds_(bounds) {
    for (const Metaball& ball : balls_) {
      feature_ = std::min(feature_, 0.1 * ball.radius);
      inverse_squares_.push_back(1.0 / (ball.radius * ball.radius));
    }
  }

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    double sum = 0.0;
    Vec3 slope(0.0);
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Vec3 d = p - balls_[i].center;
      const Kernel k = kernelAt<kFallOff>(glm::dot(d, d) * inverse_squares_[i]);
      sum += balls_[i].strength * k.value;
      if (k.first != 0.0) slope += d * (balls_[i].strength * k.first * inverse_squares_[i]);
    }
    FieldSample out{scale_ * (iso_ - sum), slope * (-2.0 * scale_)};
    const Vec3 beyond = beyondBounds(p);
    if (beyond != Vec3(0.0)) {
      const fields::Polar away = fields::polar(beyond, Vec3(1.0, 0.0, 0.0));
      out.value += away.length;
      out.gradient += away.direction;
    }
    return out;
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    double sum = 0.0;
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const Vec3 d = p - balls_[i].center;
      sum += balls_[i].strength * kernelAt<kFallOff>(glm::dot(d, d) * inverse_squares_[i]).value;
    }
    const double inner = scale_ * (iso_ - sum);
    const Vec3 beyond = beyondBounds(p);
    return beyond != Vec3(0.0) ? inner + fields::length(beyond) : inner;
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldSample here = sample(p);
    FieldJet out{here.value, here.gradient, Mat3(0.0)};
    for (std::size_t i = 0; i < balls_.size(); ++i) {
      const double inverse = inverse_squares_[i];
      const Vec3 d = p - balls_[i].center;
      const Kernel k = kernelAt<kFallOff>(glm::dot(d, d) * inverse);
      if (k.first == 0.0) continue;
      const double share = -2.0 * scale_ * balls_[i].strength * inverse;
      out.hessian += Mat3(share * k.first) + outer(d, d) * (2.0 * share * inverse * k.second);
    }
    const Vec3 beyond = beyondBounds(p);
    const fields::Polar away = fields::polar(beyond, Vec3(0.0));
    if (away.length > 1e-100) {
      out.hessian -= outer(away.direction, away.direction) * (1.0 / away.length);
      for (int axis = 0; axis < 3; ++axis) {
        if (beyond[axis] != 0.0) out.hessian[axis][axis] += 1.0 / away.length;
      }
    }
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return lipschitz_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }
  /// Out of the bounds the field is at least the distance to them.
  [[nodiscard]] Box3 boundsBelow(double level) const override { return bounds_.grownBy(level); }

 private:
  [[nodiscard]] Vec3 beyondBounds(const Vec3& p) const noexcept {
    return glm::min(p - bounds_.lo, Vec3(0.0)) + glm::max(p - bounds_.hi, Vec3(0.0));
  }

  std::vector<Metaball> balls_;
  std::vector<double> inverse_squares_;  ///< [1/m^2] of the radii
  double iso_;
  double scale_;  ///< [m]
  double lipschitz_;
  Box3 bounds_;
  double feature_ = kInfinity;
};

/// Where one of the balls alone reaches its share of `iso`: the sum needs that of at least one.
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
                         ", permitted is more than iso = " + std::to_string(iso));
  }
  Box3 box;
  for (const Metaball& ball : balls) {
    if (ball.strength <= 0.0) continue;
    const double share = iso / (count * ball.strength);
    if (share >= 1.0) continue;
    const double reach = ball.radius * reachOf(fall_off, share) * (1.0 + 1e-12);
    box = box.unitedWith({ball.center - Vec3(reach), ball.center + Vec3(reach)});
  }
  return box;
}

}  // namespace

FieldPtr metaballs(std::vector<Metaball> balls, FallOff fall_off, double iso) {
  if (balls.empty()) {
    throw inputError("field.too_few_operands",
                     "metaballs: there are 0 balls, permitted is 1 or more");
  }
  fields::checkRange("metaballs", "iso", iso, 1e-9, 1e9);
  double scale = kInfinity;
  for (const Metaball& ball : balls) {
    fields::checkPoint("metaballs", "center", ball.center);
    fields::checkLength("metaballs", "radius", ball.radius);
    fields::checkRange("metaballs", "strength", ball.strength, -1e9, 1e9);
    // So that the steepest ball alone has slope 1.
    const double slope = std::fabs(ball.strength) * steepest(fall_off, 0.0, kInfinity);
    if (slope > 0.0) scale = std::min(scale, ball.radius / slope);
  }
  const Box3 bounds = boundsOf(balls, fall_off, iso);
  const double lipschitz = 1.0 + scale * steepestSum(balls, fall_off);
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
