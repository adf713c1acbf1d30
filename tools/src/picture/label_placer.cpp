#include "picture/label_placer.h"

#include <algorithm>
#include <cmath>

namespace palpate::tools {
namespace {

constexpr int kCell = 4;          // [pixels]
constexpr double kMargin = 5.0;   // [pixels] around a label
constexpr double kCrowded = 160;  // [pixels] how far a label may move away to find empty space
constexpr double kTooNear = 26;   // [pixels] least length of a leader

int cells(double pixels) { return static_cast<int>(std::ceil((pixels + 2.0 * kMargin) / kCell)); }

}  // namespace

LabelPlacer::LabelPlacer(const Section& section)
    : columns_(section.width / kCell), rows_(section.height / kCell) {
  const auto count = static_cast<std::size_t>(columns_) * static_cast<std::size_t>(rows_);
  region_.resize(count);
  depth_.resize(count);
  busy_.resize(count, false);
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      region_[index(x, y)] = section.at(x * kCell + kCell / 2, y * kCell + kCell / 2);
    }
  }
  measureDepth();
}

void LabelPlacer::measureDepth() {
  // Two sweeps of a chamfer distance: within a few percent of the true one.
  constexpr float kDiagonal = 1.4F;
  const auto relax = [&](int x, int y, int dx, int dy, float length) {
    const int nx = x + dx;
    const int ny = y + dy;
    float& here = depth_[index(x, y)];
    if (nx < 0 || ny < 0 || nx >= columns_ || ny >= rows_ ||
        region_[index(nx, ny)] != region_[index(x, y)]) {
      here = std::min(here, 0.5F * length);
    } else {
      here = std::min(here, depth_[index(nx, ny)] + length);
    }
  };
  std::fill(depth_.begin(), depth_.end(), 1e9F);
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      relax(x, y, -1, 0, 1.0F);
      relax(x, y, 0, -1, 1.0F);
      relax(x, y, -1, -1, kDiagonal);
      relax(x, y, 1, -1, kDiagonal);
    }
  }
  for (int y = rows_ - 1; y >= 0; --y) {
    for (int x = columns_ - 1; x >= 0; --x) {
      relax(x, y, 1, 0, 1.0F);
      relax(x, y, 0, 1, 1.0F);
      relax(x, y, 1, 1, kDiagonal);
      relax(x, y, -1, 1, kDiagonal);
    }
  }
}

void LabelPlacer::markBusy(const std::vector<Pixel>& line) {
  for (std::size_t i = 0; i + 1 < line.size(); ++i) {
    const double length = std::hypot(line[i + 1].x - line[i].x, line[i + 1].y - line[i].y);
    const int steps = std::clamp(static_cast<int>(length / kCell) + 1, 1, 10000);
    for (int s = 0; s <= steps; ++s) {
      const double share = static_cast<double>(s) / steps;
      const double x = (line[i].x + share * (line[i + 1].x - line[i].x)) / kCell;
      const double y = (line[i].y + share * (line[i + 1].y - line[i].y)) / kCell;
      if (x >= 0.0 && y >= 0.0 && x < columns_ && y < rows_) {
        busy_[index(static_cast<int>(x), static_cast<int>(y))] = true;
      }
    }
  }
}

void LabelPlacer::take(int x, int y, int w, int h) {
  for (int j = y; j < y + h; ++j) {
    for (int i = x; i < x + w; ++i) busy_[index(i, j)] = true;
  }
}

template <class Counts>
std::vector<int> LabelPlacer::sums(Counts counts) const {
  const std::size_t stride = static_cast<std::size_t>(columns_) + 1;
  std::vector<int> table(stride * (static_cast<std::size_t>(rows_) + 1), 0);
  for (int y = 0; y < rows_; ++y) {
    int row = 0;
    for (int x = 0; x < columns_; ++x) {
      row += counts(index(x, y)) ? 1 : 0;
      const auto at = static_cast<std::size_t>(y + 1) * stride + static_cast<std::size_t>(x + 1);
      table[at] = table[at - stride] + row;
    }
  }
  return table;
}

int LabelPlacer::sum(const std::vector<int>& table, int x, int y, int w, int h) const {
  const auto at = [&](int i, int j) {
    return table[static_cast<std::size_t>(j) * static_cast<std::size_t>(columns_ + 1) +
                 static_cast<std::size_t>(i)];
  };
  return at(x + w, y + h) - at(x, y + h) - at(x + w, y) + at(x, y);
}

std::optional<Pixel> LabelPlacer::placeInside(RegionId region, double width, double height) {
  const int w = cells(width);
  const int h = cells(height);
  const std::vector<int> free =
      sums([&](std::size_t i) { return region_[i] == region && !busy_[i]; });
  float best = 0.0F;
  int best_x = -1;
  int best_y = -1;
  for (int y = 0; y + h <= rows_; ++y) {
    for (int x = 0; x + w <= columns_; ++x) {
      const float depth = depth_[index(x + w / 2, y + h / 2)];
      if (depth > best && sum(free, x, y, w, h) == w * h) {
        best = depth;
        best_x = x;
        best_y = y;
      }
    }
  }
  if (best_x < 0) return {};
  take(best_x, best_y, w, h);
  return Pixel{(best_x + 0.5 * w) * kCell, (best_y + 0.5 * h) * kCell};
}

std::optional<Pixel> LabelPlacer::placeNear(const Pixel& anchor, double width, double height) {
  const int w = cells(width);
  const int h = cells(height);
  const std::vector<int> taken = sums([&](std::size_t i) { return busy_[i]; });
  const std::vector<int> empty = sums([&](std::size_t i) { return region_[i] == kOutside; });
  double best = kInfinity;
  int best_x = -1;
  int best_y = -1;
  for (int y = 0; y + h <= rows_; ++y) {
    for (int x = 0; x + w <= columns_; ++x) {
      if (sum(taken, x, y, w, h) > 0) continue;
      // Distance from the anchor to the nearest edge of the label.
      const double dx = std::max({x * kCell - anchor.x, anchor.x - (x + w) * kCell, 0.0});
      const double dy = std::max({y * kCell - anchor.y, anchor.y - (y + h) * kCell, 0.0});
      double cost = std::hypot(dx, dy);
      if (cost < kTooNear) continue;
      if (sum(empty, x, y, w, h) < w * h) cost += kCrowded;
      if (cost < best) {
        best = cost;
        best_x = x;
        best_y = y;
      }
    }
  }
  if (best_x < 0) return {};
  take(best_x, best_y, w, h);
  return Pixel{(best_x + 0.5 * w) * kCell, (best_y + 0.5 * h) * kCell};
}

std::optional<Pixel> LabelPlacer::innermost(RegionId region) const {
  float best = 0.0F;
  std::optional<Pixel> at;
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      if (region_[index(x, y)] != region || depth_[index(x, y)] <= best) continue;
      best = depth_[index(x, y)];
      at = Pixel{(x + 0.5) * kCell, (y + 0.5) * kCell};
    }
  }
  return at;
}

}  // namespace palpate::tools
