#pragma once
// A field made from a value function alone.

#include <functional>
#include <memory>
#include <utility>

#include "palpate/fields/field.h"

namespace palpate::testing {

/// For tests that must not depend on lib's own shapes. Its gradient is zero, which is wrong; use it
/// only for code that claims to need nothing but values.
class FunctionField final : public Field {
 public:
  using Function = std::function<double(const Vec3&)>;

  FunctionField(Function function, double feature)
      : function_(std::move(function)), feature_(feature) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return {function_(p), Vec3(0.0), true};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return function_(p); }
  [[nodiscard]] Box3 bounds() const noexcept override { return Box3::everything(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return feature_; }

 private:
  Function function_;
  double feature_;
};

[[nodiscard]] inline FieldPtr functionField(FunctionField::Function function, double feature) {
  return std::make_shared<FunctionField>(std::move(function), feature);
}

}  // namespace palpate::testing
