#include <algorithm>

#include "fields/checks.h"
#include "fields/vector.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

/// Taubin's heart u^3 = w z^3, with u = x^2 + 9/4 y^2 + z^2 - 1 and w = x^2 + 9/80 y^2, has the
/// zero set of f = u - z cbrt(w). The slope of cbrt(w) is unbounded on the axis w = 0, where the
/// surface has its two cusps; w / (w + e)^(2/3) is smooth, and its relative difference from cbrt(w)
/// is only 2 e / (3 w). f grows like a square, so the field is sqrt(2) (sqrt(2 + f) - sqrt(2)),
/// which grows like a distance and has the gradient of f / 2 on the surface. f is never below
/// -1.01.
constexpr double kRounding = 1e-4;  // e: it rounds the cusps within 0.01
constexpr double kHalfWidth = 1.13901;
constexpr double kSteepest = 3.16;    // by search: 3.135
constexpr double kTipRadius = 0.002;  // e^(2/3), radius of the tip in the plane y = 0
constexpr double kLimit = 1e60;       // beyond this only the squares matter

class Heart final : public Field {
 public:
  Heart(const Vec3& center, double width)
      : center_(center), unit_(0.5 * width / kHalfWidth), inverse_(1.0 / unit_) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Vec3 q = (p - center_) * inverse_;
    if (isFarAway(q)) [[unlikely]]
      return farAway(q);
    const Parts f = partsAt(q);
    const double root = std::sqrt(2.0 + f.value);
    return {unit_ * valueOf(root), f.gradient * (std::sqrt(0.5) / root)};
  }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const Vec3 q = (p - center_) * inverse_;
    if (isFarAway(q)) [[unlikely]] {
      const FieldSample far = farAway(q);
      return {far.value, far.gradient, Mat3(0.0)};
    }
    const Parts f = partsAt(q);
    const double root = std::sqrt(2.0 + f.value);
    FieldJet out{unit_ * valueOf(root), f.gradient * (std::sqrt(0.5) / root), Mat3(0.0)};
    // The terms u_i u_j, then -z g'' w_i w_j - z g' w_ij, then the mixed terms of -z g.
    const Vec3 w_by(2.0 * q.x, 0.225 * q.y, 0.0);
    Mat3 h = outer(w_by, w_by) * (-q.z * f.g2);
    h[0][0] += 2.0 - q.z * f.g1 * 2.0;
    h[1][1] += 4.5 - q.z * f.g1 * 0.225;
    h[2][2] += 2.0;
    const Vec3 up(0.0, 0.0, 1.0);
    h -= (outer(w_by, up) + outer(up, w_by)) * f.g1;
    const double first = std::sqrt(0.5) / root;
    const double second = -0.5 * first / (root * root);
    out.hessian = (h * first + outer(f.gradient, f.gradient) * second) * inverse_;
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override {
    return {center_ + unit_ * Vec3(-1.1391, -0.6782, -1.0001),
            center_ + unit_ * Vec3(1.1391, 0.6782, 1.2366)};
  }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return kSteepest; }
  [[nodiscard]] double featureSize() const noexcept override { return kTipRadius * unit_; }

 private:
  struct Parts {
    double value = 0.0;
    Vec3 gradient{0.0};
    double g1 = 0.0;  ///< derivatives of w / (w + e)^(2/3) by w
    double g2 = 0.0;
  };

  static Parts partsAt(const Vec3& q) noexcept {
    const double u = q.x * q.x + 2.25 * q.y * q.y + q.z * q.z - 1.0;
    const double w = q.x * q.x + 0.1125 * q.y * q.y;
    const double soft = w + kRounding;
    const double root = std::cbrt(soft);
    const double g = w / (root * root);
    const double g1 = (w / 3.0 + kRounding) / (soft * root * root);
    const double g2 = -(2.0 * w / 9.0 + 4.0 * kRounding / 3.0) / (soft * soft * root * root);
    return {u - q.z * g,
            Vec3(2.0 * q.x * (1.0 - q.z * g1), 4.5 * q.y - 0.225 * q.y * q.z * g1, 2.0 * q.z - g),
            g1, g2};
  }
  static double valueOf(double root) noexcept { return std::sqrt(2.0) * (root - std::sqrt(2.0)); }
  static bool isFarAway(const Vec3& q) noexcept {
    return !(std::max({std::fabs(q.x), std::fabs(q.y), std::fabs(q.z)}) <= kLimit);
  }
  [[nodiscard]] FieldSample farAway(const Vec3& q) const noexcept {
    const Vec3 stretch(1.0, 1.5, 1.0);
    const fields::Polar norm = fields::polar(stretch * q, Vec3(0.0, 0.0, 1.0));
    return {unit_ * std::sqrt(2.0) * norm.length, std::sqrt(2.0) * stretch * norm.direction};
  }

  Vec3 center_;
  double unit_;     ///< [m] of one unit of the formula
  double inverse_;  ///< [1/m]
};

}  // namespace

FieldPtr heart(const Vec3& center, double width) {
  fields::checkPoint("heart", "center", center);
  fields::checkLength("heart", "width", width);
  return std::make_shared<Heart>(center, width);
}

}  // namespace palpate
