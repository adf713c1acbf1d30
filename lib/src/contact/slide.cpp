#include "palpate/contact/slide.h"

#include <algorithm>
#include <cmath>

namespace palpate {
namespace {

constexpr double kSmallestEigenvalue = 1e-3;
constexpr double kLargestTurn = 0.5;  // [rad]
constexpr int kPullBackSteps = 8;

/// sum of multiplier * side * Hessian / |gradient| over the walls.
Mat3 bending(std::span<const HeldWall> walls) noexcept {
  Mat3 sum(0.0);
  for (const HeldWall& wall : walls) {
    const double square = glm::dot(wall.jet.gradient, wall.jet.gradient);
    if (square > 0.0) sum += (wall.multiplier * wall.side / std::sqrt(square)) * wall.jet.hessian;
  }
  return sum;
}

/// Shortens the step so that no wall's normal turns by more than kLargestTurn over it.
Vec3 limited(const Vec3& step, std::span<const HeldWall> walls) noexcept {
  double share = 1.0;
  for (const HeldWall& wall : walls) {
    const Vec3 turn = wall.jet.hessian * step;
    const double most =
        kLargestTurn * kLargestTurn * glm::dot(wall.jet.gradient, wall.jet.gradient);
    const double square = glm::dot(turn, turn);
    if (square > most && most > 0.0) share = std::min(share, std::sqrt(most / square));
  }
  return share < 1.0 ? step * share : step;
}

double bounded(double eigenvalue) noexcept {
  return std::max(std::fabs(eigenvalue), kSmallestEigenvalue);
}

SlideStep onSurface(const Vec3& pull, const HeldWall& wall, const Mat3& bend) noexcept {
  // An orthonormal pair across the normal (T. Duff et al., "Building an Orthonormal Basis, Revisited", 2017).
  const Vec3 n = wall.normal;
  const double sign = std::copysign(1.0, n.z);
  const double share = -1.0 / (sign + n.z);
  const double mixed = n.x * n.y * share;
  const Vec3 t1(1.0 + sign * n.x * n.x * share, sign * mixed, -sign * n.x);
  const Vec3 t2(mixed, sign + n.y * n.y * share, -n.y);
  const Vec3 b1 = bend * t1;
  const double a = 1.0 - glm::dot(t1, b1);
  const double b = -glm::dot(t2, b1);
  const double c = 1.0 - glm::dot(t2, bend * t2);
  SlideStep out;
  // Far from the centres of curvature the matrix is safely positive: solve it as it is.
  const double det = a * c - b * b;
  const double trace = a + c;
  if (trace > 0.0 && det > kSmallestEigenvalue * (trace - kSmallestEigenvalue)) {
    const double p1 = glm::dot(t1, pull);
    const double p2 = glm::dot(t2, pull);
    out.step = t1 * ((c * p1 - b * p2) / det) + t2 * ((a * p2 - b * p1) / det);
    return out;
  }
  // Eigenvalues and vectors of [[a, b], [b, c]].
  const double mean = 0.5 * (a + c);
  const double half = 0.5 * (a - c);
  const double radius = std::hypot(half, b);
  const double high = mean + radius;
  const double low = mean - radius;
  Vec3 e_high = t1;
  Vec3 e_low = t2;
  if (radius > 1e-15 * (std::fabs(mean) + radius)) {
    const double angle = 0.5 * std::atan2(b, half);
    e_high = std::cos(angle) * t1 + std::sin(angle) * t2;
    e_low = -std::sin(angle) * t1 + std::cos(angle) * t2;
  }
  out.step = e_high * (glm::dot(e_high, pull) / bounded(high)) +
             e_low * (glm::dot(e_low, pull) / bounded(low));
  out.is_saddle = low < -1e-9;
  out.downhill = e_low;
  return out;
}

}  // namespace

Vec3 tangentialPart(const Vec3& v, std::span<const HeldWall> walls) noexcept {
  switch (walls.size()) {
    case 0:
      return v;
    case 1:
      return v - glm::dot(walls[0].normal, v) * walls[0].normal;
    case 2: {
      const Vec3 along = glm::cross(walls[0].normal, walls[1].normal);
      const double square = glm::dot(along, along);
      return square > 0.0 ? along * (glm::dot(along, v) / square) : Vec3(0.0);
    }
    default:
      return Vec3(0.0);
  }
}

bool mayBeSaddle(std::span<const HeldWall> walls) noexcept {
  if (walls.size() == 1) {
    const Mat3& h = walls[0].jet.hessian;
    const double square = glm::dot(h[0], h[0]) + glm::dot(h[1], h[1]) + glm::dot(h[2], h[2]);
    return walls[0].multiplier * walls[0].multiplier * square >=
           glm::dot(walls[0].jet.gradient, walls[0].jet.gradient);
  }
  double norm = 0.0;
  for (const HeldWall& wall : walls) {
    const Mat3& h = wall.jet.hessian;
    const double square = glm::dot(h[0], h[0]) + glm::dot(h[1], h[1]) + glm::dot(h[2], h[2]);
    norm += wall.multiplier * std::sqrt(square / glm::dot(wall.jet.gradient, wall.jet.gradient));
  }
  return norm >= 1.0;
}

namespace {

SlideStep unlimitedStep(const Vec3& pull, std::span<const HeldWall> walls) noexcept {
  SlideStep out;
  if (walls.empty() || walls.size() > 2) return out;
  const Mat3 bend = bending(walls);
  if (walls.size() == 1) {
    out = onSurface(pull, walls[0], bend);
  } else {
    const Vec3 along = unitOr(glm::cross(walls[0].normal, walls[1].normal), Vec3(0.0, 0.0, 0.0));
    const double eigenvalue = 1.0 - glm::dot(along, bend * along);
    out.step = pull / bounded(eigenvalue);
    out.is_saddle = eigenvalue < -1e-9;
    out.downhill = along;
  }
  return out;
}

}  // namespace

SlideStep slideStep(const Vec3& pull, std::span<const HeldWall> walls) noexcept {
  SlideStep out = unlimitedStep(pull, walls);
  out.step = limited(out.step, walls);
  return out;
}

Vec3 gradientByHand(const Vec3& gradient, std::span<const HeldWall> walls) noexcept {
  return unlimitedStep(tangentialPart(gradient, walls), walls).step;
}

namespace {

/// |S| / |gradient| that counts as on the wall: a field that rises slowly must be nearer to zero.
bool isOn(const HeldWall& wall, const FieldSample& s) noexcept {
  const double slack = wall.tolerance / wall.field->lipschitz();
  return s.value * s.value <= slack * slack * glm::dot(s.gradient, s.gradient);
}

bool pullBackOne(Vec3& x, const HeldWall& wall, bool& began_free) noexcept {
  for (int iteration = 0; iteration < kPullBackSteps; ++iteration) {
    const FieldSample s = wall.field->sample(x);
    if (!s.in_band) return false;
    if (iteration == 0) began_free = wall.side * s.value >= -wall.tolerance;
    if (isOn(wall, s)) return true;
    const double square = glm::dot(s.gradient, s.gradient);
    if (!(square > 0.0)) return false;
    x -= (s.value / square) * s.gradient;
    if (!isFinite(x)) return false;
  }
  return false;
}

}  // namespace

bool pullBack(Vec3& x, std::span<const HeldWall> walls, bool& began_free) noexcept {
  const std::size_t count = std::min<std::size_t>(walls.size(), 3);
  began_free = true;
  if (count == 1) return pullBackOne(x, walls[0], began_free);
  for (int iteration = 0; iteration < kPullBackSteps; ++iteration) {
    std::array<FieldSample, 3> s{};
    bool on_all = true;
    for (std::size_t i = 0; i < count; ++i) {
      s[i] = walls[i].field->sample(x);
      if (!s[i].in_band) return false;
      on_all = on_all && isOn(walls[i], s[i]);
      if (iteration == 0 && walls[i].side * s[i].value < -walls[i].tolerance) began_free = false;
    }
    if (on_all) return true;
    // Smallest correction that puts the linearised values to zero: x -= J^T (J J^T)^-1 s.
    Mat3 gram(1.0);
    Vec3 values(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      values[static_cast<int>(i)] = s[i].value;
      for (std::size_t j = 0; j < count; ++j) {
        gram[static_cast<int>(i)][static_cast<int>(j)] = glm::dot(s[i].gradient, s[j].gradient);
      }
    }
    if (!(std::fabs(glm::determinant(gram)) > 1e-30)) return false;
    const Vec3 solved = glm::inverse(gram) * values;
    for (std::size_t i = 0; i < count; ++i) x -= solved[static_cast<int>(i)] * s[i].gradient;
    if (!isFinite(x)) return false;
  }
  return false;
}

}  // namespace palpate
