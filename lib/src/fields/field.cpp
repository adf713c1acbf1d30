#include "palpate/fields/field.h"

#include <algorithm>

namespace palpate {

void Field::values(const PointBatch& points, ValueBatch& out) const noexcept {
  for (std::size_t n = 0; n < PointBatch::kCount; ++n) out[n] = value(points[n]);
}

FieldJet Field::jet(const Vec3& p) const noexcept {
  const FieldSample here = sample(p);
  FieldJet jet{here.value, here.gradient, Mat3(0.0), here.in_band};
  if (!here.in_band) return jet;
  // 1e-5 of the feature balances the truncation error (h^2) against the rounding error (1/h) of a
  // central difference. Far from the origin the step must still be many units in the last place.
  const double reach = std::max({std::fabs(p.x), std::fabs(p.y), std::fabs(p.z)});
  const double step = std::max(1e-5 * featureSize(), 1e-9 * reach);
  Mat3 hessian(0.0);
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 ahead = p;
    Vec3 behind = p;
    ahead[axis] += step;
    behind[axis] -= step;
    FieldSample after = sample(ahead);
    FieldSample before = sample(behind);
    // At the edge of a narrow band one side has no gradient: take the one-sided difference.
    if (!after.in_band) {
      after = here;
      ahead = p;
    }
    if (!before.in_band) {
      before = here;
      behind = p;
    }
    const double span = ahead[axis] - behind[axis];  // the true difference of the rounded positions
    if (span > 0.0) hessian[axis] = (after.gradient - before.gradient) / span;
  }
  jet.hessian = 0.5 * (hessian + glm::transpose(hessian));
  return jet;
}

}  // namespace palpate
