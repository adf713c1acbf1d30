#include "palpate/contact/planes.h"

#include <algorithm>

#include "contact/eigen2.h"

namespace palpate {
namespace {

/// Relative to the lengths involved: by how much rounding may violate a plane.
constexpr double kSlack = 1e-12;
/// Square of the sine below which two normals are parallel, to rounding.
constexpr double kParallel = 1e-24;

/// The most planes through one point whose subsets are searched for multipliers.
constexpr std::size_t kMostTouched = 12;

class Search {
 public:
  Search(const Vec3& wish, std::span<const Plane> planes) noexcept
      : wish_(wish), planes_(planes.first(std::min(planes.size(), kMaxPlanes))) {
    double size = glm::length(wish);
    for (const Plane& plane : planes_) size = std::max(size, std::fabs(plane.gap));
    slack_ = kSlack * size;
  }

  [[nodiscard]] PlaneSolution solve() noexcept {
    Vec3 step = wish_;
    std::array<int, 3> set{};
    int count = 0;
    for (int i = 0; i < size(); ++i) {
      if (!breaks(i, step)) continue;
      count = onPlane(i, step, set);
    }
    return withMultipliers(step, set, count);
  }

 private:
  [[nodiscard]] int size() const noexcept { return static_cast<int>(planes_.size()); }
  [[nodiscard]] const Plane& at(int i) const noexcept {
    return planes_[static_cast<std::size_t>(i)];
  }
  [[nodiscard]] double left(int i, const Vec3& step) const noexcept {
    return glm::dot(at(i).normal, step) + at(i).gap;
  }
  [[nodiscard]] bool breaks(int i, const Vec3& step) const noexcept {
    return left(i, step) < -slack_;
  }

  /// The best step on plane `i` that respects the planes before it. Returns the number of planes
  /// that determine it.
  int onPlane(int i, Vec3& step, std::array<int, 3>& set) noexcept {
    step = wish_ - left(i, wish_) * at(i).normal;
    step -= left(i, step) * at(i).normal;
    set[0] = i;
    int count = 1;
    for (int j = 0; j < i; ++j) {
      if (!breaks(j, step)) continue;
      const int held = onLine(i, j, step, set);
      if (held > 0) count = held;
    }
    return count;
  }

  /// The same on the line where planes `i` and `j` meet; 0, and no change, where they are parallel.
  int onLine(int i, int j, Vec3& step, std::array<int, 3>& set) noexcept {
    const Vec3& a = at(i).normal;
    const Vec3& b = at(j).normal;
    const Vec3 along = glm::cross(a, b);
    const double square = glm::dot(along, along);
    if (square < kParallel) return 0;
    const double cosine = glm::dot(a, b);
    Vec3 on = wish_;
    for (int pass = 0; pass < 3;
         ++pass) {  // the second and third pass remove the rounding of the first
      const double r = left(i, on);
      const double s = left(j, on);
      on -= ((r - cosine * s) * a + (s - cosine * r) * b) / square;
    }
    const Vec3 t = along / std::sqrt(square);
    double lo = -kInfinity;
    double hi = kInfinity;
    int lo_plane = -1;
    int hi_plane = -1;
    for (int k = 0; k < j; ++k) {
      const double rise = glm::dot(at(k).normal, t);
      const double have = left(k, on);
      // The line lies almost in this plane, which was handled together with the two others.
      if (std::fabs(rise) < 1e-12) continue;
      const double where = -have / rise;
      if (rise > 0.0 && where > lo) {
        lo = where;
        lo_plane = k;
      } else if (rise < 0.0 && where < hi) {
        hi = where;
        hi_plane = k;
      }
    }
    set[0] = i;
    set[1] = j;
    const double best = lo > hi ? 0.5 * (lo + hi) : std::clamp(0.0, lo, hi);
    step = on + best * t;
    if (best == 0.0) return 2;
    set[2] = best == lo || lo > hi ? lo_plane : hi_plane;
    return 3;
  }

  /// Multipliers of the planes that push the step to where it is. The set that the search ended
  /// with is tried first; where more than three planes meet, another set may be the right one.
  [[nodiscard]] PlaneSolution withMultipliers(const Vec3& step, const std::array<int, 3>& set,
                                              int count) noexcept {
    PlaneSolution out;
    out.step = step;
    if (count == 0) return out;
    const Vec3 push = step - wish_;
    const double length = glm::length(push);
    if (fits(push, set, count, length, out)) return out;
    std::array<int, kMostTouched> touched{};
    int n = 0;
    for (int i = 0; i < size() && n < static_cast<int>(kMostTouched); ++i) {
      if (left(i, step) <= 4.0 * slack_ + 1e-9 * length) touched[static_cast<std::size_t>(n++)] = i;
    }
    const auto member = [&](int i) { return touched[static_cast<std::size_t>(i)]; };
    for (int a = 0; a < n; ++a) {
      if (fits(push, {member(a), 0, 0}, 1, length, out)) return out;
      for (int b = 0; b < a; ++b) {
        if (fits(push, {member(a), member(b), 0}, 2, length, out)) return out;
        for (int c = 0; c < b; ++c) {
          if (fits(push, {member(a), member(b), member(c)}, 3, length, out)) return out;
        }
      }
    }
    if (out.count == 0) {
      out.count = 1;
      out.plane[0] = set[0];
      out.multiplier[0] = std::max(0.0, glm::dot(push, at(set[0]).normal));
    }
    return out;
  }

  /// Whether `push` is a combination of the set's normals with weights not below zero; keeps the
  /// best set so far.
  bool fits(const Vec3& push, const std::array<int, 3>& set, int count, double length,
            PlaneSolution& best) noexcept {
    std::array<double, 3> m{};
    const Vec3& a = at(set[0]).normal;
    if (count == 1) {
      m[0] = glm::dot(push, a);
    } else if (count == 2) {
      const Vec3& b = at(set[1]).normal;
      const double cosine = glm::dot(a, b);
      const Vec3 across = glm::cross(a, b);
      const double square = glm::dot(across, across);
      if (square < kParallel) return false;
      m[0] = (glm::dot(push, a) - cosine * glm::dot(push, b)) / square;
      m[1] = (glm::dot(push, b) - cosine * glm::dot(push, a)) / square;
    } else {
      const Vec3& b = at(set[1]).normal;
      const Vec3& c = at(set[2]).normal;
      const Vec3 bc = glm::cross(b, c);
      const double det = glm::dot(a, bc);
      if (std::fabs(det) < 1e-12) return false;
      m[0] = glm::dot(push, bc) / det;
      m[1] = glm::dot(push, glm::cross(c, a)) / det;
      m[2] = glm::dot(push, glm::cross(a, b)) / det;
    }
    Vec3 rest = push;
    PlaneSolution found;
    found.step = best.step;
    for (int k = 0; k < count; ++k) {
      const auto i = static_cast<std::size_t>(k);
      if (m[i] < -1e-9 * length) return false;
      if (!(m[i] > 0.0)) continue;
      const auto slot = static_cast<std::size_t>(found.count++);
      found.plane[slot] = set[i];
      found.multiplier[slot] = m[i];
      rest -= m[i] * at(set[i]).normal;
    }
    const double off = glm::length(rest);
    if (off < least_off_) {
      least_off_ = off;
      best = found;
    }
    return off <= 1e-9 * length + slack_;
  }

  const Vec3& wish_;
  std::span<const Plane> planes_;
  double slack_ = 0.0;
  double least_off_ = kInfinity;
};

/// One plane, the most frequent case: the same result as the search, without its bookkeeping.
PlaneSolution closestStepBy(const Vec3& wish, const Plane& plane) noexcept {
  const double push = -plane.gap - glm::dot(plane.normal, wish);
  const double size = std::max(glm::dot(wish, wish), plane.gap * plane.gap);
  if (push <= 0.0 || push * push <= kSlack * kSlack * size) return {wish};
  return {wish + push * plane.normal, 1, {0}, {push}};
}

/// The half-plane x * u + y * v >= at. Not initialized, since dozens are made in every search.
struct Line2 {
  double x, y;
  double at;
};

/// Moves (u, v) to the nearest point that respects the lines; leaves it unchanged where there is
/// none.
void closestInPlane(double& u, double& v, std::span<const Line2> lines) noexcept {
  const double wish_u = u;
  const double wish_v = v;
  for (std::size_t j = 0; j < lines.size(); ++j) {
    const Line2& own = lines[j];
    const double square = own.x * own.x + own.y * own.y;
    const double have = own.x * u + own.y * v;
    if (have >= own.at || !(square > 0.0)) continue;
    const double by = (own.at - own.x * wish_u - own.y * wish_v) / square;
    const double u0 = wish_u + by * own.x;
    const double v0 = wish_v + by * own.y;
    double lo = -kInfinity;
    double hi = kInfinity;
    for (std::size_t k = 0; k < j; ++k) {
      const double rise = lines[k].x * -own.y + lines[k].y * own.x;
      const double need = lines[k].at - lines[k].x * u0 - lines[k].y * v0;
      if (rise > 0.0) {
        lo = std::max(lo, need / rise);
      } else if (rise < 0.0) {
        hi = std::min(hi, need / rise);
      }
    }
    const double t = lo > hi ? 0.5 * (lo + hi) : std::clamp(0.0, lo, hi);
    u = u0 - t * own.y;
    v = v0 + t * own.x;
  }
}

}  // namespace

void tangentsOf(const Vec3& n, Vec3& t1, Vec3& t2) noexcept {
  const double sign = std::copysign(1.0, n.z);
  const double share = -1.0 / (sign + n.z);
  const double mixed = n.x * n.y * share;
  t1 = Vec3(1.0 + sign * n.x * n.x * share, sign * mixed, -sign * n.x);
  t2 = Vec3(mixed, sign + n.y * n.y * share, -n.y);
}

PlaneSolution closestStep(const Vec3& wish, std::span<const Plane> planes) noexcept {
  if (planes.size() == 1) return closestStepBy(wish, planes[0]);
  return Search(wish, planes).solve();
}

CurvedStep curvedStep(const Vec3& wish, std::span<const Plane> planes, const PlaneSolution& first,
                      const Mat3& bend, double least) noexcept {
  CurvedStep out;
  out.step = first.step;
  if (first.count == 0 || first.count > 2) return out;
  const auto clamped = [&](double eigenvalue) { return std::max(std::fabs(eigenvalue), least); };
  const auto holds = [&](std::size_t j) {
    for (int k = 0; k < first.count; ++k) {
      if (first.plane[static_cast<std::size_t>(k)] == static_cast<int>(j)) return true;
    }
    return false;
  };
  const Plane& a = planes[static_cast<std::size_t>(first.plane[0])];
  if (first.count == 2) {
    const Plane& b = planes[static_cast<std::size_t>(first.plane[1])];
    const Vec3 t = unitOr(glm::cross(a.normal, b.normal), Vec3(0.0));
    const double eigenvalue = 1.0 - glm::dot(t, bend * t);
    out.lowest = eigenvalue;
    out.downhill = t;
    const double have = glm::dot(t, first.step);
    double want = glm::dot(t, wish) / clamped(eigenvalue);
    const Vec3 base = first.step - have * t;
    for (std::size_t j = 0; j < planes.size(); ++j) {
      if (holds(j)) continue;
      const double rise = glm::dot(planes[j].normal, t);
      const double need = -planes[j].gap - glm::dot(planes[j].normal, base);
      if (rise > 1e-12) want = std::max(want, std::min(have, need / rise));
      if (rise < -1e-12) want = std::min(want, std::max(have, need / rise));
    }
    out.step = base + want * t;
    return out;
  }
  Vec3 t1(0.0);
  Vec3 t2(0.0);
  tangentsOf(a.normal, t1, t2);
  const Vec3 b1 = bend * t1;
  const double m11 = 1.0 - glm::dot(t1, b1);
  const double m12 = -glm::dot(t2, b1);
  const double m22 = 1.0 - glm::dot(t2, bend * t2);
  const Vec3 base = glm::dot(a.normal, first.step) * a.normal;
  const double det = m11 * m22 - m12 * m12;
  const double trace = m11 + m22;
  // Far from the centers of curvature, and with no other plane near, the system is solved directly.
  if (planes.size() == 1 && trace > 0.0 && det > least * (trace - least)) {
    const double p1 = glm::dot(t1, wish);
    const double p2 = glm::dot(t2, wish);
    out.step = base + t1 * ((m22 * p1 - m12 * p2) / det) + t2 * ((m11 * p2 - m12 * p1) / det);
    out.lowest = det / trace;  // below both eigenvalues, and positive when they are
    return out;
  }
  const Eigen2 e = eigen(m11, m12, m22, t1, t2);
  out.lowest = e.low;
  out.downhill = e.e_low;
  // In coordinates scaled by the square roots of the eigenvalues the objective is a plain distance.
  const double root_low = std::sqrt(clamped(e.low));
  const double root_high = std::sqrt(clamped(e.high));
  std::array<Line2, kMaxPlanes> lines;
  std::size_t count = 0;
  for (std::size_t j = 0; j < std::min(planes.size(), kMaxPlanes); ++j) {
    if (holds(j)) continue;
    const Line2 line{glm::dot(planes[j].normal, e.e_low) / root_low,
                     glm::dot(planes[j].normal, e.e_high) / root_high,
                     -planes[j].gap - glm::dot(planes[j].normal, base)};
    if (line.x * line.x + line.y * line.y > 1e-24) lines[count++] = line;
  }
  double u = glm::dot(e.e_low, wish) / root_low;
  double v = glm::dot(e.e_high, wish) / root_high;
  closestInPlane(u, v, std::span(lines.data(), count));
  out.step = base + (u / root_low) * e.e_low + (v / root_high) * e.e_high;
  return out;
}

}  // namespace palpate
