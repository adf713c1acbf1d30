#pragma once
// Material maps given by formulas.

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "palpate/materials/material.h"

namespace palpate::testing {

/// value + gradient . p, clamped to a range: the gradient is zero where it is clamped.
class LinearMap final : public MaterialMap {
 public:
  LinearMap(double value, const Vec3& gradient, Range range)
      : value_(value), gradient_(gradient), range_(range) {}

  [[nodiscard]] Sample sample(const Vec3& p) const noexcept override {
    const double raw = value_ + glm::dot(gradient_, p);
    const double held = std::clamp(raw, range_.least, range_.most);
    return {held, raw == held ? gradient_ : Vec3(0.0)};
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return sample(p).value; }
  [[nodiscard]] Range range() const noexcept override { return range_; }

 private:
  double value_;
  Vec3 gradient_;
  Range range_;
};

/// Any function with its gradient, and with a range that the test guarantees.
class FunctionMap final : public MaterialMap {
 public:
  using Function = std::function<Sample(const Vec3&)>;

  FunctionMap(Function function, Range range) : function_(std::move(function)), range_(range) {}

  [[nodiscard]] Sample sample(const Vec3& p) const noexcept override { return function_(p); }
  [[nodiscard]] double value(const Vec3& p) const noexcept override { return sample(p).value; }
  [[nodiscard]] Range range() const noexcept override { return range_; }

 private:
  Function function_;
  Range range_;
};

[[nodiscard]] inline MaterialMapPtr linearMap(double value, const Vec3& gradient,
                                              MaterialMap::Range range) {
  return std::make_shared<LinearMap>(value, gradient, range);
}
/// A map with the same value everywhere; a Parameter that has it still counts as a map.
[[nodiscard]] inline MaterialMapPtr flatMap(double value) {
  return linearMap(value, Vec3(0.0), {value, value});
}

}  // namespace palpate::testing
