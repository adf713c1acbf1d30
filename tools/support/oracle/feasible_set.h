#pragma once
// The set where a proxy may be, in a test's own terms: sides of fields, combined by AND and OR.

#include <vector>

#include "palpate/fields/field.h"

namespace palpate::oracle {

/// One side of one smooth field: the points with sign * S >= 0. Only values are asked of the field;
/// derivatives are finite differences of order 4 computed here, so that a wrong gradient cannot
/// confirm itself.
struct FieldSide {
  FieldPtr field;
  double sign = 1.0;  ///< +1: outside is allowed, -1: inside is
  Pose pose = {};     ///< field's frame -> world

  [[nodiscard]] double value(const Vec3& p) const noexcept {
    return sign * field->value(pose.applyInverse(p));
  }
  /// `scale`: factor on the spacing of the differences.
  [[nodiscard]] Vec3 gradient(const Vec3& p, double scale = 1.0) const noexcept;
  [[nodiscard]] Mat3 hessian(const Vec3& p) const noexcept;

 private:
  [[nodiscard]] double spacing() const noexcept;
};

/// A union of intersections of sides. Any tree of AND and OR can be written this way.
class FeasibleSet {
 public:
  /// One conjunction: indices into sides(), all of which must hold.
  using Branch = std::vector<std::size_t>;

  [[nodiscard]] static FeasibleSet outside(FieldPtr field) { return of(std::move(field), 1.0, {}); }
  [[nodiscard]] static FeasibleSet inside(FieldPtr field) { return of(std::move(field), -1.0, {}); }
  [[nodiscard]] static FeasibleSet allOf(const std::vector<FeasibleSet>& sets);
  [[nodiscard]] static FeasibleSet anyOf(const std::vector<FeasibleSet>& sets);

  [[nodiscard]] const std::vector<FieldSide>& sides() const noexcept { return sides_; }
  [[nodiscard]] const std::vector<Branch>& branches() const noexcept { return branches_; }

  /// Not negative where the proxy is allowed.
  [[nodiscard]] double value(const Vec3& p) const noexcept;
  /// Smallest featureSize() of the fields [m].
  [[nodiscard]] double feature() const noexcept { return feature_; }

 private:
  /// Takes CSG apart along Field::structure().
  static FeasibleSet of(FieldPtr field, double sign, const Pose& pose);
  std::size_t append(const FeasibleSet& other);

  std::vector<FieldSide> sides_;
  std::vector<Branch> branches_;
  double feature_ = kInfinity;
};

}  // namespace palpate::oracle
