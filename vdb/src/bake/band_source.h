#pragma once
/// The values that bake() puts into a band: those of a field with distances, cut off by a box.

#include <cstdint>

#include "bake/field_parts.h"

namespace palpate::vdb {

enum class Verdict : std::uint8_t { kOutside, kInside, kKeep };

/// A field that is not exact can fall short of the distance to its own bounds, so that its band
/// would never end. Therefore values at the distance d from the bounds are raised to 2 d less the
/// band's width, until that reaches the band's width. Near the surface the field stays as smooth as
/// it is, also where its bounds touch it. A box may cut the field off. judge() also serves fields
/// whose value is not a distance (implicit_distances.h). Any number of threads may call it.
class BandSource {
 public:
  /// `domain` holds the surface, `band` is the half width; both in [m].
  BandSource(const Field& field, const Box3& domain, bool is_cut, double band);

  [[nodiscard]] const FieldParts& parts() const noexcept { return parts_; }
  [[nodiscard]] const FieldPart& whole() const noexcept { return parts_.whole(); }

  /// Whether every point within `radius` of `center` is more than the band away from the surface.
  /// If not, `to` receives the operands of `from` that matter there. The reduced field equals the
  /// original one, or, with `only_in_band`, equals it in the band only.
  [[nodiscard]] Verdict judge(const FieldPart& from, const Vec3& center, double radius,
                              bool only_in_band, FieldPart& to) const;

  /// The values [m] of a batch of voxels, of a field that has distances.
  void values(const FieldPart& part, const PointBatch& points, const Vec3& center, double radius,
              ValueBatch& out) const noexcept;

  /// [m] distance to the box, negative in it.
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
