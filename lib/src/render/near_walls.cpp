#include "near_walls.h"

#include <algorithm>
#include <cmath>

#include "palpate/contact/planes.h"
#include "solver_limits.h"

namespace palpate {

void unfoldBend(const Leaf& leaf, double side, const Vec3& p, const Vec3& normal,
                Mat3& bend) noexcept {
  const double size = sizeOf(bend);
  if (size * leaf.feature <= limits::kFolds) return;
  const FieldJet beyond = leaf.field->jet(p - side * limits::kBeyondFold * leaf.feature * normal);
  const double slope = glm::length(beyond.gradient);
  if (!beyond.in_band || !(slope > 0.0)) return;
  const Mat3 other = beyond.hessian / slope;
  if (sizeOf(other) < limits::kFoldsLess * size) bend = other;
}

bool NearWalls::isSliver(const NearCell& cell) const noexcept {
  const std::uint32_t both = cell.inside | cell.outside;
  if ((both & (both - 1)) == 0) return false;
  std::array<Vec3, kMax> normals;
  std::size_t count = 0;
  for (std::size_t i = 0; i < count_; ++i) {
    if (((both >> i) & 1U) == 0) continue;
    const bool inside = ((cell.inside >> i) & 1U) != 0;
    const NearWall& wall = wall_[i];
    if (wall.slope > 0.0 && wall.gap(inside) <= limits::kRoom * wall.tolerance) {
      normals[count++] = inside ? -wall.normal : wall.normal;
    }
  }
  if (count < 2) return false;
  // Two walls leave room unless they face each other.
  if (count == 2 && glm::dot(normals[0], normals[1]) > -0.9) return false;
  std::array<Plane, kMax> planes{};
  for (std::size_t i = 0; i < count; ++i) planes[i] = {normals[i], -1.0};
  // A direction that leads away from all of these walls at once; it is zero where they leave no
  // room.
  const Vec3 away = closestStep(Vec3(0.0), {planes.data(), count}).step;
  return std::any_of(planes.begin(), planes.begin() + static_cast<std::ptrdiff_t>(count),
                     [&](const Plane& plane) { return glm::dot(plane.normal, away) < 0.5; });
}

bool NearWalls::look(double radius, bool trust_sides) noexcept {
  count_ = 0;
  cell_count_ = 0;
  std::array<NearSide, kMax> near{};
  bool fits = true;
  walker_.forWithin(radius, [&](LeafId id) {
    if (count_ == kMax) {
      fits = false;
      return;
    }
    const FieldJet& jet = walker_.jetHere(id);
    NearWall wall{wallOf(id, walker_.leaf(id), {jet.value, jet.gradient, jet.in_band})};
    if (wall.slope > 0.0) {
      wall.bend = jet.hessian / wall.slope;
      unfoldBend(walker_.leaf(id), walker_.side(id), walker_.position(), wall.normal, wall.bend);
      wall.bend_size = sizeOf(wall.bend);
    }
    const bool is_inside = walker_.side(id) < 0.0;
    near[count_] = {id, trust_sides ? is_inside : wall.distance <= wall.tolerance,
                    trust_sides ? !is_inside : wall.distance >= -wall.tolerance};
    wall_[count_++] = wall;
  });
  if (!fits) return false;
  cell_count_ = 0;
  for (const NearCell& cell :
       cells_.find(walker_.region(), walker_.signs(), {near.data(), count_})) {
    if (!isSliver(cell)) cell_[cell_count_++] = cell;
  }
  return true;
}

}  // namespace palpate
