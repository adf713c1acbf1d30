#include "scan/slices.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::vdb {
namespace {

constexpr double kThick = 1.5;
constexpr float kNone = std::numeric_limits<float>::infinity();
constexpr double kFar = 1e12;  ///< stands for infinite squares, which give no parabola

/// Computes in place, for every n, the least of squares[m] + (n - m)^2 spacing^2 over all m: the
/// lower envelope of parabolas (P. Felzenszwalb and D. Huttenlocher, 2012).
class Envelope {
 public:
  void run(std::vector<double>& squares, double spacing) {
    const auto count = static_cast<int>(squares.size());
    const double unit = spacing * spacing;
    at_.resize(squares.size());
    from_.resize(squares.size() + 1);
    int last = -1;
    for (int n = 0; n < count; ++n) {
      const double square = squares[static_cast<std::size_t>(n)];
      if (!(square < kFar)) continue;
      double begin = -kFar;
      while (last >= 0) {
        const int m = at_[static_cast<std::size_t>(last)];
        const double other = squares[static_cast<std::size_t>(m)];
        begin = 0.5 * ((square - other) / (unit * (n - m)) + n + m);
        if (begin > from_[static_cast<std::size_t>(last)]) break;
        --last;
      }
      ++last;
      at_[static_cast<std::size_t>(last)] = n;
      from_[static_cast<std::size_t>(last)] = last == 0 ? -kFar : begin;
    }
    if (last < 0) return;
    found_.resize(squares.size());
    std::size_t piece = 0;
    const auto pieces = static_cast<std::size_t>(last);
    for (int n = 0; n < count; ++n) {
      while (piece < pieces && from_[piece + 1] < n) ++piece;
      const int m = at_[piece];
      found_[static_cast<std::size_t>(n)] =
          squares[static_cast<std::size_t>(m)] + unit * (n - m) * (n - m);
    }
    squares = found_;
  }

 private:
  std::vector<int> at_;
  std::vector<double> from_;
  std::vector<double> found_;
};

}  // namespace

std::optional<SliceDistances> SliceDistances::of(const Mask& mask, const Vec3& spacing) {
  for (int axis = 0; axis < 3; ++axis) {
    if (spacing[axis] >= kThick * std::max(spacing[(axis + 1) % 3], spacing[(axis + 2) % 3])) {
      return SliceDistances(mask, spacing, axis);
    }
  }
  return std::nullopt;
}

SliceDistances::SliceDistances(const Mask& mask, const Vec3& spacing, int axis)
    : box_(mask.box), spacing_(spacing), axis_(static_cast<std::size_t>(axis)) {
  values_.resize(placeOf({0, 0, box_[2]}));
  tbb::parallel_for(0, box_[axis_], [&](int slice) { measureSlice(mask, slice); });
}

void SliceDistances::measureSlice(const Mask& mask, int slice) {
  const std::size_t u = (axis_ + 1) % 3;
  const std::size_t v = (axis_ + 2) % 3;
  const auto voxel = [&](int a, int b) {
    std::array<int, 3> at{};
    at[axis_] = slice;
    at[u] = a;
    at[v] = b;
    return at;
  };
  const auto wide = static_cast<std::size_t>(box_[u]);
  const auto high = static_cast<std::size_t>(box_[v]);
  Envelope envelope;
  std::vector<double> squares(wide * high);
  std::vector<double> line;
  for (const int side : {0, 1}) {
    // Squared distances from voxels on the other side to those on this one, along u and then along
    // v.
    for (std::size_t b = 0; b < high; ++b) {
      line.assign(wide, kFar);
      for (std::size_t a = 0; a < wide; ++a) {
        const auto at = voxel(static_cast<int>(a), static_cast<int>(b));
        if (mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] == side)
          line[a] = 0.0;
      }
      envelope.run(line, spacing_[static_cast<int>(u)]);
      std::copy(line.begin(), line.end(), squares.begin() + static_cast<std::ptrdiff_t>(b * wide));
    }
    for (std::size_t a = 0; a < wide; ++a) {
      line.resize(high);
      for (std::size_t b = 0; b < high; ++b) line[b] = squares[b * wide + a];
      envelope.run(line, spacing_[static_cast<int>(v)]);
      for (std::size_t b = 0; b < high; ++b) {
        const auto at = voxel(static_cast<int>(a), static_cast<int>(b));
        if (mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] == side) continue;
        // The outline is half a voxel before the nearest voxel of the other side.
        const double step =
            0.5 * std::min(spacing_[static_cast<int>(u)], spacing_[static_cast<int>(v)]);
        const double distance = std::sqrt(line[b]) - step;
        values_[placeOf(at)] =
            line[b] < kFar ? static_cast<float>(side == 0 ? -distance : distance) : kNone;
      }
    }
  }
}

std::optional<double> SliceDistances::distanceAt(const std::array<int, 3>& at) const noexcept {
  const auto here = static_cast<double>(values_[placeOf(at)]);
  if (!(std::abs(here) < kInfinity)) return std::nullopt;
  double change = 0.0;
  int sides = 0;
  for (const int step : {-1, 1}) {
    std::array<int, 3> next = at;
    next[axis_] += step;
    if (next[axis_] < 0 || next[axis_] >= box_[axis_]) continue;
    const auto there = static_cast<double>(values_[placeOf(next)]);
    if (!(std::abs(there) < kInfinity)) continue;
    change += step * (there - here);
    ++sides;
  }
  if (sides == 0) return std::nullopt;
  const double slope = change / (sides * spacing_[static_cast<int>(axis_)]);
  return std::abs(here) / std::sqrt(1.0 + slope * slope);
}

}  // namespace palpate::vdb
