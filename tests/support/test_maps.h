#pragma once
// Material maps of closed form.

#include <algorithm>
#include <functional>
#include <memory>
#include <utility>

#include "palpate/materials/material.h"

namespace palpate::testing {

/// value + gradient . p, held within a range: the gradient vanishes where the range ends it.
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

/// Any function with its gradient, and the range that the test vouches for.
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
/// The same everywhere, though nothing but its values says so.
[[nodiscard]] inline MaterialMapPtr flatMap(double value) {
  return linearMap(value, Vec3(0.0), {value, value});
}

}  // namespace palpate::testing
