#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/fields/primitives.h"

namespace palpate {
namespace {

/// A plane has no size of its own. A tenth of a meter is the scale of a hand's motion: tolerances
/// relative to it are far below what can be felt, and far above rounding.
constexpr double kPlaneFeature = 0.1;

class HalfSpace final : public Field {
 public:
  HalfSpace(const Vec3& point, const Vec3& normal) : point_(point), normal_(normal) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return {value(p), normal_};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    return glm::dot(normal_, p - point_);
  }
  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    const Vec3 point = point_;  // copies: the stores below cannot change them
    const Vec3 normal = normal_;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      out[n] = normal.x * (points.x[n] - point.x) + normal.y * (points.y[n] - point.y) +
               normal.z * (points.z[n] - point.z);
    }
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    return {value(p), normal_, Mat3(0.0)};
  }
  [[nodiscard]] Box3 bounds() const noexcept override {
    Box3 box = Box3::everything();
    for (int axis = 0; axis < 3; ++axis) {
      if (normal_[axis] == 1.0) box.hi[axis] = point_[axis];
      if (normal_[axis] == -1.0) box.lo[axis] = point_[axis];
    }
    return box;
  }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return kPlaneFeature; }
  [[nodiscard]] bool isFlat() const noexcept override { return true; }

 private:
  Vec3 point_;
  Vec3 normal_;
};

}  // namespace

FieldPtr halfSpace(const Vec3& point, const Vec3& normal) {
  fields::checkPoint("half_space", "point", point);
  return std::make_shared<HalfSpace>(point,
                                     fields::checkedDirection("half_space", "normal", normal));
}

}  // namespace palpate
