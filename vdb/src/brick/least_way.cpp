#include "brick/least_way.h"

#include <algorithm>
#include <cmath>

#include "brick/cell_controls.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr int kCells = Brick::kSide;
constexpr double kPerSlope = 8.0;
/// [voxels] Error that rounding to floats leaves in a value.
constexpr double kRounding = 1e-4;

std::size_t cellAt(int x, int y, int z) noexcept {
  return static_cast<std::size_t>((x * kCells + y) * kCells + z);
}

/// The block of a cell along one axis, counted from the block before: 0 for cell -1, 1 for cells 0
/// to 7, 2 for cell 8.
int blockOf(int cell) noexcept { return cell < 0 ? 0 : cell < kCells ? 1 : 2; }

template <std::size_t kSide>
struct ControlValues {
  float at[kSide][kSide][kSide];
};

ControlValues<2> linearControls(const Brick& brick, int x, int y, int z) noexcept {
  ControlValues<2> c;
  for (int n = 0; n < 8; ++n) {
    c.at[n >> 2][n >> 1 & 1][n & 1] =
        brick.values[Brick::at(x + (n >> 2), y + (n >> 1 & 1), z + (n & 1))];
  }
  return c;
}

ControlValues<4> cubicControls(const cells::Controls& controls, int x, int y, int z) noexcept {
  ControlValues<4> c;
  controls.of(static_cast<std::size_t>(x), static_cast<std::size_t>(y), static_cast<std::size_t>(z),
              c.at);
  return c;
}

/// A cell's 3^3 neighborhood, with the cell itself at index 13; whether each of them answers.
struct Surroundings {
  std::array<bool, 27> known{};
  std::uint8_t steepest = 0;
  bool surface = false;
};

Surroundings surroundingsOf(const std::array<const CellBounds*, 27>& near, int x, int y,
                            int z) noexcept {
  Surroundings all;
  for (int n = 0; n < 27; ++n) {
    const int i = x + n / 9 - 1;
    const int j = y + n / 3 % 3 - 1;
    const int k = z + n % 3 - 1;
    const int block = 9 * blockOf(i) + 3 * blockOf(j) + blockOf(k);
    const CellBounds* const bounds = near[static_cast<std::size_t>(block)];
    if (bounds == nullptr) continue;
    const std::size_t cell = cellAt(i & (kCells - 1), j & (kCells - 1), k & (kCells - 1));
    if (bounds->steepest[cell] == CellBounds::kUnknown) continue;
    all.known[static_cast<std::size_t>(n)] = true;
    all.steepest = std::max(all.steepest, bounds->steepest[cell]);
    all.surface = all.surface || bounds->surface[cell];
  }
  return all;
}

/// [voxels] Least |value| on the faces, edges and corners that a cell shares with cells that
/// answer.
template <std::size_t kSide>
double leastShared(const ControlValues<kSide>& c, const std::array<bool, 27>& known) noexcept {
  constexpr int kLast = static_cast<int>(kSide) - 1;
  const auto first = [](int by) { return by > 0 ? kLast : 0; };
  const auto last = [](int by) { return by < 0 ? 0 : kLast; };
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n < 27; ++n) {
    if (n == 13 || !known[static_cast<std::size_t>(n)]) continue;
    const int by[3] = {n / 9 - 1, n / 3 % 3 - 1, n % 3 - 1};
    cells::Range range;
    for (int x = first(by[0]); x <= last(by[0]); ++x) {
      for (int y = first(by[1]); y <= last(by[1]); ++y) {
        for (int z = first(by[2]); z <= last(by[2]); ++z) range.include(c.at[x][y][z]);
      }
    }
    least = std::min(least, range.least());
  }
  return least;
}

template <std::size_t kSide>
void bound(const ControlValues<kSide>& c, std::size_t cell, CellBounds& to) noexcept {
  // Slopes of distances are at most 16.
  const double slope = std::ceil(cells::steepest(cells::slopesOf(c.at)) * kPerSlope + 1e-3);
  to.steepest[cell] = static_cast<std::uint8_t>(std::min(slope, CellBounds::kUnknown - 1.0));
  to.surface[cell] = !(cells::rangeOf(c.at).least() > 0.0);
}

/// Calls body(x, y, z) for each cell of a brick.
template <typename Body>
void forCells(const Body& body) {
  for (int x = 0; x < kCells; ++x) {
    for (int y = 0; y < kCells; ++y) {
      for (int z = 0; z < kCells; ++z) body(x, y, z);
    }
  }
}

}  // namespace

void boundCells(const Brick& brick, bool cubic, CellBounds& to) noexcept {
  cells::Controls& controls = cells::controlsOfThread();
  if (cubic) controls.take(brick);
  forCells([&](int x, int y, int z) {
    const std::size_t cell = cellAt(x, y, z);
    if (!cells::isKnown(brick, x, y, z)) {
      to.steepest[cell] = CellBounds::kUnknown;
      to.surface[cell] = false;
    } else if (cubic) {
      bound(cubicControls(controls, x, y, z), cell, to);
    } else {
      bound(linearControls(brick, x, y, z), cell, to);
    }
  });
}

LeastWay::LeastWay(const std::vector<Coord>& blocks, const std::vector<CellBounds>& bounds)
    : blocks_(blocks), bounds_(bounds) {
  index_.reserve(blocks.size());
  for (std::size_t n = 0; n < blocks.size(); ++n) index_.emplace(blocks[n], n);
}

LeastWay::Near LeastWay::around(std::size_t n) const {
  Near near{};
  for (int i = 0; i < 27; ++i) {
    const auto found = index_.find(blocks_[n].offsetBy(i / 9 - 1, i / 3 % 3 - 1, i % 3 - 1));
    if (found != index_.end()) near[static_cast<std::size_t>(i)] = &bounds_[found->second];
  }
  return near;
}

bool LeastWay::matters(std::size_t n) const {
  const CellBounds& own = bounds_[n];
  if (std::find(std::begin(own.steepest), std::end(own.steepest), CellBounds::kUnknown) ==
      std::end(own.steepest)) {
    return false;
  }
  const Near near = around(n);
  bool matters = false;
  forCells([&](int x, int y, int z) {
    if (matters || own.steepest[cellAt(x, y, z)] != CellBounds::kUnknown) return;
    matters = surroundingsOf(near, x, y, z).surface;
  });
  return matters;
}

double LeastWay::in(std::size_t n, const Brick& brick, bool cubic) const {
  const Near near = around(n);
  cells::Controls& controls = cells::controlsOfThread();
  if (cubic) controls.take(brick);
  double least = 1.0;
  forCells([&](int x, int y, int z) {
    if (bounds_[n].steepest[cellAt(x, y, z)] != CellBounds::kUnknown) return;
    const Surroundings all = surroundingsOf(near, x, y, z);
    if (!all.surface) return;
    const double value = cubic ? leastShared(cubicControls(controls, x, y, z), all.known)
                               : leastShared(linearControls(brick, x, y, z), all.known);
    least = std::min(least, std::max(0.0, value - kRounding) / (all.steepest / kPerSlope));
  });
  return least;
}

}  // namespace palpate::vdb
