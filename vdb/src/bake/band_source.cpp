#include "bake/band_source.h"

#include <algorithm>
#include <cmath>

#include "palpate/fields/foot_point.h"

namespace palpate::vdb {

namespace {

/// How far it is to the surface at least, if the slope grows by no more than twice what it does here:
/// where |S| = |grad S| t + |H| t^2.
double leastDistance(const FieldJet& jet) noexcept {
  double square = 0.0;
  for (int column = 0; column < 3; ++column) {
    square += glm::dot(jet.hessian[column], jet.hessian[column]);
  }
  const double slope = glm::length(jet.gradient);
  const double bend = std::sqrt(square);
  // The root, written so that it holds for no bend as well.
  const double value = std::fabs(jet.value);
  return 2.0 * value / (slope + std::sqrt(slope * slope + 4.0 * bend * value));
}

}  // namespace

BandSource::BandSource(const Field& field, const Box3& domain, bool is_cut, double band)
    : field_(field),
      parts_(field),
      band_(band),
      domain_(domain),
      is_cut_(is_cut),
      implicit_(field.metric() == Metric::kImplicit),
      exact_(field.metric() == Metric::kExact),
      lipschitz_(field.lipschitz()) {}

// |S / |grad S|| is at least |S| / L.
Verdict BandSource::judge(const FieldPart& from, const Vec3& center, double radius,
                          bool only_in_band, FieldPart& to) const {
  // A billionth covers the rounding of positions and values.
  const double far = lipschitz_ * band_ * (1.0 + 1e-9);
  // What is made a distance by its gradient is asked as a whole.
  double limit = kInfinity;
  if (only_in_band && !implicit_) limit = far;
  const ValueRange range = parts_.narrow(from, center, radius, limit, to);
  Verdict verdict = Verdict::kKeep;
  if (range.lo > far) verdict = Verdict::kOutside;
  if (range.hi < -far) verdict = Verdict::kInside;
  if (is_cut_ && verdict != Verdict::kOutside) {
    const double wall = boxDistance(center);
    const double reach = (radius + band_) * (1.0 + 1e-9);
    if (wall > reach) return Verdict::kOutside;
    if (wall >= -reach) return Verdict::kKeep;
  }
  // Out there withWall() lifts all values out of the band.
  if (!is_cut_ && !exact_ && boxDistance(center) > (radius + band_) * (1.0 + 1e-9)) {
    return Verdict::kOutside;
  }
  return verdict;
}

std::uint64_t BandSource::values(const FieldPart& part, const PointBatch& points,
                                 const Vec3& center, double radius,
                                 ValueBatch& out) const noexcept {
  std::uint64_t known = ~std::uint64_t{0};
  parts_.values(part, points, out);
  const bool has_wall = hasWallNear(center, radius);
  if (!implicit_ && !has_wall) return known;
  // So far off, the distance is beyond the band whatever the gradient is.
  const Box3 domain = field_.lipschitzDomain();
  const bool is_bounded =
      domain.contains(center - Vec3(radius)) && domain.contains(center + Vec3(radius));
  const double far = is_bounded ? 2.0 * band_ * lipschitz_ : kInfinity;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
    const Vec3 p = points[n];
    Value value{out[n], true};
    if (implicit_)
      value = std::fabs(out[n]) > far ? Value{out[n] / lipschitz_, true} : distanceAt(p);
    if (has_wall) value = withWall(value, p);
    out[n] = value.distance;
    if (!value.known) known &= ~(std::uint64_t{1} << n);
  }
  return known;
}

BandSource::Value BandSource::distanceAt(const Vec3& p) const noexcept {
  const FieldSample sample = field_.sample(p);
  if (!sample.in_band) return {sample.value, false};
  const double slope = glm::length(sample.gradient);
  // Where the gradient vanishes the quotient says "far away", which is all the band needs.
  const double near = sample.value == 0.0 ? 0.0 : sample.value / slope;
  // Off by second order in the distance. The exact one is worth its time only in the band, for which a
  // quotient twice as large leaves room; and less does where the slope does not grow.
  if (std::abs(near) > 2.0 * band_) return {near, true};
  if (std::abs(near) > band_ && leastDistance(field_.jet(p)) > 1.25 * band_) return {near, true};
  const auto foot = footPoint(field_, p);
  return {foot ? foot->distance : near, true};
}

BandSource::Value BandSource::withWall(Value value, const Vec3& p) const noexcept {
  double wall = boxDistance(p);
  if (!is_cut_ && wall < band_) wall = 2.0 * wall - band_;
  if (wall > value.distance && (is_cut_ || wall > 0.0)) {
    // A known wall decides over a field that is inside, however deep; elsewhere it is a bound.
    return {wall, value.known || (is_cut_ && value.distance < 0.0)};
  }
  return value;
}

/// Whether withWall() may say something in the ball that the field does not.
bool BandSource::hasWallNear(const Vec3& center, double radius) const noexcept {
  if (exact_ && !is_cut_) return false;
  const double most = boxDistance(center) + radius * (1.0 + 1e-9);
  // A wall deeper than the band leaves what is there, and what is beyond it, as it is.
  return is_cut_ ? most > -band_ : most > 0.5 * band_;
}

double BandSource::boxDistance(const Vec3& p) const noexcept {
  const Vec3 q = glm::max(domain_.lo - p, p - domain_.hi);
  const double inside = std::min(std::max({q.x, q.y, q.z}), 0.0);
  return glm::length(glm::max(q, Vec3(0.0))) + inside;
}

}  // namespace palpate::vdb
