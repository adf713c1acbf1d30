#include <algorithm>

#include "fields/batch.h"
#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// The points nearer than `rounding` to a box; the box itself if that is 0.
class Box final : public Field {
 public:
  Box(const Vec3& center, const Vec3& half_size, double rounding)
      : center_(center),
        half_(half_size),
        rounding_(rounding),
        feature_(rounding > 0.0 ? rounding : 2.0 * smallest(half_size)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Vec3 d = p - center_;
    const Vec3 q = glm::abs(d) - half_;
    if (isInside(q)) {
      const int axis = nearestFace(q);
      FieldSample out{q[axis] - rounding_, Vec3(0.0)};
      out.gradient[axis] = fields::side(d[axis]);
      return out;
    }
    const fields::Polar away = fields::polar(glm::max(q, Vec3(0.0)), Vec3(1.0, 0.0, 0.0));
    return {away.length - rounding_, signedLike(away.direction, d)};
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    const Vec3 q = glm::abs(p - center_) - half_;
    if (isInside(q)) return q[nearestFace(q)] - rounding_;
    return fields::length(glm::max(q, Vec3(0.0))) - rounding_;
  }

  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    const Vec3 center = center_;  // copies: the stores below cannot change them
    const Vec3 half = half_;
    const double rounding = rounding_;
    const auto positive = [](double a) { return a < 0.0 ? 0.0 : a; };
    fields::Squares squares, distances;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const double x = std::fabs(points.x[n] - center.x) - half.x;
      const double y = std::fabs(points.y[n] - center.y) - half.y;
      const double z = std::fabs(points.z[n] - center.z) - half.z;
      const double xy = y > x ? y : x;
      const double nearest = z > xy ? z : xy;
      const double a = positive(x);
      const double b = positive(y);
      const double c = positive(z);
      const double square = a * a + b * b + c * c;
      const double away = std::sqrt(square);
      squares[n] =
          nearest <= 0.0 ? square + 1.0 : square;  // inside, the square is 0 and is not used
      distances[n] = (nearest <= 0.0 ? nearest : away) - rounding;
    }
    out = distances;
    fields::valuesOfLeftovers(*this, points, squares, out);
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldSample here = sample(p);
    FieldJet out{here.value, here.gradient, Mat3(0.0)};
    const Vec3 q = glm::abs(p - center_) - half_;
    const double distance = fields::length(glm::max(q, Vec3(0.0)));
    if (isInside(q) || !(distance > 1e-100)) return out;
    // Beyond a face the distance has no curvature; beyond an edge or corner it is the distance from
    // a line or point.
    const double curvature = 1.0 / distance;
    out.hessian = outer(here.gradient, here.gradient) * -curvature;
    for (int axis = 0; axis < 3; ++axis) {
      if (q[axis] > 0.0) out.hessian[axis][axis] += curvature;
    }
    return out;
  }

  [[nodiscard]] Box3 bounds() const noexcept override {
    const Vec3 extent = half_ + Vec3(rounding_);
    return {center_ - extent, center_ + extent};
  }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  static double smallest(const Vec3& v) { return std::min({v.x, v.y, v.z}); }
  static bool isInside(const Vec3& q) noexcept { return q.x <= 0.0 && q.y <= 0.0 && q.z <= 0.0; }
  static int nearestFace(const Vec3& q) noexcept {
    int axis = 0;
    if (q.y > q[axis]) axis = 1;
    if (q.z > q[axis]) axis = 2;
    return axis;
  }
  static Vec3 signedLike(const Vec3& v, const Vec3& d) noexcept {
    return {v.x * fields::side(d.x), v.y * fields::side(d.y), v.z * fields::side(d.z)};
  }

  Vec3 center_;
  Vec3 half_;
  double rounding_;
  double feature_;
};

}  // namespace

FieldPtr box(const Vec3& center, const Vec3& size) {
  fields::checkPoint("box", "center", center);
  fields::checkLengths("box", "size", size);
  std::vector<FieldPtr> faces;
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      Vec3 normal(0.0);
      normal[axis] = side;
      faces.push_back(halfSpace(center + 0.5 * size * normal, normal));
    }
  }
  return withFaces(std::make_shared<Box>(center, 0.5 * size, 0.0), std::move(faces));
}

FieldPtr roundedBox(const Vec3& center, const Vec3& size, double rounding) {
  fields::checkPoint("rounded_box", "center", center);
  fields::checkLengths("rounded_box", "size", size);
  fields::checkRange("rounded_box", "rounding", rounding, fields::kSmallestLength,
                     0.5 * std::min({size.x, size.y, size.z}));
  return std::make_shared<Box>(center, 0.5 * size - Vec3(rounding), rounding);
}

}  // namespace palpate
