#include "convex_leaf.h"

#include <cmath>

namespace palpate {
namespace {

constexpr int kPlaces = 400;
/// Relative to the curvature of a field: a curvature of the other sign that is smaller than this is
/// rounding.
constexpr double kRounding = 1e-7;

/// Element `index` of van der Corput's sequence in [0, 1), whose elements are spread evenly (Halton
/// 1960).
double spread(int index, int base) {
  double out = 0.0;
  double digit = 1.0;
  for (; index > 0; index /= base) {
    digit /= base;
    out += digit * (index % base);
  }
  return out;
}

/// Positive semidefinite by Sylvester's criterion: no principal minor is negative.
bool isNowhereNegative(const Mat3& m) {
  const double size = std::sqrt(glm::dot(m[0], m[0]) + glm::dot(m[1], m[1]) + glm::dot(m[2], m[2]));
  const double least = -kRounding * size;
  for (int i = 0; i < 3; ++i) {
    const int k = (i + 1) % 3;
    if (m[i][i] < least) return false;
    if (m[i][i] * m[k][k] - m[i][k] * m[i][k] < least * size) return false;
  }
  return glm::determinant(m) >= least * size * size;
}

}  // namespace

bool isConvex(const Field& field, const Box3& around) {
  for (int i = 1; i <= kPlaces; ++i) {
    const Vec3 share(spread(i, 2), spread(i, 3), spread(i, 5));
    const FieldJet jet = field.jet(around.lo + share * around.size());
    if (!jet.in_band || !isNowhereNegative(jet.hessian)) return false;
  }
  return true;
}

}  // namespace palpate
