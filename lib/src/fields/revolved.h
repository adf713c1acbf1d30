#pragma once
/// Solids of revolution from a profile in the half-plane (rho, h): rho >= 0 is the distance from
/// the axis, h the height along it. Private to fields.

#include <algorithm>
#include <concepts>

#include "fields/batch.h"
#include "fields/vector.h"
#include "palpate/fields/field.h"

namespace palpate::fields {

struct ProfileSample {
  double value = 0.0;  ///< [m]
  double by_rho = 0.0;
  double by_height = 0.0;
};

struct ProfileJet {
  ProfileSample at;
  double rho_rho = 0.0;  ///< [1/m] second derivatives, like the two below
  double rho_height = 0.0;
  double height_height = 0.0;
};

/// The value of a profile, computed from the square root of `square`; valid if
/// isPlainSquare(square).
struct ProfileValue {
  double value = 0.0;  ///< [m]
  double square = 1.0;
};

/// Length of (a, b), safe like polar(); `direction` is (1, 0) for the zero vector.
struct Polar2 {
  double length = 0.0;
  double a = 1.0;
  double b = 0.0;
};
[[nodiscard]] inline Polar2 polar2(double a, double b) noexcept {
  const Polar p = polar(Vec3(a, b, 0.0), Vec3(1.0, 0.0, 0.0));
  return {p.length, p.direction.x, p.direction.y};
}

/// The jet of a profile whose value is a constant less than `q.length`, the distance from a point
/// of the half-plane.
[[nodiscard]] inline ProfileJet profileAround(const ProfileSample& at, const Polar2& q) noexcept {
  ProfileJet jet{at};
  if (!(q.length > 1e-100)) return jet;
  const double curvature = 1.0 / q.length;
  jet.rho_rho = q.b * q.b * curvature;
  jet.rho_height = -q.a * q.b * curvature;
  jet.height_height = q.a * q.a * curvature;
  return jet;
}

/// Requirement on a profile: it gives the signed distance (or another field) in its half-plane.
template <typename T>
concept Profile = requires(const T profile, double rho, double height) {
  { profile.sample(rho, height) }
  noexcept->std::same_as<ProfileSample>;
  { profile.jet(rho, height) }
  noexcept->std::same_as<ProfileJet>;
  // The same value as sample(), for use in a loop over many points.
  { profile.plain(rho, height) }
  noexcept->std::same_as<ProfileValue>;
  {
    profile.bounds(Vec3(), Vec3())
    } -> std::same_as<Box3>;  // bounds of the solid, for center and axis
  { profile.featureSize() } -> std::same_as<double>;
};

/// True if a difference from the center, of the length `size` across the axis and `height` along
/// it, is far enough from the axis that its part across can be computed by subtraction. Otherwise
/// the result would be mostly rounding.
[[nodiscard]] inline bool isClearOfAxis(double size, double height) noexcept {
  return size > 1e-3 * std::fabs(height);
}

/// The solid that a profile sweeps when it turns about the line through `center` along the unit
/// vector `axis`.
template <Profile P>
class Revolved final : public Field {
 public:
  Revolved(const Vec3& center, const Vec3& axis, const P& profile)
      : center_(center), axis_(axis), across_(perpendicularTo(axis)), profile_(profile) {}

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    const Vec3 d = p - center_;
    const double height = glm::dot(d, axis_);
    const Polar radial = polar(acrossAxis(d, height), across_);
    const ProfileSample s = profile_.sample(radial.length, height);
    return {s.value, radial.direction * s.by_rho + axis_ * s.by_height};
  }

  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    const Vec3 d = p - center_;
    const double height = glm::dot(d, axis_);
    return profile_.sample(length(acrossAxis(d, height)), height).value;
  }

  void values(const PointBatch& points, ValueBatch& out) const noexcept override {
    const Vec3 center = center_;  // copies: the stores below cannot change them
    const Vec3 axis = axis_;
    const P profile = profile_;
    const auto larger = [](double a, double b) { return a < b ? b : a; };
    Squares squares, of_profile, distances;
    for (std::size_t n = 0; n < PointBatch::kCount; ++n) {
      const double dx = points.x[n] - center.x;
      const double dy = points.y[n] - center.y;
      const double dz = points.z[n] - center.z;
      const double height = dx * axis.x + dy * axis.y + dz * axis.z;
      const double x = dx - axis.x * height;
      const double y = dy - axis.y * height;
      const double z = dz - axis.z * height;
      const double size = larger(larger(std::fabs(x), std::fabs(y)), std::fabs(z));
      const double square = x * x + y * y + z * z;
      const ProfileValue at = profile.plain(std::sqrt(square), height);
      squares[n] = isClearOfAxis(size, height) ? square : 0.0;
      of_profile[n] = at.square;
      distances[n] = at.value;
    }
    out = distances;
    valuesOfLeftovers(*this, points, squares, out);
    valuesOfLeftovers(*this, points, of_profile, out);
  }

  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    const Vec3 d = p - center_;
    const double height = glm::dot(d, axis_);
    const Polar radial = polar(acrossAxis(d, height), across_);
    const ProfileJet s = profile_.jet(radial.length, height);
    const Vec3& u = radial.direction;
    const Vec3 around = glm::cross(axis_, u);
    // Revolution adds the curvature (df/drho) / rho, which tends to d2f/drho2 on the axis of a
    // smooth field and has no limit on the axis of a pointed one.
    double turning = 0.0;
    if (radial.length > 1e-100) {
      turning = s.at.by_rho / radial.length;
    } else if (s.at.by_rho == 0.0) {
      turning = s.rho_rho;
    }
    Mat3 hessian = outer(u, u) * s.rho_rho + outer(axis_, axis_) * s.height_height +
                   outer(around, around) * turning;
    hessian += (outer(u, axis_) + outer(axis_, u)) * s.rho_height;
    return {s.at.value, u * s.at.by_rho + axis_ * s.at.by_height, hessian};
  }

  [[nodiscard]] Box3 bounds() const noexcept override { return profile_.bounds(center_, axis_); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kExact; }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return profile_.featureSize(); }

 private:
  /// The part of `d` across the axis. Close to the axis the first difference is partly rounding and
  /// not perpendicular to the axis: subtract the remaining axial part once more. Still closer it is
  /// nothing but rounding.
  [[nodiscard]] Vec3 acrossAxis(const Vec3& d, double height) const noexcept {
    const Vec3 radial = d - axis_ * height;
    const double size = std::max({std::fabs(radial.x), std::fabs(radial.y), std::fabs(radial.z)});
    if (isClearOfAxis(size, height)) [[likely]]
      return radial;
    if (size <= 1e-15 * std::fabs(height)) return Vec3(0.0);
    return radial - axis_ * glm::dot(radial, axis_);
  }

  Vec3 center_;
  Vec3 axis_;
  Vec3 across_;  ///< radial direction used for points on the axis
  P profile_;
};

/// Half extent, along each coordinate axis, of a disc of `radius` perpendicular to `axis`.
[[nodiscard]] inline Vec3 discExtent(const Vec3& axis, double radius) noexcept {
  const Vec3 squares = glm::max(Vec3(1.0) - axis * axis, Vec3(0.0));
  return radius * glm::sqrt(squares);
}

}  // namespace palpate::fields
