#include "survey/label_runs.h"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <numeric>

namespace palpate::vdb {
namespace {

/// Disjoint sets that are merged in pairs; the smaller number becomes the root, so that a piece is
/// named by its first run.
class Sets {
 public:
  explicit Sets(std::size_t count) : leader_(count) {
    std::iota(leader_.begin(), leader_.end(), std::uint32_t{0});
  }
  std::uint32_t leaderOf(std::uint32_t one) noexcept {
    while (leader_[one] != one) {
      leader_[one] = leader_[leader_[one]];
      one = leader_[one];
    }
    return one;
  }
  void join(std::uint32_t a, std::uint32_t b) noexcept {
    a = leaderOf(a);
    b = leaderOf(b);
    if (a < b) {
      leader_[b] = a;
    } else {
      leader_[a] = b;
    }
  }

 private:
  std::vector<std::uint32_t> leader_;
};

}  // namespace

LabelRuns::LabelRuns(std::array<int, 3> size, const std::function<void(int, int, Number*)>& fill)
    : size_(size) {
  const auto slabs = static_cast<std::size_t>(size[2]);
  const auto rows_of_slab = static_cast<std::size_t>(size[1]);
  std::vector<std::vector<Run>> runs(slabs);
  row_at_.assign(slabs * rows_of_slab + 1, 0);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, slabs),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      std::vector<Number> row(static_cast<std::size_t>(size[0]));
                      for (std::size_t k = range.begin(); k != range.end(); ++k) {
                        for (std::size_t j = 0; j < rows_of_slab; ++j) {
                          fill(static_cast<int>(j), static_cast<int>(k), row.data());
                          const std::size_t before = runs[k].size();
                          for (std::size_t i = 0; i < row.size(); ++i) {
                            if (i > 0 && row[i] == row[i - 1]) continue;
                            runs[k].push_back({static_cast<int>(i), row[i]});
                          }
                          row_at_[k * rows_of_slab + j + 1] = runs[k].size() - before;
                        }
                      }
                    });
  std::partial_sum(row_at_.begin(), row_at_.end(), row_at_.begin());
  runs_.reserve(row_at_.back());
  for (std::vector<Run>& slab : runs) {
    runs_.insert(runs_.end(), slab.begin(), slab.end());
    slab = {};
  }
}

void LabelRuns::findPieces(const std::function<bool(Number)>& is_open) {
  Sets sets(runs_.size());
  const auto [nx, ny, nz] = size_;
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const std::size_t row = rowOf(j, k);
      const auto join = [&](std::size_t a, std::size_t b, int faces) {
        if (runs_[a].number != runs_[b].number) return;
        if (faces > 0 || is_open(runs_[a].number)) {
          sets.join(static_cast<std::uint32_t>(a), static_cast<std::uint32_t>(b));
        }
      };
      const auto join_open = [&](std::size_t a, std::size_t b, int) { join(a, b, 0); };
      if (j > 0) meet(row, rowOf(j - 1, k), true, join);
      if (k > 0) meet(row, rowOf(j, k - 1), true, join);
      if (j > 0 && k > 0) meet(row, rowOf(j - 1, k - 1), false, join_open);
      if (j + 1 < ny && k > 0) meet(row, rowOf(j + 1, k - 1), false, join_open);
    }
  }
  pieces_.clear();
  piece_of_.assign(runs_.size(), 0);
  for (int k = 0; k < nz; ++k) {
    for (int j = 0; j < ny; ++j) {
      const bool border_row = j == 0 || k == 0 || j + 1 == ny || k + 1 == nz;
      const std::size_t row = rowOf(j, k);
      for (std::size_t r = row_at_[row]; r < row_at_[row + 1]; ++r) {
        const std::uint32_t leader = sets.leaderOf(static_cast<std::uint32_t>(r));
        if (leader == r) {
          piece_of_[r] = static_cast<std::uint32_t>(pieces_.size());
          pieces_.push_back(
              {runs_[r].number, 0,
               row * static_cast<std::size_t>(nx) + static_cast<std::size_t>(runs_[r].first),
               false});
        } else {
          piece_of_[r] = piece_of_[leader];
        }
        Piece& piece = pieces_[piece_of_[r]];
        const int end = endOf(r, row);
        piece.voxels += static_cast<std::uint64_t>(end - runs_[r].first);
        piece.at_border = piece.at_border || border_row || runs_[r].first == 0 || end == nx;
      }
    }
  }
}

}  // namespace palpate::vdb
