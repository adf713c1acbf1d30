#pragma once
/// What bake() puts into a band: the values of a field with distances, cut off by a box.

#include <cstdint>

#include "bake/field_parts.h"

namespace palpate::vdb {

enum class Verdict : std::uint8_t { kOutside, kInside, kKeep };

/// A field that is not exact can fall short of the distance to its own bounds, and would have a
/// band without end there: so that it ends, values rise with twice that distance to the band's
/// width. Near the surface the field stays as smooth as it is, also where its bounds touch it. And
/// a box may cut it off. judge() also serves fields whose value is not a distance
/// (implicit_distances.h). Any number of threads may ask.
class BandSource {
 public:
  /// `domain` holds the surface, `band` is the half width; both in [m].
  BandSource(const Field& field, const Box3& domain, bool is_cut, double band);

  [[nodiscard]] const FieldParts& parts() const noexcept { return parts_; }
  [[nodiscard]] const FieldPart& whole() const noexcept { return parts_.whole(); }

  /// Whether every point within `radius` of `center` is more than the band away from the surface;
  /// if not, `to` is what is left of `from` there. It is exact, or only in the band if that is
  /// enough.
  [[nodiscard]] Verdict judge(const FieldPart& from, const Vec3& center, double radius,
                              bool only_in_band, FieldPart& to) const;

  /// A batch of what voxels hold [m], of a field that has distances.
  void values(const FieldPart& part, const PointBatch& points, const Vec3& center, double radius,
              ValueBatch& out) const noexcept;

  /// [m] to the box, negative in it.
  [[nodiscard]] double boxDistance(const Vec3& p) const noexcept;

 private:
  [[nodiscard]] double withWall(double value, const Vec3& p) const noexcept;
  [[nodiscard]] bool hasWallNear(const Vec3& center, double radius) const noexcept;

  FieldParts parts_;
  double band_;
  Box3 domain_;
  bool is_cut_;
  bool implicit_;
  bool exact_;
  double lipschitz_;
};

}  // namespace palpate::vdb
