#include "image/even_slices.h"

#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate::vdb {
namespace {

/// A shift of less than this share of a voxel is rounding of the positions' digits.
constexpr double kRounding = 1e-3;

/// Bilinear in one slice, NaN outside its centers.
class SliceReader {
 public:
  SliceReader(const float* values, int columns, int rows)
      : values_(values), columns_(columns), rows_(rows) {}

  [[nodiscard]] double at(double column, double row) const noexcept {
    const Between across = between(column, columns_);
    const Between down = between(row, rows_);
    if (!across.is_inside || !down.is_inside) return std::numeric_limits<double>::quiet_NaN();
    const double near =
        mix(value(across.low, down.low), value(across.high, down.low), across.share);
    if (down.share == 0.0) return near;
    const double far =
        mix(value(across.low, down.high), value(across.high, down.high), across.share);
    return mix(near, far, down.share);
  }

  /// A share of 0 does not touch `b`, which may be NaN.
  static double mix(double a, double b, double share) noexcept {
    return share == 0.0 ? a : a + share * (b - a);
  }

 private:
  struct Between {
    int low = 0;
    int high = 0;
    double share = 0.0;
    bool is_inside = false;
  };
  static Between between(double x, int count) noexcept {
    if (std::fabs(x - std::round(x)) < kRounding) x = std::round(x);
    if (!(x >= 0.0 && x <= count - 1)) return {};
    const int low = static_cast<int>(x);
    return {low, std::min(low + 1, count - 1), x - low, true};
  }
  [[nodiscard]] double value(int column, int row) const noexcept {
    return values_[static_cast<std::size_t>(column) +
                   static_cast<std::size_t>(columns_) * static_cast<std::size_t>(row)];
  }

  const float* values_;
  int columns_;
  int rows_;
};

/// The first and the last voxel that any slice reaches; slices are shifted by `least` to `most`.
std::array<int, 2> reach(double least, double most, int count) {
  return {static_cast<int>(std::floor(least + kRounding)),
          static_cast<int>(std::ceil(most - kRounding)) + count - 1};
}

}  // namespace

EvenSlices evenSlices(const std::vector<SlicePlace>& slices, double usual_gap, int columns,
                      int rows, const Place& place) {
  const auto by_column = [](const SlicePlace& a, const SlicePlace& b) {
    return a.column < b.column;
  };
  const auto by_row = [](const SlicePlace& a, const SlicePlace& b) { return a.row < b.row; };
  const auto [left, right] = std::minmax_element(slices.begin(), slices.end(), by_column);
  const auto [top, bottom] = std::minmax_element(slices.begin(), slices.end(), by_row);
  const std::array across = reach(left->column, right->column, columns);
  const std::array down = reach(top->row, bottom->row, rows);
  const double height = slices.back().height - slices.front().height;
  const int steps = std::max(1, static_cast<int>(std::lround(height / usual_gap)));

  EvenSlices out;
  out.size = {across[1] - across[0] + 1, down[1] - down[0] + 1, steps + 1};
  out.step = height / steps;
  out.first_column = across[0];
  out.first_row = down[0];
  out.place = place;
  out.place.axes[2] = out.step * place.axes[2];
  out.place.origin += place.axes[0] * static_cast<double>(across[0]) +
                      place.axes[1] * static_cast<double>(down[0]) +
                      place.axes[2] * slices.front().height;
  return out;
}

std::vector<float> resampled(const EvenSlices& even, const std::vector<SlicePlace>& slices,
                             int columns, int rows, const std::vector<float>& values) {
  const auto slice_size = static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows);
  const auto width = static_cast<std::size_t>(even.size[0]);
  const auto new_size = width * static_cast<std::size_t>(even.size[1]);
  std::vector<float> out(new_size * static_cast<std::size_t>(even.size[2]));
  tbb::parallel_for(0, even.size[2], [&](int k) {
    const double height = slices.front().height + k * even.step;
    const auto above =
        std::upper_bound(slices.begin() + 1, slices.end() - 1, height,
                         [](double h, const SlicePlace& slice) { return h < slice.height; });
    const auto high = static_cast<std::size_t>(above - slices.begin());
    const std::size_t low = high - 1;
    const double gap = slices[high].height - slices[low].height;
    double share = std::clamp((height - slices[low].height) / gap, 0.0, 1.0);
    if (share < kRounding) share = 0.0;
    if (share > 1.0 - kRounding) share = 1.0;
    const SliceReader below(values.data() + low * slice_size, columns, rows);
    const SliceReader over(values.data() + high * slice_size, columns, rows);
    const auto at = [&](const SliceReader& slice, std::size_t which, int i, int j) {
      return slice.at(i + even.first_column - slices[which].column,
                      j + even.first_row - slices[which].row);
    };
    float* to = out.data() + static_cast<std::size_t>(k) * new_size;
    for (int j = 0; j < even.size[1]; ++j) {
      for (int i = 0; i < even.size[0]; ++i) {
        const double value =
            share == 1.0 ? at(over, high, i, j)
                         : SliceReader::mix(at(below, low, i, j),
                                            share == 0.0 ? 0.0 : at(over, high, i, j), share);
        *to++ = static_cast<float>(value);
      }
    }
  });
  return out;
}

std::optional<double> linearError(const std::vector<SlicePlace>& slices, std::size_t slice_size,
                                  const std::vector<float>& values) {
  // Two slices count as being as far apart as the widest gap if their distance is from kLeast to
  // kMost times the widest gap.
  constexpr double kLeast = 0.95;
  constexpr double kMost = 1.3;
  double widest = 0.0;
  for (std::size_t k = 1; k < slices.size(); ++k) {
    widest = std::max(widest, slices[k].height - slices[k - 1].height);
  }
  double sum = 0.0;
  std::size_t count = 0;
  for (std::size_t low = 0; low + 2 < slices.size(); ++low) {
    std::size_t high = low + 2;
    const auto gap = [&] { return slices[high].height - slices[low].height; };
    while (high + 1 < slices.size() && gap() < kLeast * widest) ++high;
    if (gap() < kLeast * widest) break;
    if (gap() > kMost * widest) continue;
    for (std::size_t k = low + 1; k < high; ++k) {
      const double share = (slices[k].height - slices[low].height) / gap();
      const float* below = values.data() + low * slice_size;
      const float* own = values.data() + k * slice_size;
      const float* above = values.data() + high * slice_size;
      for (std::size_t n = 0; n < slice_size; ++n) {
        const double off = own[n] - (below[n] + share * (above[n] - below[n]));
        if (!std::isfinite(off)) continue;
        sum += off * off;
        ++count;
      }
    }
  }
  if (count == 0) return std::nullopt;
  return std::sqrt(sum / static_cast<double>(count));
}

}  // namespace palpate::vdb
