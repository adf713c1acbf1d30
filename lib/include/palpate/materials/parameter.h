#pragma once
/// A material's parameter: one number, or one that differs from place to place.

#include <memory>

#include "palpate/core/math.h"

namespace palpate {

/// A quantity of SI unit that depends on where one is: a grid of a file, an image behind a transfer
/// function, or a function of one's own. Immutable and shared; value() and sample() are real-time safe.
class MaterialMap {
 public:
  struct Sample {
    double value = 0.0;            ///< [SI unit of the parameter]
    Vec3 gradient{0.0, 0.0, 0.0};  ///< [the same per m]
  };
  struct Range {
    double least = 0.0;
    double most = 0.0;
  };

  virtual ~MaterialMap() = default;
  MaterialMap(const MaterialMap&) = delete;
  MaterialMap& operator=(const MaterialMap&) = delete;

  /// At `p` [m, world]: finite and within range() everywhere, also beyond what the map covers.
  [[nodiscard]] virtual Sample sample(const Vec3& p) const noexcept = 0;
  /// The same value, bit for bit, without the gradient.
  [[nodiscard]] virtual double value(const Vec3& p) const noexcept = 0;
  /// All values lie within; asked at set-up, to check what a parameter may be.
  [[nodiscard]] virtual Range range() const noexcept = 0;

 protected:
  MaterialMap() = default;
};
using MaterialMapPtr = std::shared_ptr<const MaterialMap>;

/// A constant, or a map. Cheap to ask where it is constant.
class Parameter {
 public:
  Parameter() = default;
  Parameter(double constant) : constant_(constant) {}  // NOLINT(google-explicit-constructor)
  Parameter(MaterialMapPtr map)                        // NOLINT(google-explicit-constructor)
      : constant_(map ? map->value(Vec3(0.0)) : 0.0), map_(std::move(map)) {}

  [[nodiscard]] bool isConstant() const noexcept { return map_ == nullptr; }
  /// The same everywhere: an equal constant, or the very same map.
  friend bool operator==(const Parameter& a, const Parameter& b) noexcept {
    return a.map_ == b.map_ && (a.map_ != nullptr || a.constant_ == b.constant_);
  }
  [[nodiscard]] double at(const Vec3& p) const noexcept {
    return map_ ? map_->value(p) : constant_;
  }
  [[nodiscard]] MaterialMap::Sample sample(const Vec3& p) const noexcept {
    return map_ ? map_->sample(p) : MaterialMap::Sample{constant_, Vec3(0.0)};
  }
  [[nodiscard]] MaterialMap::Range range() const noexcept {
    return map_ ? map_->range() : MaterialMap::Range{constant_, constant_};
  }
  /// Null where the parameter is constant.
  [[nodiscard]] const MaterialMapPtr& map() const noexcept { return map_; }

 private:
  double constant_ = 0.0;
  MaterialMapPtr map_;
};

}  // namespace palpate
