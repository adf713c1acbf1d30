#include "bake/triangle_bins.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>

namespace palpate::vdb {
namespace {

using openvdb::Coord;

constexpr int kBits = 21;  ///< of a leaf's place along an axis
constexpr std::uint64_t kMask = (std::uint64_t{1} << kBits) - 1;

struct Entry {
  std::uint64_t key;
  std::uint32_t triangle;
  friend bool operator<(const Entry& a, const Entry& b) noexcept {
    return a.key != b.key ? a.key < b.key : a.triangle < b.triangle;
  }
};

/// The leaves about one triangle, from cubes of them down to single ones.
class Walk {
 public:
  Walk(const Vec3& a, const Vec3& b, const Vec3& c, double half_width, const Coord& lo,
       std::uint32_t triangle, std::vector<Entry>& entries)
      : half_width_(half_width), corner_(a), lo_(lo), triangle_(triangle), entries_(entries) {
    for (const Vec3& p : {a, b, c}) box_.include(p);
    normal_ = unitOr(glm::cross(b - a, c - a), Vec3(0.0));
    const Box3 reach = box_.grownBy(half_width);
    int side = 8;
    while (side < (1 << 29) && largest(reach.size()) > 3.0 * side) side *= 2;
    // From voxel centers: a cube of voxels from x on reaches to x + side - 1.
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
  static double largest(const Vec3& v) { return std::max({v.x, v.y, v.z}); }

  void visit(const Coord& origin, int side) {
    const double half = 0.5 * (side - 1);
    const Vec3 middle = Vec3(origin.x(), origin.y(), origin.z()) + half;
    const double tilt = std::abs(normal_.x) + std::abs(normal_.y) + std::abs(normal_.z);
    // A billionth covers the rounding.
    const double slack =
        1e-9 * (1.0 + std::abs(middle.x) + std::abs(middle.y) + std::abs(middle.z));
    if (std::abs(glm::dot(normal_, middle - corner_)) > half * tilt + half_width_ + slack) return;
    const Vec3 gap =
        glm::max(glm::max(box_.lo - middle, middle - box_.hi) - (half + slack), Vec3(0.0));
    if (glm::dot(gap, gap) > half_width_ * half_width_) return;
    if (side == 8) {
      const auto place = [&](int axis) {
        return static_cast<std::uint64_t>((origin[axis] - lo_[axis]) >> 3);
      };
      entries_.push_back({place(0) << (2 * kBits) | place(1) << kBits | place(2), triangle_});
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
  Box3 box_;
  const Coord& lo_;
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
    if (static_cast<std::uint64_t>(range.max()[axis] - lo_[axis] + 16) >> 3 >= kMask) {
      throw Error(ErrorKind::kOperation,
                  {"bake.too_fine",
                   "the mesh is more than 2^24 voxels of " + inMillimetres(plan.voxel) + " long",
                   "use larger voxels; also check that it has the length unit it should"});
    }
  }
  tbb::enumerable_thread_specific<std::vector<Entry>> parts;
  parallelWithProgress(triangles.size(), progress, "bake mesh: finding the surface", 0.0, 0.05,
                       [&](std::size_t t) {
                         const auto& [a, b, c] = triangles[t];
                         const Walk walk(vertices[a], vertices[b], vertices[c], plan.half_width,
                                         lo_, static_cast<std::uint32_t>(t), parts.local());
                       });
  std::vector<Entry> entries;
  std::size_t count = 0;
  for (const auto& part : parts) count += part.size();
  entries.reserve(count);
  for (auto& part : parts) {
    entries.insert(entries.end(), part.begin(), part.end());
    part = {};
  }
  tbb::parallel_sort(entries.begin(), entries.end());
  report(progress, "bake mesh: finding the surface", 0.1);
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
  const std::uint64_t key = keys_[leaf];
  return lo_.offsetBy(static_cast<int>(key >> (2 * kBits)) * 8,
                      static_cast<int>(key >> kBits & kMask) * 8,
                      static_cast<int>(key & kMask) * 8);
}

}  // namespace palpate::vdb
