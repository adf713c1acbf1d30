// Finds the gaps that cannot be reached from outside: a flood fill over the gaps between a column's
// spans.
#include <algorithm>
#include <cmath>
#include <numeric>

#include "bake/columns.h"

namespace palpate::vdb {
namespace {

/// Number of integers from `lo` to `hi`. An end that is an integer is a wall on a voxel; whether
/// that voxel counts does not matter here.
std::size_t voxelsBetween(double lo, double hi) {
  const double count = std::floor(hi) - std::ceil(lo) + 1.0;
  return count > 0.0 ? static_cast<std::size_t>(count) : 0;
}

class Groups {
 public:
  explicit Groups(std::size_t count) : parent_(count) {
    std::iota(parent_.begin(), parent_.end(), std::size_t{0});
  }
  std::size_t root(std::size_t n) {
    while (parent_[n] != n) n = parent_[n] = parent_[parent_[n]];
    return n;
  }
  void join(std::size_t a, std::size_t b) {
    parent_[std::max(root(a), root(b))] = std::min(root(a), root(b));
  }

 private:
  std::vector<std::size_t> parent_;
};

}  // namespace

void Columns::flood(MeshSign sign) {
  // Gap n lies before span n and is group n + 1. The gap before each column's first span, the one
  // after its last span, and columns without spans are all outside, which is group 0.
  Groups groups(spans_.size() + 1);
  const std::size_t none = columns_.size() - 1;
  const auto is_first = [&](std::size_t column, std::size_t n) {
    return n == columns_[column].first;
  };
  const auto begin = [&](std::size_t column, std::size_t n) {
    return is_first(column, n) ? -kInfinity : spans_[n - 1].end;
  };
  const auto meet = [&](std::size_t column, std::size_t other) {
    for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
      if (is_first(column, n)) continue;
      if (other == none) {
        groups.join(n + 1, 0);
        continue;
      }
      const double lo = begin(column, n);
      const double hi = spans_[n].begin;
      const std::size_t last = columns_[other + 1].first;
      for (std::size_t m = columns_[other].first; m < last; ++m) {
        if (begin(other, m) < hi && lo < spans_[m].begin) {
          groups.join(n + 1, is_first(other, m) ? 0 : m + 1);
        }
      }
      if (last > columns_[other].first && spans_[last - 1].end < hi) groups.join(n + 1, 0);
    }
  };
  for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
    const int x = first_x_ + static_cast<int>(row);
    for (std::size_t column = rows_[row]; column < rows_[row + 1]; ++column) {
      const std::size_t first = columns_[column].first;
      if (columns_[column + 1].first - first < 2) continue;  // no gap between spans
      const int y = columns_[column].y;
      meet(column, find(x - 1, y));
      meet(column, find(x + 1, y));
      meet(column, find(x, y - 1));
      meet(column, find(x, y + 1));
    }
  }
  std::vector<bool> cavity(spans_.size() + 1, false);
  for (std::size_t n = 0; n < spans_.size(); ++n) {
    if (spans_[n].after_cavity) cavity[groups.root(n + 1)] = true;
  }
  std::vector<std::size_t> name(spans_.size() + 1, 0);  // number of each pocket, from 1
  std::vector<bool> enclosed(spans_.size(), false);
  for (std::size_t row = 0; row + 1 < rows_.size(); ++row) {
    const double x = first_x_ + static_cast<double>(row);
    for (std::size_t column = rows_[row]; column < rows_[row + 1]; ++column) {
      for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
        const std::size_t group = groups.root(n + 1);
        if (is_first(column, n) || group == 0 || cavity[group]) continue;
        enclosed[n] = true;
        const std::size_t voxels = voxelsBetween(spans_[n - 1].end, spans_[n].begin);
        if (voxels == 0) continue;
        if (name[group] == 0) {
          pockets_.emplace_back();
          name[group] = pockets_.size();
        }
        Pocket& pocket = pockets_[name[group] - 1];
        pocket.voxels += voxels;
        pocket.box.include(Vec3(x, columns_[column].y, spans_[n - 1].end));
        pocket.box.include(Vec3(x, columns_[column].y, spans_[n].begin));
      }
    }
  }
  is_filled_ = sign == MeshSign::kFlood && !pockets_.empty();
  if (is_filled_) fill(enclosed);
}

void Columns::fill(const std::vector<bool>& enclosed) {
  std::vector<Span> joined;
  for (std::size_t column = 0; column + 1 < columns_.size(); ++column) {
    const std::size_t first = joined.size();
    for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
      if (enclosed[n] && joined.size() > first) {
        joined.back().end = spans_[n].end;
      } else {
        joined.push_back(spans_[n]);
      }
    }
    columns_[column].first = first;
  }
  columns_.back().first = joined.size();
  spans_ = std::move(joined);
  pockets_.clear();
}

}  // namespace palpate::vdb
