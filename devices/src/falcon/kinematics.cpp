#include "falcon/kinematics.h"

#include <array>
#include <cmath>
#include <glm/matrix.hpp>
#include <numbers>

namespace palpate::devices::falcon {
namespace {

constexpr std::array<double, 3> kAzimuths = {90.0, -30.0, -150.0};  // [degrees]

struct Arm {
  double angle = 0.0;  ///< [rad]
  Vec3 slope{0.0};     ///< [rad/m] gradient of the angle, in the base's frame
};

std::optional<Arm> armAt(const Vec3& position, double azimuth, const Geometry& g) noexcept {
  const double cosine = std::cos(azimuth);
  const double sine = std::sin(azimuth);
  // In the leg's frame: u points away from the axis, v sideways, w up.
  const double u = cosine * position.x + sine * position.y - g.radius;
  const double v = -sine * position.x + cosine * position.y - g.shift;
  const double w = position.z;
  const double tilt_cosine = (v + g.sideways) / g.shin;
  if (!(std::abs(tilt_cosine) < 1.0)) return std::nullopt;
  const double tilt_sine = std::sqrt(1.0 - tilt_cosine * tilt_cosine);
  const double reach =
      g.hinge + g.shin * tilt_sine;  // reach of the lower leg in the plane of the thigh
  const double across = u + g.grip;
  const double square = w * w + across * across;
  const double knee =
      (square + g.thigh * g.thigh - reach * reach) / (2.0 * g.thigh * std::sqrt(square));
  if (!(std::abs(knee) < 1.0)) return std::nullopt;
  Arm out;
  out.angle = std::atan2(w, across) - std::acos(knee);
  const double shin_angle =
      std::atan2(w - g.thigh * std::sin(out.angle), across - g.thigh * std::cos(out.angle));
  const double bend = g.thigh * tilt_sine * std::sin(shin_angle - out.angle);
  if (bend == 0.0) return std::nullopt;
  // The component along the parallelogram: only motion along it turns the thigh.
  const double along_u = std::cos(shin_angle) * tilt_sine;
  const double along_w = std::sin(shin_angle) * tilt_sine;
  out.slope =
      Vec3(along_u * cosine - tilt_cosine * sine, along_u * sine + tilt_cosine * cosine, along_w) /
      bend;
  return out;
}

}  // namespace

std::optional<Arms> armsAt(const Vec3& position, const Geometry& geometry) noexcept {
  Arms out;
  for (int i = 0; i < 3; ++i) {
    const double degrees = kAzimuths[static_cast<std::size_t>(i)] + geometry.turn;
    const auto arm = armAt(position, degrees * std::numbers::pi / 180.0, geometry);
    if (!arm || !std::isfinite(arm->angle) || !isFinite(arm->slope)) return std::nullopt;
    out.angles[i] = arm->angle;
    for (int k = 0; k < 3; ++k) out.slope[k][i] = arm->slope[k];
  }
  return out;
}

namespace {

/// Newton's method; no value if it does not converge.
std::optional<Grip> newton(const Vec3& angles, const Vec3& near,
                           const Geometry& geometry) noexcept {
  // Newton's method converges quadratically: after a step this short the error is below 1e-12 m.
  constexpr double kShort = 1e-8;  // [m]
  constexpr double kLong = 0.02;   // [m] beyond this distance the arms are too nonlinear
  Grip out{near, 0};
  auto arms = armsAt(out.position, geometry);
  if (!arms) return std::nullopt;
  for (out.iterations = 1; out.iterations <= kMostIterations; ++out.iterations) {
    Vec3 step = glm::inverse(arms->slope) * (angles - arms->angles);
    const double length = glm::length(step);
    if (!std::isfinite(length)) return std::nullopt;
    if (length > kLong) step *= kLong / length;
    const Vec3 from = out.position;
    out.position = from + step;
    arms = armsAt(out.position, geometry);
    for (int half = 0; !arms && half < 8; ++half) {  // out of reach: halve the step
      step *= 0.5;
      out.position = from + step;
      arms = armsAt(out.position, geometry);
    }
    if (!arms) return std::nullopt;
    if (length < kShort) return out;
  }
  return std::nullopt;
}

}  // namespace

std::optional<Grip> gripAt(const Vec3& angles, const Vec3& near,
                           const Geometry& geometry) noexcept {
  if (const auto found = newton(angles, near, geometry)) return found;
  // The target is too far, or close to a stretched arm: go in small steps from the arms' pose at
  // `near`.
  constexpr int kSteps = 16;
  const auto begin = armsAt(near, geometry);
  if (!begin) return std::nullopt;
  Grip out{near, 0};
  for (int i = 1; i <= kSteps; ++i) {
    const double share = static_cast<double>(i) / kSteps;
    const Vec3 between = begin->angles + share * (angles - begin->angles);
    const auto next = newton(between, out.position, geometry);
    if (!next) return std::nullopt;
    out = {next->position, out.iterations + next->iterations};
  }
  return out;
}

std::optional<Vec3> torquesFor(const Vec3& force, const Arms& arms) noexcept {
  const Vec3 torques = glm::transpose(glm::inverse(arms.slope)) * force;
  if (!isFinite(torques)) return std::nullopt;
  return torques;
}

}  // namespace palpate::devices::falcon
