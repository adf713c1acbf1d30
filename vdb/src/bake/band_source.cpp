#include "bake/band_source.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {

BandSource::BandSource(const Field& field, const Box3& domain, bool is_cut, double band)
    : parts_(field),
      band_(band),
      domain_(domain),
      is_cut_(is_cut),
      implicit_(field.metric() == Metric::kImplicit),
      exact_(field.metric() == Metric::kExact),
      lipschitz_(field.lipschitz()) {}

// The distance is at least |S| / L.
Verdict BandSource::judge(const FieldPart& from, const Vec3& center, double radius,
                          bool only_in_band, FieldPart& to) const {
  // A relative billionth covers the rounding of positions and values.
  const double far = lipschitz_ * band_ * (1.0 + 1e-9);
  // Near the surface of an implicit field the gradient of the whole field is asked for as well, so
  // that no operand is dropped by value there.
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
  // At this distance from the box withWall() raises every value in the ball beyond the band.
  if (!is_cut_ && !exact_ && boxDistance(center) > (radius + band_) * (1.0 + 1e-9)) {
    return Verdict::kOutside;
  }
  return verdict;
}

void BandSource::values(const FieldPart& part, const PointBatch& points, const Vec3& center,
                        double radius, ValueBatch& out) const noexcept {
  parts_.values(part, points, out);
  if (!hasWallNear(center, radius)) return;
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) out[n] = withWall(out[n], points[n]);
}

double BandSource::withWall(double value, const Vec3& p) const noexcept {
  double wall = boxDistance(p);
  if (!is_cut_ && wall < band_) wall = 2.0 * wall - band_;
  return wall > value && (is_cut_ || wall > 0.0) ? wall : value;
}

/// Whether withWall() may give another value in the ball than the field does.
bool BandSource::hasWallNear(const Vec3& center, double radius) const noexcept {
  if (exact_ && !is_cut_) return false;
  const double most = boxDistance(center) + radius * (1.0 + 1e-9);
  // A wall that lies deeper than the band changes nothing in the ball.
  return is_cut_ ? most > -band_ : most > 0.5 * band_;
}

double BandSource::boxDistance(const Vec3& p) const noexcept {
  const Vec3 q = glm::max(domain_.lo - p, p - domain_.hi);
  const double inside = std::min(std::max({q.x, q.y, q.z}), 0.0);
  return glm::length(glm::max(q, Vec3(0.0))) + inside;
}

}  // namespace palpate::vdb
