#include "palpate/contact/slide.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "contact/eigen2.h"
#include "palpate/contact/planes.h"

namespace palpate {
namespace {

constexpr double kSmallestEigenvalue = 1e-3;

/// The sum of multiplier * side * Hessian / |gradient| over the walls.
Mat3 bending(std::span<const HeldWall> walls) noexcept {
  Mat3 sum(0.0);
  for (const HeldWall& wall : walls) {
    const double square = glm::dot(wall.jet.gradient, wall.jet.gradient);
    if (square > 0.0) sum += (wall.multiplier * wall.side / std::sqrt(square)) * wall.jet.hessian;
  }
  return sum;
}

double bounded(double eigenvalue) noexcept {
  return std::max(std::fabs(eigenvalue), kSmallestEigenvalue);
}

Vec3 onSurface(const Vec3& pull, const Vec3& normal, const Mat3& bend) noexcept {
  Vec3 t1(0.0);
  Vec3 t2(0.0);
  tangentsOf(normal, t1, t2);
  const double a = 1.0 - glm::dot(t1, bend * t1);
  const double b = -glm::dot(t2, bend * t1);
  const double c = 1.0 - glm::dot(t2, bend * t2);
  // Far from the centers of curvature the matrix is safely positive: solve it directly.
  const double det = a * c - b * b;
  const double trace = a + c;
  if (trace > 0.0 && det > kSmallestEigenvalue * (trace - kSmallestEigenvalue)) {
    const double p1 = glm::dot(t1, pull);
    const double p2 = glm::dot(t2, pull);
    return t1 * ((c * p1 - b * p2) / det) + t2 * ((a * p2 - b * p1) / det);
  }
  const Eigen2 e = eigen(a, b, c, t1, t2);
  return e.e_high * (glm::dot(e.e_high, pull) / bounded(e.high)) +
         e.e_low * (glm::dot(e.e_low, pull) / bounded(e.low));
}

}  // namespace

Vec3 tangentialPart(const Vec3& v, std::span<const HeldWall> walls) noexcept {
  std::array<Vec3, 3> normals;
  const std::size_t count = std::min(walls.size(), normals.size());
  for (std::size_t i = 0; i < count; ++i) normals[i] = walls[i].normal;
  return partAcross(v, {normals.data(), count});
}

Vec3 partAcross(const Vec3& v, std::span<const Vec3> normals) noexcept {
  switch (normals.size()) {
    case 0:
      return v;
    case 1:
      return v - glm::dot(normals[0], v) * normals[0];
    case 2: {
      const Vec3 along = glm::cross(normals[0], normals[1]);
      const double square = glm::dot(along, along);
      return square > 0.0 ? along * (glm::dot(along, v) / square) : Vec3(0.0);
    }
    default:
      return Vec3(0.0);
  }
}

Vec3 gradientByHand(const Vec3& gradient, std::span<const HeldWall> walls) noexcept {
  const Vec3 pull = tangentialPart(gradient, walls);
  if (walls.empty() || walls.size() > 2) return Vec3(0.0);
  const Mat3 bend = bending(walls);
  if (walls.size() == 1) return onSurface(pull, walls[0].normal, bend);
  const Vec3 along = unitOr(glm::cross(walls[0].normal, walls[1].normal), Vec3(0.0));
  return pull / bounded(1.0 - glm::dot(along, bend * along));
}

}  // namespace palpate
