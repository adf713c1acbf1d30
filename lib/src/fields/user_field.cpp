#include <algorithm>
#include <utility>

#include "fields/checks.h"
#include "palpate/core/error.h"
#include "palpate/fields/implicit.h"

namespace palpate {
namespace {

class UserField final : public Field {
 public:
  explicit UserField(UserFunction function) : function_(std::move(function)) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return {value(p), gradientAt(p)};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return function_.value(p); }
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    // Second differences of the value: differences of numerical gradients would lose half the
    // digits.
    FieldJet out{value(p), gradientAt(p), Mat3(0.0)};
    const double h = stepAt(p, 3e-4, 1e-6);
    const auto at = [&](int i, double a, int j, double b) {
      Vec3 q = p;
      q[i] += a;
      q[j] += b;
      return value(q);
    };
    for (int i = 0; i < 3; ++i) {
      out.hessian[i][i] = (at(i, h, i, 0.0) - 2.0 * out.value + at(i, -h, i, 0.0)) / (h * h);
      const int j = (i + 1) % 3;
      out.hessian[i][j] = out.hessian[j][i] =
          (at(i, h, j, h) - at(i, h, j, -h) - at(i, -h, j, h) + at(i, -h, j, -h)) / (4.0 * h * h);
    }
    return out;
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return function_.bounds; }
  [[nodiscard]] Metric metric() const noexcept override { return function_.metric; }
  [[nodiscard]] double lipschitz() const noexcept override { return function_.lipschitz; }
  [[nodiscard]] Box3 lipschitzDomain() const noexcept override {
    return function_.lipschitz_domain;
  }
  [[nodiscard]] double featureSize() const noexcept override { return function_.feature_size; }

 private:
  /// A share of the feature size, but many units in the last place of `p`.
  [[nodiscard]] double stepAt(const Vec3& p, double share, double share_of_p) const noexcept {
    const double reach = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
    return std::max(share * function_.feature_size, share_of_p * reach);
  }
  [[nodiscard]] Vec3 gradientAt(const Vec3& p) const noexcept {
    const double h = stepAt(p, 1e-5, 1e-8);
    Vec3 gradient(0.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 ahead = p;
      Vec3 behind = p;
      ahead[i] += h;
      behind[i] -= h;
      gradient[i] = (value(ahead) - value(behind)) / (ahead[i] - behind[i]);
    }
    return gradient;
  }

  UserFunction function_;
};

}  // namespace

FieldPtr userField(UserFunction function) {
  if (!function.value) {
    throw inputError("field.no_function", "user field: `value` is empty; it must be a function");
  }
  fields::checkLength("user field", "feature_size", function.feature_size);
  fields::checkRange("user field", "lipschitz", function.lipschitz, 1e-12, 1e12);
  return std::make_shared<UserField>(std::move(function));
}

}  // namespace palpate
