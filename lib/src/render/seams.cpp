#include "seams.h"

#include <algorithm>
#include <cmath>

#include "solver_limits.h"

namespace palpate {
namespace {

constexpr int kMostSteps = 20;
/// Relative to the farthest distance: a step as short as this is the last.
constexpr double kMet = 1e-12;
/// Relative to the coordinates: a step as short as this is rounding.
constexpr double kRounding = 1e-15;
/// Two surfaces make a seam if they cross at an angle whose sine has at least this square.
constexpr double kFlattest = 1e-3;
/// Smallest eigenvalue at which a point of a seam can be the nearest: closer to its center of
/// curvature it is not.
constexpr double kFirm = 0.02;
/// Relative to the radius: a seam as near as this takes its direction from the leaf alone, since
/// the way to it is rounding.
constexpr double kOnSeam = 1e-7;

}  // namespace

SeamShare seamShare(double distance, double radius) noexcept {
  if (!(distance < radius)) return {};
  const double u = distance / radius;
  const double rate = 0.75 * (1.0 - u * u) / radius;
  return {0.5 + 0.25 * u * (3.0 - u * u), rate, -u * rate};
}

SeamPoint seamPoint(const Field& wall, const Field& other, const Vec3& place,
                    double farthest) noexcept {
  SeamPoint out{place, false};
  const double rounding =
      kRounding * std::max({std::fabs(place.x), std::fabs(place.y), std::fabs(place.z)});
  for (int i = 0; i < kMostSteps; ++i) {
    const FieldJet a = wall.jet(out.at);
    const FieldJet b = other.jet(out.at);
    const double slope_a = glm::length(a.gradient);
    const double slope_b = glm::length(b.gradient);
    if (!a.in_band || !b.in_band || !(slope_a > 0.0) || !(slope_b > 0.0)) return out;
    const Vec3 m = a.gradient / slope_a;
    const Vec3 n = b.gradient / slope_b;
    const double cosine = glm::dot(m, n);
    const double square = 1.0 - cosine * cosine;
    if (!(square > kFlattest)) return out;
    const auto across = [&](double by_m, double by_n) {
      return ((by_m - cosine * by_n) / square) * m + ((by_n - cosine * by_m) / square) * n;
    };
    // The part of the way to `place` that is across the seam.
    const Vec3 way = place - out.at;
    const double way_m = glm::dot(way, m);
    const double way_n = glm::dot(way, n);
    const Vec3 along = glm::cross(m, n) / std::sqrt(square);
    const double bend =
        1.0 + (way_m - cosine * way_n) / square * glm::dot(along, a.hessian * along) / slope_a +
        (way_n - cosine * way_m) / square * glm::dot(along, b.hessian * along) / slope_b;
    if (!(bend > kFirm)) return out;
    const Vec3 step =
        (glm::dot(way, along) / bend) * along - across(a.value / slope_a, b.value / slope_b);
    out.at += step;
    if (!(glm::length(out.at - place) <= 3.0 * farthest)) return out;
    if (glm::length(step) <= kMet * farthest + rounding) {
      out.found = glm::length(out.at - place) < farthest;
      return out;
    }
  }
  return out;
}

/// Collects the leaves that change side together with this one, as the walker does.
void Seams::gather(LeafId leaf, const HeldWall& held) noexcept {
  surface_[0] = leaf;
  surface_count_ = 1;
  const double steep = glm::length(held.jet.gradient);
  const double off = steep > 0.0 ? held.side * held.jet.value / steep : 0.0;
  for (std::size_t i = 0; i < count_ && surface_count_ < surface_.size(); ++i) {
    const LeafId other = near_[i];
    if (other == leaf) continue;
    const FieldJet& jet = walker_.jetHere(other);
    const double slope = glm::length(jet.gradient);
    const double near = limits::kTouch * limits::kOnSurface *
                        (walker_.leaf(other).feature + walker_.leaf(leaf).feature);
    if (!(slope > 0.0)) continue;
    if (!(std::fabs(walker_.side(other) * jet.value / slope - off) <= near)) continue;
    const double cosine = walker_.side(other) / slope * glm::dot(held.normal, jet.gradient);
    if (cosine > 1.0 - limits::kParallel) surface_[surface_count_++] = other;
  }
}

bool Seams::isOnSurface(LeafId leaf) const noexcept {
  const auto* const end = surface_.begin() + static_cast<std::ptrdiff_t>(surface_count_);
  return std::find(surface_.begin(), end, leaf) != end;
}

void Seams::addSeam(const Seam& seam) noexcept {
  for (std::size_t i = 0; i < seam_count_; ++i) {
    Seam& known = seam_[i];
    const double near = limits::kTouch * limits::kOnSurface * walker_.leaf(known.leaf[0]).feature;
    if (known.count < known.leaf.size() && glm::length(known.at - seam.at) <= near &&
        std::fabs(glm::dot(known.normal, seam.normal)) > 1.0 - limits::kParallel) {
      known.leaf[known.count++] = seam.leaf[0];
      return;
    }
  }
  if (seam_count_ < seam_.size()) {
    seam_[seam_count_++] = seam;
    return;
  }
  Seam& last = *std::max_element(seam_.begin(), seam_.end(), [](const Seam& a, const Seam& b) {
    return a.distance < b.distance;
  });
  leaveOut(seam.distance < last.distance ? last : seam);
  if (seam.distance < last.distance) last = seam;
}

void Seams::leaveOut(const Seam& seam) noexcept {
  if (!(seam.distance < patch_)) return;
  patch_ = seam.distance;
  patch_away_ = seam.away;
  leaves_out_ = true;
}

void Seams::findSeams(const HeldWall& held, const Vec3& place, double radius) noexcept {
  seam_count_ = 0;
  patch_ = radius;
  leaves_out_ = false;
  for (std::size_t i = 0; i < count_; ++i) {
    const LeafId leaf = near_[i];
    if (isOnSurface(leaf)) continue;
    const Leaf& own = walker_.leaf(leaf);
    const FieldSample there = own.field->sample(place);
    if (!there.in_band || !(std::fabs(there.value) < own.lipschitz * radius)) continue;
    const SeamPoint point = seamPoint(*held.field, *own.field, place, radius);
    if (!point.found) continue;
    Seam seam;
    seam.leaf[seam.count++] = leaf;
    seam.at = point.at;
    const double side = there.value == 0.0 ? walker_.side(leaf) : std::copysign(1.0, there.value);
    seam.normal = side * unitOr(there.gradient, Vec3(0.0));
    const Vec3 way = place - point.at;
    seam.distance = glm::length(way);
    if (seam.distance > kOnSeam * radius) {
      seam.away = way / seam.distance;
    } else {
      const Vec3 along = seam.normal - glm::dot(seam.normal, held.normal) * held.normal;
      seam.away = unitOr(along, Vec3(0.0));
    }
    addSeam(seam);
  }
  for (std::size_t i = 0; i < seam_count_; ++i) {
    seam_[i].share = seamShare(seam_[i].distance, patch_);
  }
}

Facet Seams::facetAcross(unsigned across, const Vec3& place) noexcept {
  std::array<LeafId, 8 * kMostSeams> turned{};
  std::size_t count = 0;
  for (std::size_t i = 0; i < seam_count_; ++i) {
    const Seam& seam = seam_[i];
    const bool is_across = ((across >> i) & 1U) != 0;
    for (std::size_t k = 0; k < seam.count; ++k) {
      // The walker's sides are those at the proxy, while `place` may be beyond the seam.
      const double value = walker_.leaf(seam.leaf[k]).field->value(place);
      const bool is_inside = value == 0.0 ? walker_.side(seam.leaf[k]) < 0.0 : value < 0.0;
      if ((is_inside != is_across) != (walker_.side(seam.leaf[k]) < 0.0)) {
        turned[count++] = seam.leaf[k];
      }
    }
  }
  return walker_.facetAside({turned.data(), count}, {surface_.data(), surface_count_}, place);
}

std::span<const Seams::Part> Seams::at(LeafId leaf, const HeldWall& held, const Vec3& place,
                                       const Vec3& press) noexcept {
  surface_count_ = 0;
  if (count_ == 0) return {};
  const double radius = glm::length(press);
  if (!(radius > 0.0)) return {};
  gather(leaf, held);
  findSeams(held, place, radius);
  if (seam_count_ == 0) return {};
  const Vec3 deeper = press / radius;
  double all = 0.0;
  Vec3 all_by_place(0.0);
  Vec3 all_by_press(0.0);
  std::size_t count = 0;
  const unsigned sides = 1U << seam_count_;
  for (unsigned across = 0; across < sides; ++across) {
    Part part;
    part.facet = facetAcross(across, place);
    if (!part.facet.isClosed() || part.facet.material < 0) continue;
    // A part lies on one side of each seam. The shares multiply, as where seams cross at right
    // angles.
    for (std::size_t i = 0; i < seam_count_; ++i) {
      const SeamShare& share = seam_[i].share;
      const bool is_across = ((across >> i) & 1U) != 0;
      const double value = is_across ? 1.0 - share.value : share.value;
      const double sign = is_across ? -1.0 : 1.0;
      part.by_place =
          value * part.by_place + (sign * part.share * share.by_distance) * seam_[i].away;
      const double by_radius = sign * part.share * share.by_radius;
      part.by_press = value * part.by_press;
      (leaves_out_ ? part.by_place : part.by_press) +=
          by_radius * (leaves_out_ ? patch_away_ : deeper);
      part.share *= value;
    }
    all += part.share;
    all_by_place += part.by_place;
    all_by_press += part.by_press;
    part_[count++] = part;
  }
  // Parts without a wall, or with an opening, bear nothing: the remaining parts share the whole
  // press.
  if (!(all > 0.0)) return {};
  for (std::size_t i = 0; i < count; ++i) {
    Part& part = part_[i];
    part.share /= all;
    part.by_place = (part.by_place - part.share * all_by_place) / all;
    part.by_press = (part.by_press - part.share * all_by_press) / all;
  }
  return {part_.data(), count};
}

}  // namespace palpate
