#pragma once
/// Finds wires and crumbs that a grid has lost, in any solid that answers three questions.

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>

#include "bake/lost_plates.h"
#include "palpate/core/math.h"

namespace palpate::vdb {

/// Follows a thin part along its length, starting in its middle. Lengths and places in voxels.
///
/// `Solid` has
///   double wayOut(const Vec3& from, const Vec3& along): to the next wall, infinite if that is far;
///   bool isInside(const Vec3&): of the solid;
///   bool isHeld(const Vec3&): by the grid.
///
/// A cone does not count as a wire: the tip of a needle of 5 degrees and more may be lost, like the
/// last voxels of an edge.
template <class Solid>
class ThinPart {
 public:
  explicit ThinPart(const Solid& solid) : solid_(solid) {}

  /// `middle` is in the solid, halfway through it along the unit vector `in`.
  [[nodiscard]] std::optional<LostShape> lostAt(const Vec3& middle, const Vec3& in) {
    Place start{middle, in, longestAcross(middle, in)};
    // The cross section perpendicular to the part's direction, from where it is widest: `in` may
    // cross it at an angle.
    const Vec3 widest = longestAcross(middle, start.along);
    start.in = glm::cross(widest, start.along);
    // The middle along two directions is not yet the middle of a cross section with corners.
    // Repeat; from the second time on, the direction is that of the part itself.
    for (int n = 0; n < 4; ++n) {
      if (!center(start)) return {};
    }
    if (isCutHeld(start)) return {};
    is_held_ = false;
    const Way ahead = follow(start);
    start.along = -start.along;
    const Way back = follow(start);
    if (ahead.end == End::kFar && back.end == End::kFar) {
      const auto [least, most] = std::minmax(ahead.thickness, back.thickness);
      if (least >= kWireTaper * most) return LostShape::kWire;
      return {};
    }
    if (ahead.end == End::kFree && back.end == End::kFree && !is_held_) return LostShape::kCrumb;
    return {};
  }

 private:
  /// Parts wider than this are left to the search for plates, which looks at four sides itself.
  static constexpr double kWide = 2.0 * kGoesOn;
  /// Ratio of the thicknesses at both ends of four voxels; a smaller one means a tip. A tip of 5
  /// degrees is lost from where it is 1.5 voxels thick, and has a ratio of 0.79 there.
  static constexpr double kWireTaper = 0.8;
  static constexpr double kStep = 0.25;

  enum class End { kFree, kWide, kFar };
  struct Way {
    End end;
    double thickness;
  };
  struct Place {
    Vec3 middle;
    Vec3 in;     ///< across the part, where it is thin
    Vec3 along;  ///< perpendicular to `in`
    double thickness = 0.0;
    double width = 0.0;  ///< perpendicular to both
  };

  [[nodiscard]] double chord(const Vec3& from, const Vec3& along) const {
    return std::min(solid_.wayOut(from, along), kWide) +
           std::min(solid_.wayOut(from, -along), kWide);
  }

  /// The direction perpendicular to `axis` in which the part is longest.
  [[nodiscard]] Vec3 longestAcross(const Vec3& middle, const Vec3& axis) const {
    const Vec3 aside = std::fabs(axis.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(axis, aside));
    const Vec3 v = glm::cross(axis, u);
    const auto at = [&](double angle) { return std::cos(angle) * u + std::sin(angle) * v; };
    constexpr int kTurns = 16;
    double step = std::numbers::pi / kTurns;
    double best = 0.0;
    double longest = -1.0;
    const auto look = [&](double angle) {
      const double here = chord(middle, at(angle));
      if (here <= longest) return;
      longest = here;
      best = angle;
    };
    for (int n = 0; n < kTurns; ++n) look(n * step);
    for (int n = 0; n < 4; ++n) {
      step *= 0.5;
      const double from = best;
      look(from - step);
      look(from + step);
    }
    return at(best);
  }

  /// Moves into the middle of the cross section; false where that is wide.
  [[nodiscard]] bool center(Place& place) const {
    const Vec3 across = glm::cross(place.in, place.along);
    const double left = solid_.wayOut(place.middle, across);
    const double right = solid_.wayOut(place.middle, -across);
    if (!(left + right < kWide)) return false;
    place.middle += 0.5 * (left - right) * across;
    const double before = solid_.wayOut(place.middle, place.in);
    const double behind = solid_.wayOut(place.middle, -place.in);
    if (!(before + behind < kWide)) return false;
    place.middle += 0.5 * (before - behind) * place.in;
    place.thickness = std::min(before + behind, left + right);
    place.width = left + right;
    return true;
  }

  [[nodiscard]] bool isCutHeld(const Place& place) const {
    const Vec3 across = glm::cross(place.in, place.along);
    const auto steps = static_cast<int>(place.width / kStep) + 2;
    for (int n = 1; n < steps; ++n) {
      const double share = static_cast<double>(n) / steps - 0.5;
      if (solid_.isHeld(place.middle + share * place.width * across)) return true;
    }
    return false;
  }

  Way follow(const Place& start) {
    Place place = start;
    double done = 0.0;
    while (done < kGoesOn) {
      const double step = std::clamp(place.thickness, 0.05, kStep);
      const Vec3 before = place.middle;
      place.middle += step * place.along;
      if (!solid_.isInside(place.middle)) return {End::kFree, place.thickness};
      if (!center(place)) return {End::kWide, place.thickness};
      is_held_ = is_held_ || isCutHeld(place);
      // Follow its bends.
      const Vec3 along =
          unitOr(place.along + unitOr(place.middle - before, place.along), place.along);
      if (glm::dot(along, place.along) < 0.5) return {End::kFree, place.thickness};
      place.along = along;
      place.in = unitOr(place.in - glm::dot(place.in, along) * along, place.in);
      done += step;
    }
    return {End::kFar, place.thickness};
  }

  const Solid& solid_;
  bool is_held_ = false;
};

}  // namespace palpate::vdb
