#include <algorithm>
#include <array>

#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/core/error.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

/// d^T A d + b.d + c, d the position from the center, divided by its steepest slope in the domain.
struct Form {
  Mat3 a{0.0};
  Vec3 b{0.0};
  double c = 0.0;
};

constexpr double kFarthest = 1e100;  ///< [m] points farther away are treated as if they were here

class Quadric final : public Field {
 public:
  Quadric(const Vec3& center, const Form& form, const Box3& bounds, const Box3& domain,
          double feature)
      : center_(center), form_(form), bounds_(bounds), domain_(domain), feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Vec3 d = reached(p - center_);
    const Vec3 ad = form_.a * d;
    return {glm::dot(d, ad) + glm::dot(form_.b, d) + form_.c, 2.0 * ad + form_.b};
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const FieldSample here = sample(p);
    return {here.value, here.gradient, 2.0 * form_.a};
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bounds_; }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override { return domain_; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  static Vec3 reached(const Vec3& d) noexcept {
    const double size = std::max({std::fabs(d.x), std::fabs(d.y), std::fabs(d.z)});
    return size > kFarthest ? d * (kFarthest / size) : d;
  }

  Vec3 center_;
  Form form_;
  Box3 bounds_;
  Box3 domain_;
  double feature_;
};

/// Eigenvalues of a symmetric matrix by Jacobi rotations; the columns of `axes` are its
/// eigenvectors.
Vec3 eigenvalues(Mat3 m, Mat3& axes) {
  axes = Mat3(1.0);
  for (int sweep = 0; sweep < 30; ++sweep) {
    for (const auto& [i, j] : {std::array{0, 1}, std::array{0, 2}, std::array{1, 2}}) {
      if (m[i][j] == 0.0) continue;
      const double angle = 0.5 * std::atan2(2.0 * m[i][j], m[j][j] - m[i][i]);
      Mat3 turn(1.0);
      turn[i][i] = turn[j][j] = std::cos(angle);
      turn[j][i] = std::sin(angle);
      turn[i][j] = -std::sin(angle);
      m = glm::transpose(turn) * m * turn;
      axes = axes * turn;
    }
  }
  return {m[0][0], m[1][1], m[2][2]};
}

struct Shape {
  Box3 bounds = Box3::everything();  ///< relative to the center
  double feature = 0.0;              ///< [m] 0: the form does not determine it
};

/// Bounds and feature size that follow from the normal form. `form` has been scaled so that its
/// entries are about 1.
Shape shapeOf(const Form& form) {
  Mat3 axes(1.0);
  const Vec3 lambda = eigenvalues(form.a, axes);
  const Vec3 slope = glm::transpose(axes) * form.b;
  const double largest = std::max({std::fabs(lambda.x), std::fabs(lambda.y), std::fabs(lambda.z)});
  Shape shape;
  if (largest == 0.0) return shape;
  double smallest = largest;
  double constant = form.c;
  double flat_slope = 0.0;
  int curved = 0;
  int positive = 0;
  Vec3 middle(0.0);
  for (int i = 0; i < 3; ++i) {
    if (std::fabs(lambda[i]) <= 1e-12 * largest) {
      flat_slope = std::hypot(flat_slope, slope[i]);
      continue;
    }
    ++curved;
    if (lambda[i] > 0.0) ++positive;
    smallest = std::min(smallest, std::fabs(lambda[i]));
    middle[i] = -0.5 * slope[i] / lambda[i];
    constant -= 0.25 * slope[i] * slope[i] / lambda[i];
  }
  const bool is_even = curved == 3 || flat_slope <= 1e-12 * glm::length(slope);
  const bool is_positive = positive == curved;
  if (is_even && ((is_positive && constant >= 0.0) || (positive == 0 && constant <= 0.0))) {
    throw inputError("field.no_surface",
                     "quadric: the polynomial has the same sign everywhere, so it has no "
                     "surface",
                     "inside is where it is negative; check the sign of the constant");
  }
  // On the surface |gradient|^2 >= 4 |constant| smallest + flat_slope^2, and each curvature is at
  // most 2 largest / |gradient|.
  shape.feature =
      std::sqrt(4.0 * std::fabs(constant) * smallest + flat_slope * flat_slope) / (2.0 * largest);
  if (curved == 3 && is_positive) {
    Vec3 extent(0.0);
    for (int i = 0; i < 3; ++i) {
      extent += axes[i] * axes[i] * (-constant / lambda[i]);
    }
    const Vec3 center = axes * middle;
    shape.bounds = {center - glm::sqrt(extent), center + glm::sqrt(extent)};
    shape.bounds = shape.bounds.grownBy(1e-12 * glm::length(shape.bounds.size()));
  }
  return shape;
}

/// The gradient is linear, so its length is largest at a corner of the box.
double steepestIn(const Box3& box, const Form& form) {
  double steepest = 0.0;
  for (int i = 0; i < 8; ++i) {
    const Vec3 corner((i & 1) != 0 ? box.hi.x : box.lo.x, (i & 2) != 0 ? box.hi.y : box.lo.y,
                      (i & 4) != 0 ? box.hi.z : box.lo.z);
    steepest = std::max(steepest, glm::length(2.0 * (form.a * corner) + form.b));
  }
  return steepest;
}

}  // namespace

FieldPtr quadric(const Vec3& center, const QuadricCoefficients& coefficients, double reach) {
  const QuadricCoefficients& q = coefficients;
  fields::checkPoint("quadric", "center", center);
  fields::checkLength("quadric", "reach", reach);
  double largest = 0.0;
  for (const double value : {q.xx, q.yy, q.zz, q.xy, q.xz, q.yz, q.x, q.y, q.z, q.constant}) {
    fields::checkFinite("quadric", "a coefficient", value);
    largest = std::max(largest, std::fabs(value));
  }
  // Scale the numbers to about 1 before they are squared.
  const double scale = largest > 0.0 ? 1.0 / largest : 1.0;
  Form form;
  form.a = Mat3(q.xx, 0.5 * q.xy, 0.5 * q.xz, 0.5 * q.xy, q.yy, 0.5 * q.yz, 0.5 * q.xz, 0.5 * q.yz,
                q.zz) *
           scale;
  form.b = Vec3(q.x, q.y, q.z) * scale;
  form.c = q.constant * scale;
  if (form.a == Mat3(0.0) && form.b == Vec3(0.0)) {
    throw inputError("field.no_surface",
                     "quadric: all coefficients but the constant are 0; the polynomial must "
                     "depend on x, y or z");
  }
  const Shape shape = shapeOf(form);
  Box3 domain{Vec3(-reach), Vec3(reach)};
  if (shape.bounds.isBounded()) {
    domain = shape.bounds.grownBy(glm::length(shape.bounds.size()));
  }
  const double slope = steepestIn(domain, form) * (1.0 + 1e-12);
  form.a *= 1.0 / slope;
  form.b /= slope;
  form.c /= slope;
  const double size = glm::length(domain.size());
  const double feature = shape.feature > 0.0 ? std::min(shape.feature, 0.1 * size) : 1e-3 * size;
  const Box3 bounds = shape.bounds.isBounded()
                          ? Box3{shape.bounds.lo + center, shape.bounds.hi + center}
                          : shape.bounds;
  return std::make_shared<Quadric>(center, form, bounds,
                                   Box3{domain.lo + center, domain.hi + center}, feature);
}

}  // namespace palpate
