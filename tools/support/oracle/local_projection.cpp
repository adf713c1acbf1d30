#include "support/oracle/local_projection.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <numbers>
#include <optional>
#include <utility>

namespace palpate::oracle {
namespace {

/// Tolerance [features] within which a side counts as kept: the error after Newton's last step.
constexpr double kSlack = 1e-11;

/// Differences over two spacings agree where a field is smooth, but not within reach of a cusp or
/// kink.
bool isSmoothAt(const FeasibleSet& set, const LocalPoint& found) {
  return std::all_of(found.active.begin(), found.active.end(), [&](std::size_t i) {
    const FieldSide& side = set.sides()[i];
    const Vec3 wide = side.gradient(found.point);
    return glm::length(wide - side.gradient(found.point, 0.125)) <= 1e-7 * glm::length(wide);
  });
}

/// Point nearest to `q` on all surfaces of `subset` at once, near `q`; by Gauss-Newton, whose error
/// shrinks like (curvature * distance)^k.
std::optional<LocalPoint> onSurfaces(const FeasibleSet& set, const std::vector<std::size_t>& subset,
                                     const Vec3& q, double radius) {
  const std::size_t m = subset.size();
  LocalPoint out{q, subset, std::vector<double>(m, 0.0)};
  std::vector<Vec3> normals(m);
  double last_step = kInfinity;
  for (int iteration = 0; iteration < 60; ++iteration) {
    std::vector<double> gram(m * m);
    std::vector<double> right(m);
    for (std::size_t i = 0; i < m; ++i) {
      const FieldSide& side = set.sides()[subset[i]];
      normals[i] = side.gradient(out.point);
      if (!isFinite(normals[i]) || normals[i] == Vec3(0.0)) return std::nullopt;
      right[i] = glm::dot(normals[i], out.point - q) - side.value(out.point);
    }
    for (std::size_t i = 0; i < m; ++i) {
      for (std::size_t j = 0; j < m; ++j) gram[i * m + j] = glm::dot(normals[i], normals[j]);
    }
    if (!solveLinear(gram, right)) return std::nullopt;
    Vec3 next = q;
    for (std::size_t i = 0; i < m; ++i) next += right[i] * normals[i];
    last_step = glm::length(next - out.point);
    out.point = next;
    out.multipliers = right;
    if (!(glm::length(next - q) <= 4.0 * radius)) return std::nullopt;
    if (last_step <= 1e-14 * radius + 2e-16 * glm::length(next)) break;
  }
  if (last_step > 1e-9 * radius || !isSmoothAt(set, out)) return std::nullopt;
  return out;
}

bool keeps(const FeasibleSet& set, const FeasibleSet::Branch& branch, const Vec3& p) {
  return std::all_of(branch.begin(), branch.end(), [&](std::size_t i) {
    const FieldSide& side = set.sides()[i];
    const double value = side.value(p);
    return value >= 0.0 ||
           value >= -kSlack * side.field->featureSize() * glm::length(side.gradient(p));
  });
}

/// Nearest point of one conjunction, if it is within `radius`.
std::optional<LocalPoint> inBranch(const FeasibleSet& set, const FeasibleSet::Branch& branch,
                                   const Vec3& q, double radius) {
  std::vector<std::size_t> near;
  for (const std::size_t i : branch) {
    const FieldSide& side = set.sides()[i];
    const double value = side.value(q);
    if (value <= 0.0 || value <= 2.5 * radius * glm::length(side.gradient(q))) near.push_back(i);
  }
  std::optional<LocalPoint> best;
  const auto attempt = [&](const std::vector<std::size_t>& subset) {
    std::optional<LocalPoint> found = onSurfaces(set, subset, q, radius);
    if (!found || glm::length(found->point - q) > radius * (1.0 + 1e-9)) return;
    double largest = 0.0;
    for (const double m : found->multipliers) largest = std::max(largest, std::fabs(m));
    for (const double m : found->multipliers) {
      if (m < -1e-9 * largest) return;
    }
    if (!keeps(set, branch, found->point)) return;
    if (!best || glm::length(found->point - q) < glm::length(best->point - q)) {
      best = std::move(found);
    }
  };
  for (const std::size_t i : near) attempt({i});
  if (best) return best;  // nearest on one side and allowed by all others: no corner can be nearer
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t j = i + 1; j < near.size(); ++j) attempt({near[i], near[j]});
  }
  if (best) return best;
  for (std::size_t i = 0; i < near.size(); ++i) {
    for (std::size_t j = i + 1; j < near.size(); ++j) {
      for (std::size_t k = j + 1; k < near.size(); ++k) attempt({near[i], near[j], near[k]});
    }
  }
  return best;
}

/// Distance from `q` along `direction` to the set, if less than `limit`.
std::optional<double> entry(const FeasibleSet& set, const Vec3& q, const Vec3& direction,
                            double limit) {
  const double slack = -1e-13 * set.feature();
  constexpr int kMarks = 12;
  double outside = 0.0;
  for (int i = 1; i <= kMarks; ++i) {
    double inside = limit * i / kMarks;
    if (set.value(q + inside * direction) < slack) {
      outside = inside;
      continue;
    }
    for (int k = 0; k < 50; ++k) {
      const double middle = 0.5 * (outside + inside);
      (set.value(q + middle * direction) < slack ? outside : inside) = middle;
    }
    return inside;
  }
  return std::nullopt;
}

/// Uses values alone: tries all directions coarsely, then a finer and finer grid of directions
/// about the best one. A grid, because the best direction may be at a corner of the directions that
/// meet the set.
LocalPoint byDirections(const FeasibleSet& set, const Vec3& q, double radius,
                        const std::optional<Vec3>& allowed) {
  constexpr int kDirections = 600;
  Vec3 best(0.0, 0.0, 1.0);
  double nearest = 2.5 * radius;
  const auto attempt = [&](const Vec3& direction) {
    const auto r = entry(set, q, direction, nearest);
    if (!r || *r >= nearest) return false;
    nearest = *r;
    best = direction;
    return true;
  };
  if (allowed && *allowed != q && isAllowed(set, *allowed)) {
    nearest = glm::length(*allowed - q);
    best = (*allowed - q) / nearest;
  }
  for (int i = 0; i < kDirections; ++i) {  // points of a Fibonacci sphere
    const double z = 1.0 - (2.0 * i + 1.0) / kDirections;
    const double angle = std::numbers::pi * (3.0 - std::sqrt(5.0)) * i;
    const double flat = std::sqrt(1.0 - z * z);
    attempt({flat * std::cos(angle), flat * std::sin(angle), z});
  }
  for (double width = 0.2; width > 1e-10;) {
    const Vec3 middle = best;
    const Vec3 side = glm::normalize(
        glm::cross(middle, std::fabs(middle.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0)));
    const Vec3 up = glm::cross(middle, side);
    constexpr int kHalf = 5;
    bool at_border = false;
    for (int i = -kHalf; i <= kHalf; ++i) {
      for (int j = -kHalf; j <= kHalf; ++j) {
        const Vec3 off =
            (width / kHalf) * (static_cast<double>(i) * side + static_cast<double>(j) * up);
        if (attempt(glm::normalize(middle + off))) {
          at_border = std::max(std::abs(i), std::abs(j)) == kHalf;
        }
      }
    }
    if (!at_border) width *= 0.5;
  }
  return {q + nearest * best, {}, {}, false};
}

}  // namespace

bool solveLinear(std::vector<double>& a, std::vector<double>& b) {
  const std::size_t n = b.size();
  double largest = 0.0;
  for (const double x : a) largest = std::max(largest, std::fabs(x));
  for (std::size_t column = 0; column < n; ++column) {
    std::size_t pivot = column;
    for (std::size_t row = column + 1; row < n; ++row) {
      if (std::fabs(a[row * n + column]) > std::fabs(a[pivot * n + column])) pivot = row;
    }
    if (!(std::fabs(a[pivot * n + column]) > 1e-13 * largest)) return false;
    for (std::size_t k = 0; k < n; ++k) std::swap(a[column * n + k], a[pivot * n + k]);
    std::swap(b[column], b[pivot]);
    for (std::size_t row = 0; row < n; ++row) {
      if (row == column) continue;
      const double factor = a[row * n + column] / a[column * n + column];
      for (std::size_t k = column; k < n; ++k) a[row * n + k] -= factor * a[column * n + k];
      b[row] -= factor * b[column];
    }
  }
  for (std::size_t i = 0; i < n; ++i) b[i] /= a[i * n + i];
  return true;
}

bool isAllowed(const FeasibleSet& set, const Vec3& p) {
  return std::any_of(set.branches().begin(), set.branches().end(),
                     [&](const FeasibleSet::Branch& branch) { return keeps(set, branch, p); });
}

LocalPoint projectLocally(const FeasibleSet& set, const Vec3& q, double radius,
                          const std::optional<Vec3>& allowed) {
  if (set.value(q) >= 0.0) return {q};
  std::optional<LocalPoint> best;
  for (const FeasibleSet::Branch& branch : set.branches()) {
    std::optional<LocalPoint> found = inBranch(set, branch, q, radius);
    if (found && (!best || glm::length(found->point - q) < glm::length(best->point - q))) {
      best = std::move(found);
    }
  }
  return best ? *best : byDirections(set, q, radius, allowed);
}

}  // namespace palpate::oracle
