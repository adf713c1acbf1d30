#include "palpate/contact/planes.h"

#include <algorithm>

namespace palpate {
namespace {

/// Solves G m = r for the Gram matrix of one to three unit normals; false if nearly dependent.
bool multipliers(std::span<const Plane> planes, const std::array<int, 3>& set, int count,
                 const Vec3& wish, std::array<double, 3>& out) noexcept {
  std::array<Vec3, 3> n{};
  std::array<double, 3> r{};
  for (int i = 0; i < count; ++i) {
    const Plane& plane = planes[static_cast<std::size_t>(set[static_cast<std::size_t>(i)])];
    n[static_cast<std::size_t>(i)] = plane.normal;
    r[static_cast<std::size_t>(i)] = -plane.gap - glm::dot(plane.normal, wish);
  }
  // Planes within 1e-4 rad of each other act as one: the pair's solution would be noise.
  constexpr double kDependent = 1e-8;
  if (count == 1) {
    out[0] = r[0];
    return true;
  }
  const double c01 = glm::dot(n[0], n[1]);
  if (count == 2) {
    const double det = 1.0 - c01 * c01;
    if (det < kDependent) return false;
    out[0] = (r[0] - c01 * r[1]) / det;
    out[1] = (r[1] - c01 * r[0]) / det;
    return true;
  }
  const double c02 = glm::dot(n[0], n[2]);
  const double c12 = glm::dot(n[1], n[2]);
  const Mat3 gram(1.0, c01, c02, c01, 1.0, c12, c02, c12, 1.0);
  const double det = glm::determinant(gram);
  if (det < kDependent) return false;
  const Vec3 m = glm::inverse(gram) * Vec3(r[0], r[1], r[2]);
  out = {m.x, m.y, m.z};
  return true;
}

/// Of the wish: what planes within the angle of kDependent may differ by.
constexpr double kNearlyFits = 1e-4;

class SetSearch {
 public:
  SetSearch(const Vec3& wish, std::span<const Plane> planes) noexcept
      : wish_(wish),
        planes_(planes.first(std::min(planes.size(), kMaxPlanes))),
        // Rounding of the dot products: a share of the lengths that enter them.
        slack_(1e-12 * glm::length(wish)) {
    for (const Plane& plane : planes_) slack_ = std::max(slack_, 1e-12 * std::fabs(plane.gap));
  }

  bool attempt(std::array<int, 3> set, int count) noexcept {
    std::array<double, 3> m{};
    if (count > 0 && !multipliers(planes_, set, count, wish_, m)) return false;
    Vec3 step = wish_;
    for (int i = 0; i < count; ++i) {
      const auto k = static_cast<std::size_t>(i);
      if (m[k] < 0.0) return false;
      step += m[k] * planes_[static_cast<std::size_t>(set[k])].normal;
    }
    double beyond = 0.0;
    for (std::size_t j = 0; j < planes_.size(); ++j) {
      const bool held =
          std::find(set.begin(), set.begin() + count, static_cast<int>(j)) != set.begin() + count;
      if (!held) beyond = std::max(beyond, -planes_[j].gap - glm::dot(planes_[j].normal, step));
    }
    if (beyond < least_beyond_) {
      least_beyond_ = beyond;
      solution_ = {step, count, set, m};
    }
    return beyond <= slack_;
  }

  [[nodiscard]] int size() const noexcept { return static_cast<int>(planes_.size()); }
  [[nodiscard]] const PlaneSolution& solution() const noexcept { return solution_; }

  /// No set fits. Where that is for rounding, among planes nearly parallel, the set that fits best is the
  /// one; else stay, held by the plane that the wish violates most.
  [[nodiscard]] PlaneSolution stay() const noexcept {
    if (least_beyond_ <= kNearlyFits * glm::length(wish_)) return solution_;
    PlaneSolution out;
    double worst = 0.0;
    for (std::size_t j = 0; j < planes_.size(); ++j) {
      const double push = -glm::dot(planes_[j].normal, wish_);
      if (push > worst) {
        worst = push;
        out.count = 1;
        out.plane[0] = static_cast<int>(j);
        out.multiplier[0] = push;
      }
    }
    return out;
  }

 private:
  const Vec3& wish_;
  std::span<const Plane> planes_;
  double slack_;
  PlaneSolution solution_;
  double least_beyond_ = kInfinity;
};

/// One plane, as most often: the same as the search below, without its bookkeeping.
PlaneSolution closestStepBy(const Vec3& wish, const Plane& plane) noexcept {
  const double push = -plane.gap - glm::dot(plane.normal, wish);
  const double size = std::max(glm::dot(wish, wish), plane.gap * plane.gap);
  if (push <= 0.0 || push * push <= 1e-24 * size) return {wish};
  return {wish + push * plane.normal, 1, {0}, {push}};
}

}  // namespace

PlaneSolution closestStep(const Vec3& wish, std::span<const Plane> planes) noexcept {
  if (planes.size() == 1) return closestStepBy(wish, planes[0]);
  SetSearch search(wish, planes);
  if (search.attempt({}, 0)) return search.solution();
  const int n = search.size();
  for (int a = 0; a < n; ++a) {
    if (search.attempt({a, 0, 0}, 1)) return search.solution();
  }
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      if (search.attempt({a, b, 0}, 2)) return search.solution();
    }
  }
  for (int a = 0; a < n; ++a) {
    for (int b = a + 1; b < n; ++b) {
      for (int c = b + 1; c < n; ++c) {
        if (search.attempt({a, b, c}, 3)) return search.solution();
      }
    }
  }
  return search.stay();
}

}  // namespace palpate
