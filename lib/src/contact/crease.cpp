#include "palpate/contact/crease.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate {
namespace {

/// Normals that differ by less than this [rad] belong to one wall.
constexpr double kSameWall = 1e-3;
/// The Hessian is taken this many times as far away as value and gradient.
constexpr double kHessianReach = 100.0;
/// ... and holds for the near point if the normal turns by less than this [rad] on the way.
constexpr double kHessianHolds = 0.1;
/// After a move along a crease its walls are asked for this share of the way beside it, at first.
constexpr double kLook = 0.1;
constexpr int kMaxHalvings = 40;

double angle(const Vec3& a, const Vec3& b) noexcept { return glm::length(a - b); }

double norm(const Mat3& h) noexcept {
  return std::sqrt(glm::dot(h[0], h[0]) + glm::dot(h[1], h[1]) + glm::dot(h[2], h[2]));
}

bool normalAt(const Field& field, double side, const Vec3& p, Vec3& out) noexcept {
  const FieldSample s = field.sample(p);
  const double slope = glm::length(s.gradient);
  if (!s.in_band || !(slope > 0.0)) return false;
  out = (side / slope) * s.gradient;
  return true;
}

/// Angle to the nearest of `known`.
double newness(std::span<const Vec3> known, const Vec3& normal) noexcept {
  double least = kInfinity;
  for (const Vec3& each : known) least = std::min(least, angle(each, normal));
  return least;
}

}  // namespace

bool isHollow(const Vec3& from, const Vec3& normal, const Vec3& way) noexcept {
  // A min of two fields is the one that falls faster that way.
  return glm::dot(normal - from, way) < 0.0;
}

bool findFold(const Field& field, double side, std::span<const Vec3> known, const Vec3& a,
              const Vec3& b, double width, Fold& out) noexcept {
  Vec3 normal(0.0);
  if (!normalAt(field, side, b, normal) || newness(known, normal) < kSameWall) return false;
  const Vec3 way = b - a;
  const double length = glm::length(way);
  double near = 0.0;
  double far = 1.0;
  Vec3 nearest = known.front();
  for (int i = 0; i < kMaxHalvings && (far - near) * length > width; ++i) {
    const double middle = 0.5 * (near + far);
    Vec3 here(0.0);
    if (!normalAt(field, side, a + middle * way, here)) return false;
    if (angle(here, normal) < newness(known, here)) {
      far = middle;
      normal = here;
    } else {
      near = middle;
      nearest = here;
    }
  }
  // What is left of the turn is the jump.
  if (angle(nearest, normal) < kSameWall || newness(known, normal) < kSameWall) return false;
  if (!isHollow(nearest, normal, way)) return false;
  out.at = a + 0.5 * (near + far) * way;
  out.normal = normal;
  return true;
}

Vec3 probeDirection(std::span<const Vec3> normals, std::size_t own) noexcept {
  Vec3 others(0.0);
  for (std::size_t i = 0; i < normals.size(); ++i) {
    if (i != own) others += normals[i];
  }
  if (normals.size() == 3) {
    // Along the own wall, and up from the two others alike.
    const Vec3& u = normals[(own + 1) % 3];
    const Vec3& v = normals[(own + 2) % 3];
    const Vec3 direction = glm::cross(normals[own], u - v);
    const double up = glm::dot(direction, u);
    if (std::fabs(up) > 1e-6) return unitOr(up > 0.0 ? direction : -direction, Vec3(0.0));
  }
  return unitOr(others - glm::dot(others, normals[own]) * normals[own], Vec3(0.0));
}

bool wallBeside(const Field& field, double side, const Vec3& x, const Vec3& probe, double reach,
                HeldWall& out) noexcept {
  const Vec3 off = reach * probe;
  const FieldSample s = field.sample(x + off);
  const double slope = glm::length(s.gradient);
  if (!s.in_band || !(slope > 0.0)) return false;
  out.field = &field;
  out.side = side;
  out.probe = probe;
  out.reach = reach;
  out.jet.in_band = true;
  out.jet.hessian = Mat3(0.0);
  out.normal = (side / slope) * s.gradient;
  const FieldJet far = field.jet(x + kHessianReach * off);
  const double far_slope = glm::length(far.gradient);
  // A difference that straddles another fold is enormous.
  if (far.in_band && far_slope > 0.0 &&
      angle((side / far_slope) * far.gradient, out.normal) < kHessianHolds &&
      norm(far.hessian) * kHessianReach * reach < kHessianHolds * far_slope) {
    out.jet.hessian = far.hessian;
  }
  const Vec3 bend = out.jet.hessian * off;
  out.jet.gradient = s.gradient - bend;
  out.jet.value = s.value - glm::dot(s.gradient, off) + 0.5 * glm::dot(bend, off);
  out.normal = side * unitOr(out.jet.gradient, s.gradient / slope);
  return true;
}

double misfit(const Field& field, double side, const Vec3& x, double lowest) noexcept {
  return std::min(0.0, side * field.value(x) - lowest);
}

namespace {

/// Lowers the values of walls that were asked for beside `x` to what their field says at `x` itself.
void lowerToField(const Vec3& x, std::span<const HeldWall> walls,
                  std::span<double> value) noexcept {
  for (std::size_t i = 0; i < walls.size(); ++i) {
    if (walls[i].probe == Vec3(0.0)) continue;
    double lowest = kInfinity;
    bool is_first = true;
    for (std::size_t j = 0; j < walls.size(); ++j) {
      if (walls[j].field != walls[i].field) continue;
      is_first = is_first && j >= i;
      lowest = std::min(lowest, walls[j].side * value[j]);
    }
    if (!is_first) continue;  // its crease is done
    const double by = misfit(*walls[i].field, walls[i].side, x, lowest);
    for (std::size_t j = i; j < walls.size(); ++j) {
      if (walls[j].field == walls[i].field) value[j] += walls[j].side * by;
    }
  }
}

}  // namespace

bool pullBackToCrease(Vec3& x, std::span<const HeldWall> walls, double length,
                      bool& began_free) noexcept {
  const std::size_t count = std::min<std::size_t>(walls.size(), 3);
  began_free = true;
  for (std::size_t i = 0; i < count; ++i) {
    if (walls[i].side * walls[i].field->value(x) < -walls[i].tolerance) began_free = false;
  }
  double bend = 0.0;  // [1/m] largest curvature
  for (std::size_t i = 0; i < count; ++i) {
    bend = std::max(bend, norm(walls[i].jet.hessian) / glm::length(walls[i].jet.gradient));
  }
  // Far enough to be past where the other walls have bent to.
  double reach = std::max(kLook * length, bend * length * length);
  for (int iteration = 0; iteration < 16; ++iteration) {
    std::array<Vec3, 3> normal{};
    std::array<double, 3> slopes{};
    std::array<double, 3> value{};
    bool is_near = true;
    for (std::size_t i = 0; i < count; ++i) {
      const bool is_beside = walls[i].probe != Vec3(0.0);
      const double away = is_beside ? std::max(reach, walls[i].reach) : 0.0;
      const Vec3 off = away * walls[i].probe;
      const FieldSample s = walls[i].field->sample(x + off);
      const double slope = glm::length(s.gradient);
      if (!s.in_band || !(slope > 0.0)) return false;
      const double curved = 0.5 * glm::dot(off, walls[i].jet.hessian * off);
      value[i] = s.value - glm::dot(s.gradient, off) + curved;
      slopes[i] = slope;
      normal[i] = s.gradient / slope;
      // Another wall than the one that was meant.
      if (glm::dot(normal[i], walls[i].side * walls[i].normal) < 0.5) return false;
      is_near = is_near && (!is_beside || away <= walls[i].reach);
    }
    if (is_near) lowerToField(x, walls.first(count), std::span(value.data(), count));
    bool on_all = is_near;
    for (std::size_t i = 0; i < count; ++i) {
      on_all = on_all && std::fabs(value[i]) <= walls[i].tolerance;
    }
    if (on_all) return true;
    Mat3 gram(1.0);
    Vec3 gaps(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      gaps[static_cast<int>(i)] = value[i] / slopes[i];
      for (std::size_t j = 0; j < count; ++j) {
        gram[static_cast<int>(i)][static_cast<int>(j)] = glm::dot(normal[i], normal[j]);
      }
    }
    if (!(std::fabs(glm::determinant(gram)) > 1e-8)) return false;
    const Vec3 solved = glm::inverse(gram) * gaps;
    Vec3 correction(0.0);
    for (std::size_t i = 0; i < count; ++i) correction += solved[static_cast<int>(i)] * normal[i];
    x -= correction;
    if (!isFinite(x)) return false;
    // The point is now off the crease by the second order of how far it was and of how far was asked.
    const double moved = glm::length(correction);
    reach = std::max(kLook * moved, bend * (moved * moved + reach * reach));
  }
  return false;
}

}  // namespace palpate
