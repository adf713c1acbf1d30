#pragma once
/// Creases inside one field: where a black box, a mesh or a baked edge folds, the gradient at a point tells
/// one of the walls that meet there. Samples a little way off tell the others (a bundle of planes).

#include <span>

#include "palpate/contact/slide.h"

namespace palpate {

/// Where the gradient of a field jumps between two points.
struct Fold {
  Vec3 at{0.0, 0.0, 0.0};      ///< [m] within `width` of the jump
  Vec3 normal{0.0, 0.0, 0.0};  ///< [-] side * gradient / |gradient| just beyond it
};

/// Looks for a fold on the straight way from `a`, where the walls `known` (unit normals) are felt, to `b`,
/// by halving down to `width` [m]. Only folds that hold a proxy count (of a min of fields, seen from
/// outside): an edge that sticks out is none, and neither is a smooth bend. False if there is none.
/// About 2 + log2(|b - a| / width) samples.
[[nodiscard]] bool findFold(const Field& field, double side, std::span<const Vec3> known,
                            const Vec3& a, const Vec3& b, double width, Fold& out) noexcept;

/// True if a wall with `normal`, met from another one by going along `way`, makes a fold that holds.
[[nodiscard]] bool isHollow(const Vec3& from, const Vec3& normal, const Vec3& way) noexcept;

/// The unit direction along the wall with `normals[own]` away from all others: where to ask the field for that
/// wall alone. Zero if there is none.
[[nodiscard]] Vec3 probeDirection(std::span<const Vec3> normals, std::size_t own) noexcept;

/// The wall of `field` that is met `reach` [m] from `x` along `probe`: value, gradient and Hessian carried
/// back to `x`. The Hessian is taken from further on, where no difference straddles the fold. False
/// out of band or where the gradient vanishes.
[[nodiscard]] bool wallBeside(const Field& field, double side, const Vec3& x, const Vec3& probe,
                              double reach, HeldWall& out) noexcept;

/// By how much the field at `x` itself is further beyond its walls than `lowest`, the least side * value that
/// wallBeside() carried back from its walls (<= 0). At a fold of smooth walls that is rounding; at the tip of a
/// cone, whose walls bend without bound, it is what the walls are off by, and is added to all of them.
[[nodiscard]] double misfit(const Field& field, double side, const Vec3& x, double lowest) noexcept;

/// pullBack() for walls of which some have a `probe`: each is asked for beside the point, closer as the point
/// comes near, and the field at the point itself is never beyond its tolerance in the end. `length` [m] is
/// how far `x` was moved along the crease since the walls were felt. False if it did not come within the
/// tolerances.
[[nodiscard]] bool pullBackToCrease(Vec3& x, std::span<const HeldWall> walls, double length,
                                    bool& began_free) noexcept;

}  // namespace palpate
