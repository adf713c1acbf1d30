#include "fields/batch.h"
#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

constexpr Vec3 kAtCenter(1.0, 0.0, 0.0);

class Sphere final : public Field {
 public:
  Sphere(const Vec3& center, double radius) : center_(center), radius_(radius) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const fields::Polar q = fields::polar(p - center_, kAtCenter);
    return {q.length - radius_, q.direction};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return fields::length(p - center_) - radius_;
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    const Vec3 center = center_;  // a copy: the stores below cannot change it
    const double radius = radius_;
    fields::Squares squares;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const double x = points.x[n] - center.x;
      const double y = points.y[n] - center.y;
      const double z = points.z[n] - center.z;
      squares[n] = x * x + y * y + z * z;
    }
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) out[n] = std::sqrt(squares[n]) - radius;
    fields::valuesOfLeftovers(*this, points, squares, out);
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const fields::Polar q = fields::polar(p - center_, kAtCenter);
    return {q.length - radius_, q.direction, fields::radialHessian(q.direction, q.length)};
  }
  [[nodiscard]] Box3 bounds() const noexcept override {
    return {center_ - Vec3(radius_), center_ + Vec3(radius_)};
  }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return radius_; }

 private:
  Vec3 center_;
  double radius_;
};

}  // namespace

FieldPtr sphere(const Vec3& center, double radius) {
  fields::checkPoint("sphere", "center", center);
  fields::checkLength("sphere", "radius", radius);
  return std::make_shared<Sphere>(center, radius);
}

}  // namespace palpate
