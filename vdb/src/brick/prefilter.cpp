#include "brick/prefilter.h"

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

constexpr int kSide = Neighborhood::kSide;
constexpr int kRow = Neighborhood::kRow;
constexpr int kSlab = Neighborhood::kSlab;

/// Index in the neighborhood of the brick's first voxel, -1; its last voxel, 9, is the last but two
/// there.
constexpr int kMargin = -1 - Neighborhood::kFirst;
constexpr int kRows = Brick::kRows;
constexpr unsigned kAllOfRow = (1U << kRows) - 1U;

/// One bit for each voxel of a row of the brick, bit n for voxel n - 1.
using Flags = std::array<std::array<unsigned, kRows>, kRows>;

/// The voxels whose filter finds all its inputs in the band.
struct Reach {
  Flags near{};  ///< inputs of D
  Flags far{};   ///< inputs of D(D)
};

Flags knownOf(const Neighborhood& from) {
  Flags flags{};
  for (std::size_t x = 0; x < kRows; ++x) {
    for (std::size_t y = 0; y < kRows; ++y) {
      flags[x][y] = from.known[(x + kMargin) * kSide + y + kMargin] >> kMargin & kAllOfRow;
    }
  }
  return flags;
}

Reach reachOf(const Neighborhood& from) {
  Reach reach;
  for (int x = 0; x < kRows; ++x) {
    for (int y = 0; y < kRows; ++y) {
      const auto row = [&](int dx, int dy) -> unsigned {
        const int at = (x + kMargin + dx) * kSide + y + kMargin + dy;
        return from.known[static_cast<std::size_t>(at)];
      };
      const auto beside = [](unsigned bits) { return bits << 1 & bits >> 1; };
      const unsigned own = row(0, 0);
      const unsigned left = row(-1, 0), right = row(1, 0), below = row(0, -1), above = row(0, 1);
      const unsigned near = own & beside(own) & left & right & below & above;
      const unsigned far = near & own << 2 & own >> 2 & row(-2, 0) & row(2, 0) & row(0, -2) &
                           row(0, 2) & row(-1, -1) & row(-1, 1) & row(1, -1) & row(1, 1) &
                           beside(left) & beside(right) & beside(below) & beside(above);
      reach.near[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] =
          near >> kMargin & kAllOfRow;
      reach.far[static_cast<std::size_t>(x)][static_cast<std::size_t>(y)] =
          far >> kMargin & kAllOfRow;
    }
  }
  return reach;
}

/// Second differences along the axes, and their sum D, for one slab of voxels across x. Loops run
/// on over the ends of rows, so that they are long; the values there are not used.
struct Differences {
  alignas(64) std::array<double, kSlab> along_x, along_y, along_z, sum;
};

void difference(const Neighborhood& from, int slab, Differences& d) {
  const float* const f = from.values.data() + static_cast<std::ptrdiff_t>(slab * kSlab);
  for (int n = kRow; n < kSlab - kRow; ++n) {
    const auto i = static_cast<std::size_t>(n);
    const double twice = 2.0 * static_cast<double>(f[n]);
    const double x = static_cast<double>(f[n - kSlab]) + static_cast<double>(f[n + kSlab]) - twice;
    const double y = static_cast<double>(f[n - kRow]) + static_cast<double>(f[n + kRow]) - twice;
    const double z = static_cast<double>(f[n - 1]) + static_cast<double>(f[n + 1]) - twice;
    d.along_x[i] = x;
    d.along_y[i] = y;
    d.along_z[i] = z;
    d.sum[i] = x + y + z;
  }
}

/// The coefficients of one row, in three degrees of accuracy [units].
struct RowOfThree {
  alignas(64) std::array<double, kRows> plain, near, far;
};

/// `f` and `at` are the row's first voxel; `before`, `here` and `behind` the slabs around it.
void filterRow(const float* f, std::size_t at, const Differences& before, const Differences& here,
               const Differences& behind, RowOfThree& row) {
  for (std::size_t n = 0; n < kRows; ++n) {
    const std::size_t i = at + n;
    const double near = static_cast<double>(f[n]) - here.sum[i] / 6.0;
    const double sum = 2.0 * here.sum[i];
    const double x2 = -2.0 * here.along_x[i] + before.along_x[i] + behind.along_x[i];
    const double y2 = -2.0 * here.along_y[i] + here.along_y[i - kRow] + here.along_y[i + kRow];
    const double z2 = -2.0 * here.along_z[i] + here.along_z[i - 1] + here.along_z[i + 1];
    const double twice = before.sum[i] + behind.sum[i] + here.sum[i - kRow] + here.sum[i + kRow] +
                         here.sum[i - 1] + here.sum[i + 1] - 3.0 * sum;
    row.near[n] = near;
    row.far[n] = near + (twice / 72.0 + 11.0 / 720.0 * (x2 + y2 + z2));
  }
}

/// Coefficient of a voxel that the filter cannot reach: its value, limited to `plateau`, if it is
/// known; otherwise `plateau` with its sign.
void plainRow(const float* f, unsigned known, float plateau, double* out) {
  for (std::size_t n = 0; n < kRows; ++n) {
    const float within = std::clamp(f[n], -plateau, plateau);
    out[n] = (known >> n & 1U) != 0 ? within : std::copysign(plateau, f[n]);
  }
}

/// A cell is known if all voxels of its stencil are: those from `first` to `last`, relative to its
/// own, along each axis.
void markCells(const Flags& flags, int first, int last, Brick& brick) {
  for (int x = 0; x < Brick::kSide; ++x) {
    for (int y = 0; y < Brick::kSide; ++y) {
      unsigned rows = ~0U;
      for (int i = first; i <= last; ++i) {
        const int slab = x + i + 1;
        for (int j = first; j <= last; ++j) {
          const int row = y + j + 1;
          rows &= flags[static_cast<std::size_t>(slab)][static_cast<std::size_t>(row)];
        }
      }
      unsigned cells = ~0U;
      for (int k = first; k <= last; ++k) cells &= rows >> (k + 1);
      brick.known[x * Brick::kSide + y] = static_cast<std::uint8_t>(cells & 0xFFU);
    }
  }
}

/// Calls row(x, y, f, out) for each row of the brick: f is its first voxel in the neighborhood, out
/// its place in the brick.
template <class Row>
void forRows(const Neighborhood& from, Brick& brick, int x, const Row& row) {
  for (int y = 0; y < kRows; ++y) {
    const float* const f =
        from.values.data() + ((x + kMargin) * kSlab + (y + kMargin) * kRow + kMargin);
    float* const out = brick.values + (x * Brick::kSlab + y * Brick::kRow);
    row(static_cast<std::size_t>(y), f, out);
    out[kRows] = 0.0F;
  }
}

}  // namespace

void fillCubic(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick) {
  const double scale = 1.0 / units_per_voxel;
  const Flags known = knownOf(from);
  const Reach reach = reachOf(from);
  std::array<Differences, 3> slabs;  // the three around the present slab, used in turns
  difference(from, kMargin - 1, slabs[0]);
  difference(from, kMargin, slabs[1]);
  for (int x = 0; x < kRows; ++x) {
    const auto turn = static_cast<std::size_t>(x);
    const Differences& before = slabs[turn % 3];
    const Differences& here = slabs[(turn + 1) % 3];
    Differences& behind = slabs[(turn + 2) % 3];
    difference(from, x + kMargin + 1, behind);
    forRows(from, brick, x, [&](std::size_t y, const float* f, float* out) {
      const unsigned near = reach.near[turn][y];
      const unsigned far = reach.far[turn][y];
      RowOfThree row{};
      if (far != kAllOfRow) plainRow(f, known[turn][y], plateau, row.plain.data());
      if (near != 0) {
        filterRow(f, (y + kMargin) * kRow + kMargin, before, here, behind, row);
      }
      for (std::size_t n = 0; n < kRows; ++n) {
        double c = (near >> n & 1U) != 0 ? row.near[n] : row.plain[n];
        c = (far >> n & 1U) != 0 ? row.far[n] : c;
        out[n] = static_cast<float>(c * scale);
      }
    });
  }
  markCells(reach.near, -1, 2, brick);
}

void fillLinear(const Neighborhood& from, float plateau, double units_per_voxel, Brick& brick) {
  const double scale = 1.0 / units_per_voxel;
  const Flags known = knownOf(from);
  for (int x = 0; x < kRows; ++x) {
    const auto slab = static_cast<std::size_t>(x);
    forRows(from, brick, x, [&](std::size_t y, const float* f, float* out) {
      for (std::size_t n = 0; n < kRows; ++n) {
        const bool is_known = (known[slab][y] >> n & 1U) != 0;
        const float value = is_known ? f[n] : std::copysign(plateau, f[n]);
        out[n] = static_cast<float>(value * scale);
      }
    });
  }
  markCells(known, 0, 1, brick);
}

}  // namespace palpate::vdb
