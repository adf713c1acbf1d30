#include "palpate/contact/maxwell_branch.h"

#include <cmath>

namespace palpate {

void MaxwellBranch::step(double by, double dt, double time) noexcept {
  // stretch' = depth' - stretch / tau, with depth' constant over the tick.
  const double ticks = dt > 0.0 && time > 0.0 ? dt / time : 0.0;
  const double kept = std::exp(-ticks);
  const double share = ticks > 0.0 ? -std::expm1(-ticks) / ticks : 1.0;
  const double next = stretch_ * kept + by * share;
  stretch_ = std::isfinite(next) ? next : 0.0;
}

}  // namespace palpate
