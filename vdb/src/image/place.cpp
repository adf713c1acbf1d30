#include "image/place.h"

#include <nifti2_io.h>

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

/// Ratio of a voxel's volume to that of a box with the same edges: 1 for orthogonal axes, 0 for
/// flat ones.
double solidity(const Mat3& axes) {
  const double edges = glm::length(axes[0]) * glm::length(axes[1]) * glm::length(axes[2]);
  return edges > 0.0 ? std::abs(glm::determinant(axes)) / edges : 0.0;
}

}  // namespace

Place turned(const Place& place) noexcept {
  const Vec3 sign(-1.0, -1.0, 1.0);
  Place out;
  for (int c = 0; c < 3; ++c) out.axes[c] = place.axes[c] * sign;
  out.origin = place.origin * sign;
  return out;
}

Place scaled(const Place& place, double factor) noexcept {
  return {place.axes * factor, place.origin * factor};
}

bool isUsable(const Place& place) noexcept {
  bool finite = isFinite(place.origin);
  for (int c = 0; c < 3; ++c) finite = finite && isFinite(place.axes[c]);
  return finite && solidity(place.axes) > 1e-6;
}

std::string orientationCodes(const Mat3& axes) {
  nifti_dmat44 m{};
  for (int row = 0; row < 3; ++row) {
    for (int column = 0; column < 3; ++column) m.m[row][column] = axes[column][row];
  }
  m.m[3][3] = 1.0;
  int codes[3] = {0, 0, 0};
  nifti_dmat44_to_orientation(m, &codes[0], &codes[1], &codes[2]);
  constexpr char kLetters[] = "?RLAPSI";  // indexed by NIFTI_L2R (towards R) = 1, ...
  std::string text;
  for (const int code : codes) text += code >= 1 && code <= 6 ? kLetters[code] : '?';
  return text;
}

double disagreement(const Place& a, const Place& b, const std::array<int, 3>& size) {
  const Mat3 to_index = glm::inverse(a.axes);
  double worst = 0.0;
  for (int corner = 0; corner < 8; ++corner) {
    const Vec3 index((corner & 1) != 0 ? size[0] - 1 : 0, (corner & 2) != 0 ? size[1] - 1 : 0,
                     (corner & 4) != 0 ? size[2] - 1 : 0);
    const Vec3 apart = to_index * (b.axes * index + b.origin - a.axes * index - a.origin);
    worst = std::max(worst, glm::length(apart));
  }
  return worst;
}

}  // namespace palpate::vdb
