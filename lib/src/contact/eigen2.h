#pragma once
/// Eigenvalues and eigenvectors of a symmetric 2 x 2 matrix.

#include <cmath>

#include "palpate/core/math.h"

namespace palpate {

/// Those of [[a, b], [b, c]] in the frame (t1, t2).
struct Eigen2 {
  double low, high;
  Vec3 e_low, e_high;
};

[[nodiscard]] inline Eigen2 eigen(double a, double b, double c, const Vec3& t1,
                                  const Vec3& t2) noexcept {
  const double mean = 0.5 * (a + c);
  const double half = 0.5 * (a - c);
  const double radius = std::sqrt(half * half + b * b);
  Eigen2 out{mean - radius, mean + radius, t2, t1};
  if (radius > 1e-15 * (std::fabs(mean) + radius)) {
    // The eigenvectors are the frame turned by half the angle of the vector (half, b).
    const double large = std::sqrt(0.5 * (1.0 + std::fabs(half) / radius));
    const double small = 0.5 * std::fabs(b) / (radius * large);
    const double cosine = half >= 0.0 ? large : small;
    const double sine = std::copysign(half >= 0.0 ? small : large, b);
    out.e_high = cosine * t1 + sine * t2;
    out.e_low = cosine * t2 - sine * t1;
  }
  return out;
}

}  // namespace palpate
