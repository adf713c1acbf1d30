#include <algorithm>
#include <array>
#include <cmath>

#include "palpate/contact/local_projection.h"
#include "palpate/contact/planes.h"

namespace palpate {
namespace {

constexpr int kMostCuts = 64;
/// Relative to the way to the target and to the coordinates: within this distance a point is on a
/// wall.
constexpr double kSettled = 1e-13;
constexpr double kRounding = 1e-15;
/// Relative to the way to the target: a tangent plane that cuts off the start by more than this
/// belongs to a wall that bulges.
constexpr double kBulges = 1e-9;

struct Cuts {
  std::array<Plane, kMaxPlanes> plane{};       ///< as constraints on steps from the target
  std::array<std::size_t, kMaxPlanes> wall{};  ///< by plane: the wall that it belongs to
  std::array<FieldJet, kMaxPlanes> jet{};      ///< by plane: of its wall, at the place of the cut
  std::size_t count = 0;

  void keepOnly(const PlaneSolution& solution) noexcept {
    Cuts kept;
    for (int k = 0; k < solution.count; ++k) {
      const auto i = static_cast<std::size_t>(solution.plane[static_cast<std::size_t>(k)]);
      kept.add(plane[i], wall[i], jet[i]);
    }
    *this = kept;
  }
  void add(const Plane& cut, std::size_t of, const FieldJet& there) noexcept {
    plane[count] = cut;
    wall[count] = of;
    jet[count++] = there;
  }
};

}  // namespace

LocalProjection projectByCuts(const Vec3& from, const Vec3& target,
                              std::span<const HeldWall> walls) noexcept {
  LocalProjection out;
  const std::size_t count = std::min(walls.size(), kMaxProjectionWalls);
  const double way = glm::length(target - from);
  const double size = std::max({std::fabs(target.x), std::fabs(target.y), std::fabs(target.z)});
  const double tolerance = kSettled * way + kRounding * size;
  Cuts cuts;
  PlaneSolution solution;
  out.at = target;
  for (int look = 0; look < kMostCuts; ++look) {
    bool is_allowed = true;
    if (cuts.count + count > kMaxPlanes) cuts.keepOnly(solution);
    for (std::size_t i = 0; i < count; ++i) {
      const FieldJet jet = walls[i].field->jet(out.at);
      const double slope = glm::length(jet.gradient);
      if (!jet.in_band || !(slope > 0.0)) return out;
      const double side = walls[i].side / slope;
      const double gap = side * jet.value;
      if (gap >= -tolerance) continue;
      const Vec3 normal = side * jet.gradient;
      if (gap + glm::dot(normal, from - out.at) < -kBulges * way) return out;
      cuts.add({normal, gap + glm::dot(normal, target - out.at)}, i, jet);
      is_allowed = false;
    }
    if (is_allowed) {
      out.settled = true;
      break;
    }
    solution = closestStep(Vec3(0.0), {cuts.plane.data(), cuts.count});
    out.at = target + solution.step;
  }
  for (int k = 0; k < solution.count; ++k) {
    const auto i = static_cast<std::size_t>(solution.plane[static_cast<std::size_t>(k)]);
    HeldWall& held = out.held[out.count++];
    held = walls[cuts.wall[i]];
    held.jet = cuts.jet[i];
    held.jet.hessian = Mat3(0.0);
    held.normal = cuts.plane[i].normal;
    held.multiplier = solution.multiplier[static_cast<std::size_t>(k)];
  }
  return out;
}

}  // namespace palpate
