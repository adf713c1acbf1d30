#include "support/oracle/closed_forms.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace palpate::oracle {
namespace {

Vec3 onSphere(const Vec3& p, const Ball& ball) {
  return ball.center + ball.radius * glm::normalize(p - ball.center);
}

bool isInside(const Vec3& p, const Ball& ball) {
  return glm::length(p - ball.center) < ball.radius;
}

/// Nearest point to `p` on the circle in which two spheres meet.
Vec3 onCrease(const Vec3& p, const Ball& a, const Ball& b) {
  const double apart = glm::length(b.center - a.center);
  const Vec3 axis = (b.center - a.center) / apart;
  const double along = (apart * apart + a.radius * a.radius - b.radius * b.radius) / (2.0 * apart);
  const double radius = std::sqrt(a.radius * a.radius - along * along);
  const Vec3 middle = a.center + along * axis;
  const Vec3 flat = (p - middle) - glm::dot(p - middle, axis) * axis;
  return middle + radius * glm::normalize(flat);
}

}  // namespace

Vec3 nearestTo(const Minima& minima, const Vec3& previous) {
  return *std::min_element(minima.begin(), minima.end(), [&](const Vec3& a, const Vec3& b) {
    return glm::length(a - previous) < glm::length(b - previous);
  });
}

Minima sphereMinima(const Vec3& p, const Vec3& center, double radius, Held held) {
  const double distance = glm::length(p - center);
  if (held == Held::kOutside ? distance >= radius : distance <= radius) return {p};
  if (distance == 0.0) return {};
  return {center + (radius / distance) * (p - center)};
}

Minima planeMinima(const Vec3& p, const Vec3& point, const Vec3& normal) {
  const double height = glm::dot(p - point, normal);
  return {height >= 0.0 ? p : p - height * normal};
}

Minima cylinderMinima(const Vec3& p, const Vec3& center, const Vec3& axis, double radius,
                      Held held) {
  const Vec3 foot = center + glm::dot(p - center, axis) * axis;
  return sphereMinima(p, foot, radius, held);
}

Minima torusMinima(const Vec3& p, const Vec3& center, const Vec3& axis, double major, double minor,
                   Held held) {
  const Vec3 flat = (p - center) - glm::dot(p - center, axis) * axis;
  if (flat == Vec3(0.0)) return held == Held::kOutside && major > minor ? Minima{p} : Minima{};
  return sphereMinima(p, center + major * glm::normalize(flat), minor, held);
}

Minima boxMinima(const Vec3& p, const Vec3& lo, const Vec3& hi, Held held) {
  if (held == Held::kInside) return {glm::clamp(p, lo, hi)};
  for (int i = 0; i < 3; ++i) {
    if (p[i] <= lo[i] || p[i] >= hi[i]) return {p};
  }
  Minima faces;
  for (int i = 0; i < 3; ++i) {
    for (const double wall : {lo[i], hi[i]}) {
      faces.push_back(p);
      faces.back()[i] = wall;
    }
  }
  return faces;
}

Minima coneInside(const Vec3& p, const Vec3& base, const Vec3& axis, double radius, double height) {
  const double up = glm::dot(p - base, axis);
  const Vec3 across = (p - base) - up * axis;
  const double flat = glm::length(across);
  // In the half-plane through the axis, the base goes from (0, 0) to (radius, 0), and the side from
  // there to (0, height).
  if (up >= 0.0 && flat * height + up * radius <= radius * height) return {p};
  const double length = std::hypot(radius, height);
  const double share =
      std::clamp((up * height + (radius - flat) * radius) / (length * length), 0.0, 1.0);
  const double on_side_flat = radius * (1.0 - share);
  const double on_side_up = height * share;
  const double on_base_flat = std::min(flat, radius);
  const bool is_base =
      std::hypot(flat - on_base_flat, up) < std::hypot(flat - on_side_flat, up - on_side_up);
  const double at_flat = is_base ? on_base_flat : on_side_flat;
  const double at_up = is_base ? 0.0 : on_side_up;
  const Vec3 outward = flat > 0.0 ? across / flat : Vec3(0.0);
  return {base + at_up * axis + at_flat * outward};
}

Minima twoBallUnionOutside(const Vec3& p, const Ball& a, const Ball& b) {
  if (!isInside(p, a) && !isInside(p, b)) return {p};
  Minima minima;
  // If P is outside a ball, that ball has no minimum of its own: P pulls the proxy away from it.
  if (isInside(p, a) && !isInside(onSphere(p, a), b)) minima.push_back(onSphere(p, a));
  if (isInside(p, b) && !isInside(onSphere(p, b), a)) minima.push_back(onSphere(p, b));
  // The crease holds the proxy if P pulls it into the cone of both balls' normals: x - P = l_a n_a
  // + l_b n_b, l >= 0.
  const Vec3 x = onCrease(p, a, b);
  const Vec3 na = (x - a.center) / a.radius;
  const Vec3 nb = (x - b.center) / b.radius;
  const double c = glm::dot(na, nb);
  const double da = glm::dot(x - p, na);
  const double db = glm::dot(x - p, nb);
  if (da - c * db >= 0.0 && db - c * da >= 0.0) minima.push_back(x);
  return minima;
}

Minima lensInside(const Vec3& p, const Ball& a, const Ball& b) {
  const bool in_a = !(glm::length(p - a.center) > a.radius);
  const bool in_b = !(glm::length(p - b.center) > b.radius);
  if (in_a && in_b) return {p};
  if (!in_a && isInside(onSphere(p, a), b)) return {onSphere(p, a)};
  if (!in_b && isInside(onSphere(p, b), a)) return {onSphere(p, b)};
  return {onCrease(p, a, b)};
}

Minima lensOutside(const Vec3& p, const Ball& a, const Ball& b) {
  if (!isInside(p, a) || !isInside(p, b)) return {p};
  Minima minima;
  if (isInside(onSphere(p, a), b)) minima.push_back(onSphere(p, a));
  if (isInside(onSphere(p, b), a)) minima.push_back(onSphere(p, b));
  return minima;
}

Minima grooveMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2) {
  const double a = glm::dot(p - point, n1);
  const double b = glm::dot(p - point, n2);
  const double c = glm::dot(n1, n2);
  if (a >= 0.0 && b >= 0.0) return {p};
  if (a < 0.0 && b - a * c >= 0.0) return {p - a * n1};
  if (b < 0.0 && a - b * c >= 0.0) return {p - b * n2};
  const Vec3 line = glm::normalize(glm::cross(n1, n2));
  return {point + glm::dot(p - point, line) * line};
}

Minima foldMinima(const Vec3& p, const Vec3& point, const Vec3& n1, const Vec3& n2) {
  const double a = glm::dot(p - point, n1);
  const double b = glm::dot(p - point, n2);
  const double c = glm::dot(n1, n2);
  if (a >= 0.0 || b >= 0.0) return {p};
  Minima minima;
  // The foot on a plane counts only where it lies on the wedge: where the other condition does not
  // hold.
  if (b - a * c < 0.0) minima.push_back(p - a * n1);
  if (a - b * c < 0.0) minima.push_back(p - b * n2);
  return minima;
}

Vec3 closestOnEllipsoid(const Vec3& p, const Vec3& radii) {
  using Real = long double;
  std::array<Real, 3> r{};
  std::array<Real, 3> q{};
  for (std::size_t i = 0; i < 3; ++i) {
    r[i] = static_cast<Real>(radii[static_cast<int>(i)]);
    q[i] = std::fabs(static_cast<Real>(p[static_cast<int>(i)]));
  }
  // x_i = r_i^2 q_i / (r_i^2 + t); t is the largest root of F(t) = sum (r_i q_i / (r_i^2 + t))^2 -
  // 1, which falls from t > -(smallest r)^2 on.
  const Real smallest = std::min({r[0], r[1], r[2]});
  const auto excess = [&](Real t) {
    Real sum = -1.0L;
    for (std::size_t i = 0; i < 3; ++i) {
      const Real denominator = r[i] * r[i] + t;
      if (q[i] != 0.0L) sum += (r[i] * q[i] / denominator) * (r[i] * q[i] / denominator);
    }
    return sum;
  };
  const Real pole = -smallest * smallest;
  Real low = pole;
  Real high = pole;
  for (std::size_t i = 0; i < 3; ++i) {
    high += r[i] * q[i];  // at this t no term exceeds its share of 1
    // At this t a single term is already 1
    if (r[i] == smallest) low = std::max(low, pole + r[i] * q[i]);
  }
  high = std::max(high, low);
  std::array<Real, 3> x{};
  const bool has_root = low > pole || excess(low) > 0.0L;
  if (has_root) {
    for (int k = 0; k < 200 && low < high; ++k) {
      const Real middle = low + (high - low) / 2;
      if (middle == low || middle == high) break;
      (excess(middle) > 0.0L ? low : high) = middle;
    }
    const Real t = low + (high - low) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      x[i] = q[i] == 0.0L ? 0.0L : r[i] * r[i] * q[i] / (r[i] * r[i] + t);
    }
  } else {
    // P is so deep on the symmetry plane of the shortest axis that two points are equally close.
    Real left = 1.0L;
    std::size_t shortest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      if (r[i] == smallest) {
        shortest = i;
        continue;
      }
      x[i] = q[i] == 0.0L ? 0.0L : r[i] * r[i] * q[i] / (r[i] * r[i] + pole);
      left -= (x[i] / r[i]) * (x[i] / r[i]);
    }
    x[shortest] = r[shortest] * std::sqrt(std::max(left, 0.0L));
  }
  Vec3 out(0.0);
  for (std::size_t i = 0; i < 3; ++i) {
    const int k = static_cast<int>(i);
    out[k] = std::copysign(static_cast<double>(x[i]), p[k]);
  }
  return out;
}

}  // namespace palpate::oracle
