#pragma once
/// Solids given by a function whose value is not a distance (Metric::kImplicit): only sign and zero
/// set count, and |value| / |gradient| is about the distance. All lengths in [m], in the field's
/// own frame. The constructor functions throw Error (kInput) for parameters out of range.

#include <functional>
#include <vector>

#include "palpate/export.h"
#include "palpate/fields/field.h"

namespace palpate {

/// Heart, upright along +z, `width` across its lobes along x: Taubin's sextic
/// (x^2 + 9/4 y^2 + z^2 - 1)^3 = (x^2 + 9/80 y^2) z^3, written as u - z cbrt(w) so that its
/// gradient does not vanish on the surface. The tip and the dimple, where the true surface has
/// cusps of zero width, are rounded within about a hundredth of the half width. The Lipschitz bound
/// holds everywhere. (G. Taubin, "Distance approximations for rasterizing implicit curves", 1994.)
[[nodiscard]] PALPATE_EXPORT FieldPtr heart(const Vec3& center, double width);

/// Coefficients of a polynomial of second degree in x, y, z [m] about its center. They may be given
/// in any common scale: the field is divided by its steepest slope in lipschitzDomain().
struct QuadricCoefficients {
  double xx = 0.0,        ///< of x^2
      yy = 0.0,           ///< of y^2
      zz = 0.0;           ///< of z^2
  double xy = 0.0,        ///< of x y (once, not twice)
      xz = 0.0,           ///< of x z (once)
      yz = 0.0;           ///< of y z (once)
  double x = 0.0,         ///< of x
      y = 0.0,            ///< of y
      z = 0.0;            ///< of z
  double constant = 0.0;  ///< the value at the center, in the same scale
};

/// The points where the polynomial is negative. lipschitz() is 1; it holds in the bounds grown by
/// their diagonal if the solid is an ellipsoid, else in the cube that reaches `reach` [m] from
/// `center` to each side. Throws if it can tell that there is no surface.
[[nodiscard]] PALPATE_EXPORT FieldPtr quadric(const Vec3& center,
                                              const QuadricCoefficients& coefficients,
                                              double reach = 0.5);

/// One of the two halves into which the gyroid sin X cos Y + sin Y cos Z + sin Z cos X = 0 divides
/// space, X = 2 pi x / period. It has no end: intersect it with a solid. lipschitz() is 1,
/// everywhere.
[[nodiscard]] PALPATE_EXPORT FieldPtr gyroid(const Vec3& center, double period);

/// A wall along the gyroid. It is `thickness` thick to within an eighth, and at most a fifth of
/// `period`. It is the intersection of two smooth fields, one for each face.
[[nodiscard]] PALPATE_EXPORT FieldPtr gyroidWall(const Vec3& center, double period,
                                                 double thickness);

/// How the influence of a metaball falls off with q = distance / radius; each is 1 at its center.
enum class FallOff {
  kWyvill,         ///< (1 - q^2)^3, and 0 from q = 1 on (after Wyvill, McPheeters, Wyvill 1986)
  kGaussian,       ///< exp(-q^2) (after Blinn 1982)
  kInverseSquare,  ///< 1 / (1 + q^2)
};

/// One ball of a metaball field.
struct Metaball {
  Vec3 center{0.0, 0.0, 0.0};  ///< [m]
  double radius = 0.0;         ///< [m] of influence, not of a surface
  double strength = 1.0;       ///< [-] negative: makes a dent
};

/// The points where the sum of strength * fall-off is above `iso` (0 < iso). Outside bounds(), at
/// distance d from that box, the field is raised by d - w atan(d / w), w being half the smallest
/// radius, so that it has a gradient everywhere, and its first two derivatives are continuous where
/// the surface touches the box. The Lipschitz bound holds everywhere. Only the balls that reach a
/// point are evaluated there; a Gaussian is cut off where all of them together are below rounding.
/// Throws if the balls cannot reach `iso`.
[[nodiscard]] PALPATE_EXPORT FieldPtr metaballs(std::vector<Metaball> balls, FallOff fall_off,
                                                double iso);

/// A function supplied by the caller; its gradient and Hessian are taken numerically.
struct UserFunction {
  /// Negative inside. Must not throw (that ends the program) and, in the loop, not allocate or
  /// block.
  std::function<double(const Vec3&)> value;
  Box3 bounds = Box3::everything();  ///< [m] holds every point with value <= 0
  double feature_size = 0.0;         ///< [m] steps of finite differences are small shares of it
  double lipschitz = 1.0;            ///< see Field::lipschitz()
  Box3 lipschitz_domain = Box3::everything();  ///< [m]
  Metric metric = Metric::kImplicit;  ///< kExact and kBound promise a distance, kImplicit does not
};
/// The field of `function`. @throws Error (kInput, field.*) for no function, a `feature_size` that
/// is not positive and finite, or a `lipschitz` outside 1e-12 to 1e12.
[[nodiscard]] PALPATE_EXPORT FieldPtr userField(UserFunction function);

}  // namespace palpate
