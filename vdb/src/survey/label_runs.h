#pragma once
/// An image of small integers as runs of equal numbers along its rows, and the connected components
/// of these runs.

#include <algorithm>
#include <array>
#include <cstdint>
#include <functional>
#include <vector>

namespace palpate::vdb {

class LabelRuns {
 public:
  using Number = std::uint16_t;
  struct Run {
    int first = 0;  ///< its first voxel in the row; it ends where the next run begins
    Number number = 0;
  };
  struct Piece {
    Number number = 0;
    std::uint64_t voxels = 0;
    std::size_t seed = 0;  ///< its first voxel
    bool at_border = false;
  };

  /// `fill(j, k, row)` writes the numbers of a row; it is called on several threads at once.
  LabelRuns(std::array<int, 3> size, const std::function<void(int, int, Number*)>& fill);

  /// Joins runs of equal numbers to pieces: across faces, and for numbers for which is_open() is
  /// true across edges too.
  void findPieces(const std::function<bool(Number)>& is_open);

  [[nodiscard]] std::size_t count() const noexcept { return runs_.size(); }
  [[nodiscard]] const std::array<int, 3>& size() const noexcept { return size_; }
  [[nodiscard]] const std::vector<Piece>& pieces() const noexcept { return pieces_; }

  /// Calls f(piece, first voxel, voxels) for every run.
  template <class F>
  void forEachRun(F&& f) const {
    for (std::size_t row = 0; row + 1 < row_at_.size(); ++row) {
      for (std::size_t r = row_at_[row]; r < row_at_[row + 1]; ++r) {
        f(piece_of_[r],
          row * static_cast<std::size_t>(size_[0]) + static_cast<std::size_t>(runs_[r].first),
          static_cast<std::size_t>(endOf(r, row) - runs_[r].first));
      }
    }
  }

  /// Calls f(piece, piece, axis, faces) where two runs of different numbers share faces.
  template <class F>
  void forEachContact(F&& f) const {
    for (int k = 0; k < size_[2]; ++k) {
      for (int j = 0; j < size_[1]; ++j) {
        const std::size_t row = rowOf(j, k);
        for (std::size_t r = row_at_[row]; r + 1 < row_at_[row + 1]; ++r) {
          f(piece_of_[r], piece_of_[r + 1], 0, 1);
        }
        const auto between = [&](int axis) {
          return [&, axis](std::size_t a, std::size_t b, int faces) {
            if (runs_[a].number != runs_[b].number) f(piece_of_[a], piece_of_[b], axis, faces);
          };
        };
        if (j > 0) meet(row, rowOf(j - 1, k), false, between(1));
        if (k > 0) meet(row, rowOf(j, k - 1), false, between(2));
      }
    }
  }

 private:
  [[nodiscard]] std::size_t rowOf(int j, int k) const noexcept {
    return static_cast<std::size_t>(j) +
           static_cast<std::size_t>(size_[1]) * static_cast<std::size_t>(k);
  }
  [[nodiscard]] int endOf(std::size_t run, std::size_t row) const noexcept {
    return run + 1 < row_at_[row + 1] ? runs_[run + 1].first : size_[0];
  }

  /// Calls f(run of a, run of b, voxels in common) for runs that overlap; with `edges` also for
  /// runs that only touch at an end, where they share an edge.
  template <class F>
  void meet(std::size_t row_a, std::size_t row_b, bool edges, F&& f) const {
    std::size_t a = row_at_[row_a];
    std::size_t b = row_at_[row_b];
    const std::size_t last_a = row_at_[row_a + 1] - 1;
    const std::size_t last_b = row_at_[row_b + 1] - 1;
    while (true) {
      const int end_a = endOf(a, row_a);
      const int end_b = endOf(b, row_b);
      f(a, b, std::min(end_a, end_b) - std::max(runs_[a].first, runs_[b].first));
      if (a == last_a && b == last_b) return;  // both rows end at the image's border
      if (edges && end_a == end_b) {
        f(a, b + 1, 0);
        f(a + 1, b, 0);
      }
      if (end_a <= end_b) ++a;
      if (end_b <= end_a) ++b;
    }
  }

  std::array<int, 3> size_;
  std::vector<Run> runs_;
  std::vector<std::size_t> row_at_;  ///< index of each row's first run, and an end
  std::vector<std::uint32_t> piece_of_;
  std::vector<Piece> pieces_;
};

}  // namespace palpate::vdb
