#include "bake/triangle_bins.h"

#include <algorithm>
#include <cmath>

#include "bake/radix_sort.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;

struct Entry {
  std::uint64_t key;
  std::uint32_t triangle;
};

/// Visits the leaves about one triangle: first cubes of leaves, then smaller ones, down to single
/// leaves.
class Walk {
 public:
  Walk(const Vec3& a, const Vec3& b, const Vec3& c, double half_width, const Coord& lo,
       const std::array<int, 3>& bits, std::uint32_t triangle, std::vector<Entry>& entries)
      : half_width_(half_width),
        corner_(a),
        lo_(lo),
        bits_(bits),
        triangle_(triangle),
        entries_(entries) {
    box_ = {glm::min(glm::min(a, b), c), glm::max(glm::max(a, b), c)};
    normal_ = unitOr(glm::cross(b - a, c - a), Vec3(0.0));
    tilt_ = std::abs(normal_.x) + std::abs(normal_.y) + std::abs(normal_.z);
    const Box3 reach = box_.grownBy(half_width);
    if (largest(reach.size()) <= kMostLeaves * 8.0 - 16.0) {
      listAll(reach);
      return;
    }
    int side = 8;
    while (side < (1 << 29) && largest(reach.size()) > 3.0 * side) side *= 2;
    // Cubes reach from voxel center to voxel center: one that begins at x reaches to x + side - 1.
    const auto down = [&](double v) { return static_cast<int>(std::ceil(v)) & ~(side - 1); };
    for (int x = down(reach.lo.x - side + 1); x <= reach.hi.x; x += side) {
      for (int y = down(reach.lo.y - side + 1); y <= reach.hi.y; y += side) {
        for (int z = down(reach.lo.z - side + 1); z <= reach.hi.z; z += side) {
          visit(Coord(x, y, z), side);
        }
      }
    }
  }

 private:
  static constexpr int kMostLeaves = 6;

  /// Lists the leaves of a small triangle one by one; terms that depend on one axis only are
  /// computed once for each row of leaves.
  void listAll(const Box3& reach) {
    struct Row {
      double gap, away;
      std::uint64_t place;
    };
    std::array<std::array<Row, kMostLeaves>, 3> rows{};
    std::array<std::size_t, 3> counts{};
    const double most = half_width_ * half_width_;
    double slack = 1e-9;
    for (int axis = 0; axis < 3; ++axis) {
      slack += 1e-9 * (8.0 + std::max(std::abs(reach.lo[axis]), std::abs(reach.hi[axis])));
    }
    for (int axis = 0; axis < 3; ++axis) {
      const auto n = static_cast<std::size_t>(axis);
      const int begin = static_cast<int>(std::ceil(reach.lo[axis] - 7.0)) & ~7;
      for (int at = begin; at <= reach.hi[axis]; at += 8) {
        const double middle = at + 3.5;
        const double gap =
            std::max({box_.lo[axis] - middle - 3.5, middle - 3.5 - box_.hi[axis], slack}) - slack;
        if (gap > half_width_) continue;
        rows[n][counts[n]++] = {gap * gap, normal_[axis] * (middle - corner_[axis]),
                                static_cast<std::uint64_t>((at - lo_[axis]) >> 3)};
      }
    }
    const double by_plane = 3.5 * tilt_ + half_width_ + slack;
    for (std::size_t i = 0; i < counts[0]; ++i) {
      const Row& x = rows[0][i];
      for (std::size_t j = 0; j < counts[1]; ++j) {
        const Row& y = rows[1][j];
        const double gap = x.gap + y.gap;
        if (gap > most) continue;
        const double away = x.away + y.away;
        const std::uint64_t key = (x.place << bits_[1] | y.place) << bits_[2];
        for (std::size_t k = 0; k < counts[2]; ++k) {
          const Row& z = rows[2][k];
          if (gap + z.gap > most || std::abs(away + z.away) > by_plane) continue;
          entries_.push_back({key | z.place, triangle_});
        }
      }
    }
  }

  static double largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

  void visit(const Coord& origin, int side) {
    const double half = 0.5 * (side - 1);
    const Vec3 middle = Vec3(origin.x(), origin.y(), origin.z()) + half;
    // A relative billionth covers the rounding.
    const double slack =
        1e-9 * (1.0 + std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
    if (std::abs(glm::dot(normal_, middle - corner_)) > half * tilt_ + half_width_ + slack) return;
    const Vec3 gap =
        glm::max(glm::max(box_.lo - middle, middle - box_.hi) - (half + slack), Vec3(0.0));
    if (glm::dot(gap, gap) > half_width_ * half_width_) return;
    if (side == 8) {
      const auto place = [&](int axis) {
        return static_cast<std::uint64_t>((origin[axis] - lo_[axis]) >> 3);
      };
      entries_.push_back({(place(0) << bits_[1] | place(1)) << bits_[2] | place(2), triangle_});
      return;
    }
    const int part = side / 2;
    for (int n = 0; n < 8; ++n) {
      visit(origin.offsetBy((n >> 2) * part, ((n >> 1) & 1) * part, (n & 1) * part), part);
    }
  }

  double half_width_;
  Vec3 corner_;
  Vec3 normal_{0.0};
  double tilt_;  ///< how far a cube of half side 1 reaches along the normal
  Box3 box_;
  const Coord& lo_;
  const std::array<int, 3>& bits_;
  std::uint32_t triangle_;
  std::vector<Entry>& entries_;
};

}  // namespace

TriangleBins::TriangleBins(const std::vector<Vec3>& vertices,
                           const std::vector<std::array<std::uint32_t, 3>>& triangles,
                           const openvdb::CoordBBox& range, const BakePlan& plan,
                           const Progress& progress)
    : lo_(range.min().offsetBy(-8) & ~7) {
  for (int axis = 0; axis < 3; ++axis) {
    bits_[static_cast<std::size_t>(axis)] =
        bitsFor(static_cast<std::uint64_t>(range.max()[axis] - lo_[axis] + 16) >> 3);
  }
  // The list is divided in its order, so that each leaf's triangles stay in order too.
  constexpr std::size_t kPiece = 4096;
  std::vector<std::vector<Entry>> parts((triangles.size() + kPiece - 1) / kPiece);
  parallelWithProgress(parts.size(), progress, "bake mesh: finding the surface", 0.15, 0.2,
                       [&](std::size_t part) {
                         const std::size_t end = std::min(triangles.size(), (part + 1) * kPiece);
                         for (std::size_t t = part * kPiece; t < end; ++t) {
                           const auto& [a, b, c] = triangles[t];
                           const Walk walk(vertices[a], vertices[b], vertices[c], plan.half_width,
                                           lo_, bits_, static_cast<std::uint32_t>(t), parts[part]);
                         }
                       });
  std::vector<Entry> entries;
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  entries.reserve(count);
  for (auto& part : parts) {
    entries.insert(entries.end(), part.begin(), part.end());
    part = {};
  }
  radixSort(entries, bits_[0] + bits_[1] + bits_[2], [](const Entry& entry) { return entry.key; });
  report(progress, "bake mesh: finding the surface", 0.2);
  triangles_.reserve(entries.size());
  for (const Entry& entry : entries) {
    if (keys_.empty() || keys_.back() != entry.key) {
      keys_.push_back(entry.key);
      first_.push_back(triangles_.size());
    }
    triangles_.push_back(entry.triangle);
  }
  first_.push_back(triangles_.size());
}

Coord TriangleBins::origin(std::size_t leaf) const noexcept {
  std::uint64_t key = keys_[leaf];
  Coord origin = lo_;
  for (int axis = 2; axis >= 0; --axis) {
    const auto bits = bits_[static_cast<std::size_t>(axis)];
    origin[axis] += static_cast<int>(key & ((std::uint64_t{1} << bits) - 1)) * 8;
    key >>= bits;
  }
  return origin;
}

std::optional<std::size_t> TriangleBins::find(const Coord& voxel) const noexcept {
  std::uint64_t key = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const auto bits = bits_[static_cast<std::size_t>(axis)];
    const int place = (voxel[axis] - lo_[axis]) >> 3;
    if (place < 0 || place >> bits != 0) return {};
    key = key << bits | static_cast<std::uint64_t>(place);
  }
  const auto at = std::lower_bound(keys_.begin(), keys_.end(), key);
  if (at == keys_.end() || *at != key) return {};
  return static_cast<std::size_t>(at - keys_.begin());
}

}  // namespace palpate::vdb
