#pragma once
/// softWall() for any law that has force(), tangent() and isStraight().

#include <algorithm>
#include <cmath>

#include "palpate/contact/wall_law.h"

namespace palpate {

/// As a share of the stop's stiffness: a law that is nowhere stiffer than this is used unchanged.
inline constexpr double kFollowed = 1.0 / 1.02;
inline constexpr int kMostSoftSteps = 60;

template <typename Law>
[[nodiscard]] SoftWall softWallOf(const Law& law, double stop, double give) noexcept {
  SoftWall out;
  if (!(give > 0.0)) return out;
  const double most = kFollowed * stop;
  // From depth `bend` on the law is as stiff as the stop allows; its stiffness only grows with the
  // depth.
  const auto give_at = [&](double depth) { return depth - law.force(depth) / stop; };
  double low = give;
  double high = give;
  double tangent = law.tangent(give);
  if (law.isStraight()) {
    const double own = std::min(tangent, most);
    out.depth = give * stop / (stop - own);
    out.force = own * out.depth;
    out.tangent = stop * own / (stop - own);
    return out;
  }
  // The depth is at least `give`, and give_at() grows by at least the share 1 - most / stop of it:
  // so the depth is at most `high`.
  high = give * stop / (stop - most);
  if (law.tangent(high) > most) {
    double below = 0.0;
    double above = high;
    for (int i = 0; i < kMostSoftSteps; ++i) {
      const double middle = 0.5 * (below + above);
      (law.tangent(middle) > most ? above : below) = middle;
    }
    const double bent = give_at(below);
    if (give >= bent) {
      const double further = (give - bent) * stop / (stop - most);
      out.depth = below + further;
      out.force = law.force(below) + most * further;
      out.tangent = stop * most / (stop - most);
      return out;
    }
    high = below;
  }
  double depth = std::clamp(give * stop / std::max(stop - tangent, stop - most), low, high);
  for (int i = 0; i < kMostSoftSteps; ++i) {
    const double off = give_at(depth) - give;
    (off > 0.0 ? high : low) = depth;
    tangent = law.tangent(depth);
    double next = depth - off / std::max(1.0 - tangent / stop, 1e-3);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    if (std::fabs(next - depth) <= 1e-16 * depth) break;
    depth = next;
  }
  out.depth = depth;
  out.force = law.force(depth);
  out.tangent = tangent / std::max(1.0 - tangent / stop, 1e-3);
  return out;
}

}  // namespace palpate
