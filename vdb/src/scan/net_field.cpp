#include "scan/net_field.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate::vdb {
namespace {

/// [cell diagonals] A spline's closest point further from the net's is another place's.
constexpr double kSamePlace = 0.6;

/// Closest point of the triangle a, a + ab, a + ac to p, relative to a (C. Ericson, "Real-Time
/// Collision Detection", 2005, 5.1.5: by the Voronoi region that p lies in).
Vec3 closestOffset(const Vec3& ap, const Vec3& ab, const Vec3& ac) noexcept {
  const double d1 = glm::dot(ab, ap);
  const double d2 = glm::dot(ac, ap);
  if (d1 <= 0.0 && d2 <= 0.0) return Vec3(0.0);
  const Vec3 bp = ap - ab;
  const double d3 = glm::dot(ab, bp);
  const double d4 = glm::dot(ac, bp);
  if (d3 >= 0.0 && d4 <= d3) return ab;
  const double vc = d1 * d4 - d3 * d2;
  if (vc <= 0.0 && d1 >= 0.0 && d3 <= 0.0) return (d1 / (d1 - d3)) * ab;
  const Vec3 cp = ap - ac;
  const double d5 = glm::dot(ab, cp);
  const double d6 = glm::dot(ac, cp);
  if (d6 >= 0.0 && d5 <= d6) return ac;
  const double vb = d5 * d2 - d1 * d6;
  if (vb <= 0.0 && d2 >= 0.0 && d6 <= 0.0) return (d2 / (d2 - d6)) * ac;
  const double va = d3 * d6 - d5 * d4;
  if (va <= 0.0 && d4 - d3 >= 0.0 && d5 - d6 >= 0.0) {
    return ab + ((d4 - d3) / ((d4 - d3) + (d5 - d6))) * (ac - ab);
  }
  const double whole = 1.0 / (va + vb + vc);
  return (vb * whole) * ab + (vc * whole) * ac;
}

}  // namespace

/// The closest triangle found so far.
struct NetField::Closest {
  double distance2 = kInfinity;  ///< [m^2]
  Vec3 to_p{0.0, 0.0, 0.0};      ///< [m] from its closest point
  double side = 0.0;  ///< [-] sine of the angle between its plane and to_p; positive: outside
  std::uint32_t triangle = kNone;
};

/// Tells the nodes their triangles: first those around each triangle, then from neighbour to
/// neighbour.
class NetField::Spreader {
 public:
  Spreader(NetField& field, double limit) : f_(field), limit2_(static_cast<float>(limit * limit)) {}

  void run() {
    queued_.resize(f_.nodes_.size());
    for (std::size_t t = 0; t < f_.net_.triangles.size(); ++t) seed(static_cast<std::uint32_t>(t));
    std::vector<std::size_t> now;
    while (!next_.empty()) {
      now.swap(next_);
      next_.clear();
      for (const std::size_t n : now) queued_[n] = 0;
      for (const std::size_t n : now) tellNeighbours(n);
    }
  }

 private:
  void seed(std::uint32_t triangle) {
    Box3 box;  // in node indices
    for (const std::uint32_t v : f_.net_.triangles[triangle]) {
      box.include(f_.to_index_ * (f_.net_.vertices[v] - f_.image_.origin));
    }
    const auto [x, y, z] = f_.first_node_;
    const Vec3 lo = glm::floor(box.lo) - Vec3(x, y, z);
    const Vec3 hi = glm::ceil(box.hi) - Vec3(x, y, z);
    for (int k = static_cast<int>(lo.z); k <= static_cast<int>(hi.z); ++k) {
      for (int j = static_cast<int>(lo.y); j <= static_cast<int>(hi.y); ++j) {
        for (int i = static_cast<int>(lo.x); i <= static_cast<int>(hi.x); ++i) {
          offer(i, j, k, triangle);
        }
      }
    }
  }

  void tellNeighbours(std::size_t n) {
    const std::uint32_t triangle = f_.nodes_[n].triangle;
    const auto nx = static_cast<std::size_t>(f_.node_count_[0]);
    const auto ny = static_cast<std::size_t>(f_.node_count_[1]);
    const auto i = static_cast<int>(n % nx);
    const auto j = static_cast<int>(n / nx % ny);
    const auto k = static_cast<int>(n / nx / ny);
    offer(i - 1, j, k, triangle);
    offer(i + 1, j, k, triangle);
    offer(i, j - 1, k, triangle);
    offer(i, j + 1, k, triangle);
    offer(i, j, k - 1, triangle);
    offer(i, j, k + 1, triangle);
  }

  void offer(int i, int j, int k, std::uint32_t triangle) {
    const auto [nx, ny, nz] = f_.node_count_;
    if (i < 0 || j < 0 || k < 0 || i >= nx || j >= ny || k >= nz) return;
    const std::size_t n =
        static_cast<std::size_t>(i) +
        static_cast<std::size_t>(nx) * (static_cast<std::size_t>(j) +
                                        static_cast<std::size_t>(ny) * static_cast<std::size_t>(k));
    Node& node = f_.nodes_[n];
    if (node.triangle == triangle) return;
    const auto [x, y, z] = f_.first_node_;
    const Vec3 apart = f_.fromTriangle(triangle, f_.image_.toWorld(Vec3(i + x, j + y, k + z)));
    const auto distance2 = static_cast<float>(glm::dot(apart, apart));
    if (distance2 >= (node.triangle == kNone ? limit2_ : node.distance2)) return;
    node = {triangle, distance2};
    if (queued_[n] != 0) return;
    queued_[n] = 1;
    next_.push_back(n);
  }

  NetField& f_;
  float limit2_;
  std::vector<std::uint8_t> queued_;
  std::vector<std::size_t> next_;
};

NetField::NetField(const Mesh& net, const Lattice& lattice, const Image& image, double reach,
                   const LatticeSpline* spline)
    : net_(net),
      lattice_(lattice),
      image_(image),
      spline_(spline),
      diagonal_(
          glm::length(glm::abs(image.axes[0]) + glm::abs(image.axes[1]) + glm::abs(image.axes[2]))),
      to_index_(glm::inverse(image.axes)),
      reach_(std::max(reach, diagonal_)),
      block_(4.0 * std::cbrt(std::abs(glm::determinant(image.axes)))) {
  for (const Vec3& v : net.vertices) bounds_.include(v);
  makeFans();
  markBlocks();
  // All eight nodes around a point within reach have to know; the margin holds those off the
  // lattice.
  const double limit = reach_ + diagonal_;
  const Mat3 rows = glm::transpose(to_index_);
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const int margin = static_cast<int>(limit * glm::length(rows[axis])) + 1;
    first_node_[a] = lattice.first[a] - 1 - margin;
    node_count_[a] = lattice.box[a] + 2 + 2 * margin;
  }
  nodes_.resize(static_cast<std::size_t>(node_count_[0]) *
                static_cast<std::size_t>(node_count_[1]) *
                static_cast<std::size_t>(node_count_[2]));
  Spreader(*this, limit).run();
}

void NetField::makeFans() {
  // Counting sort: how many triangles each vertex has, where they begin, then each to its place.
  fan_begin_.assign(net_.vertices.size() + 1, 0);
  for (const auto& triangle : net_.triangles) {
    for (const std::uint32_t v : triangle) ++fan_begin_[v];
  }
  std::uint32_t total = 0;
  for (std::uint32_t& entry : fan_begin_) total += std::exchange(entry, total);
  fans_.resize(total);
  std::vector<std::uint32_t> next = fan_begin_;
  for (std::size_t t = 0; t < net_.triangles.size(); ++t) {
    for (const std::uint32_t v : net_.triangles[t]) {
      fans_[next[v]++] = static_cast<std::uint32_t>(t);
    }
  }
}

std::size_t NetField::blockIndex(const std::array<int, 3>& block) const noexcept {
  return static_cast<std::size_t>(block[0]) +
         static_cast<std::size_t>(block_count_[0]) *
             (static_cast<std::size_t>(block[1]) +
              static_cast<std::size_t>(block_count_[1]) * static_cast<std::size_t>(block[2]));
}

// Chessboard distance of each block to the next one with a vertex, in two passes. A triangle
// reaches less than a block beyond its vertices; farSample() allows for that.
void NetField::markBlocks() {
  const Vec3 size = bounds_.size();
  for (int axis = 0; axis < 3; ++axis) {
    block_count_[static_cast<std::size_t>(axis)] = static_cast<int>(size[axis] / block_) + 1;
  }
  empty_rings_.assign(blockIndex({0, 0, block_count_[2]}), 255);
  for (const Vec3& v : net_.vertices) {
    const Vec3 at = (v - bounds_.lo) / block_;
    empty_rings_[blockIndex(
        {static_cast<int>(at.x), static_cast<int>(at.y), static_cast<int>(at.z)})] = 0;
  }
  const auto relax = [&](const std::array<int, 3>& block, int direction) {
    std::uint8_t& here = empty_rings_[blockIndex(block)];
    for (int n = 0; n < 13 && here > 1; ++n) {  // the 13 neighbours that come before in this pass
      const std::array<int, 3> at = {block[0] + direction * (n % 3 - 1),
                                     block[1] + direction * (n / 3 % 3 - 1),
                                     block[2] + direction * (n / 9 - 1)};
      bool in = true;
      for (std::size_t a = 0; a < 3; ++a) in = in && at[a] >= 0 && at[a] < block_count_[a];
      if (in)
        here = static_cast<std::uint8_t>(std::min<int>(here, empty_rings_[blockIndex(at)] + 1));
    }
  };
  const auto [nx, ny, nz] = block_count_;
  for (int z = 0; z < nz; ++z) {
    for (int y = 0; y < ny; ++y) {
      for (int x = 0; x < nx; ++x) relax({x, y, z}, 1);
    }
  }
  for (int z = nz; z-- > 0;) {
    for (int y = ny; y-- > 0;) {
      for (int x = nx; x-- > 0;) relax({x, y, z}, -1);
    }
  }
}

Vec3 NetField::fromTriangle(std::uint32_t triangle, const Vec3& p) const noexcept {
  const auto& [a, b, c] = net_.triangles[triangle];
  const Vec3& corner = net_.vertices[a];
  const Vec3 ap = p - corner;
  return ap - closestOffset(ap, net_.vertices[b] - corner, net_.vertices[c] - corner);
}

void NetField::lookAt(std::uint32_t triangle, const Vec3& p, Closest& best) const noexcept {
  constexpr double kSame = 1e-9;  // relative: triangles that share their closest point
  if (triangle == best.triangle) return;
  const Vec3 to_p = fromTriangle(triangle, p);
  const double distance2 = glm::dot(to_p, to_p);
  if (distance2 > best.distance2 * (1.0 + kSame)) return;
  const auto& [a, b, c] = net_.triangles[triangle];
  const Vec3& corner = net_.vertices[a];
  const Vec3 normal = glm::cross(net_.vertices[b] - corner, net_.vertices[c] - corner);
  const double scale = std::sqrt(glm::dot(normal, normal) * distance2);
  const double side = scale > 0.0 ? glm::dot(normal, to_p) / scale : 0.0;
  const bool nearer = distance2 < best.distance2 * (1.0 - kSame);
  if (nearer || std::abs(side) > std::abs(best.side)) best = {distance2, to_p, side, triangle};
}

void NetField::walk(const Vec3& p, Closest& best) const noexcept {
  for (double before = kInfinity; best.distance2 < before;) {
    before = best.distance2;
    for (const std::uint32_t v : net_.triangles[best.triangle]) {
      for (std::uint32_t f = fan_begin_[v]; f < fan_begin_[v + 1]; ++f) lookAt(fans_[f], p, best);
    }
  }
}

bool NetField::touch(std::uint32_t a, std::uint32_t b) const noexcept {
  for (const std::uint32_t v : net_.triangles[a]) {
    for (const std::uint32_t w : net_.triangles[b]) {
      if (v == w) return true;
    }
  }
  return false;
}

bool NetField::latticeInside(const Vec3& p) const noexcept {
  const Vec3 index = glm::round(to_index_ * (p - image_.origin));
  std::array<std::ptrdiff_t, 3> at{};  // in the lattice with its frame
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double place = index[axis] - lattice_.first[a];
    if (!(place >= 0.0 && place < lattice_.box[a])) return false;
    at[a] = static_cast<std::ptrdiff_t>(place) + 1;
  }
  const std::ptrdiff_t nx = lattice_.box[0] + 2;
  const std::ptrdiff_t ny = lattice_.box[1] + 2;
  return lattice_.values[static_cast<std::size_t>(at[0] + nx * (at[1] + ny * at[2]))] < 0.0F;
}

FieldSample NetField::farSample(const Vec3& p) const noexcept {
  std::array<int, 3> block{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double place = (p[axis] - bounds_.lo[axis]) / block_;
    block[a] = static_cast<int>(std::clamp(place, 0.0, block_count_[a] - 1.0));
  }
  // n empty rings: at least n - 1 blocks to the next vertex, and one less to its triangles.
  const double by_blocks = (empty_rings_[blockIndex(block)] - 2) * block_;
  const double bound = std::max({reach_, by_blocks, bounds_.distanceTo(p)});
  return {latticeInside(p) ? -bound : bound, Vec3(0.0), false};
}

FieldSample NetField::sample(const Vec3& p) const noexcept {
  const Vec3 index = to_index_ * (p - image_.origin);
  std::array<std::size_t, 3> cell{};
  for (int axis = 0; axis < 3; ++axis) {
    const auto a = static_cast<std::size_t>(axis);
    const double place = index[axis] - first_node_[a];
    if (!(place >= 0.0 && place < node_count_[a] - 1)) return farSample(p);
    cell[a] = static_cast<std::size_t>(place);
  }
  const auto nx = static_cast<std::size_t>(node_count_[0]);
  const auto ny = static_cast<std::size_t>(node_count_[1]);
  std::array<std::uint32_t, 8> starts{};
  std::size_t count = 0;
  Closest best;
  for (std::size_t corner = 0; corner < 8; ++corner) {
    const Node& node =
        nodes_[cell[0] + (corner & 1U) +
               nx * (cell[1] + (corner >> 1U & 1U) + ny * (cell[2] + (corner >> 2U)))];
    auto* const end = starts.begin() + static_cast<std::ptrdiff_t>(count);
    if (node.triangle == kNone || std::find(starts.begin(), end, node.triangle) != end) continue;
    starts[count++] = node.triangle;
    lookAt(node.triangle, p, best);
  }
  if (count == 0) return farSample(p);
  walk(p, best);
  // The walk may end in a dale; another start may lie in a deeper one. Near the surface that must
  // not be.
  for (std::size_t n = 0; n < count && best.distance2 < diagonal_ * diagonal_; ++n) {
    if (touch(starts[n], best.triangle)) continue;
    Closest other;
    lookAt(starts[n], p, other);
    walk(p, other);
    if (other.distance2 < best.distance2) best = other;
  }
  const double distance = std::sqrt(best.distance2);
  if (distance > reach_) return farSample(p);  // not all nodes around have been told
  // From one cell's diagonal on, the nearest lattice point lies on the same side, clear of the
  // surface.
  const bool inside = distance > diagonal_ ? latticeInside(p) : best.side < 0.0;
  const double sign = inside ? -1.0 : 1.0;
  if (spline_ != nullptr) {
    const auto foot = spline_->foot(p, p - best.to_p);
    // The net lies by a fraction of a voxel off the spline; more is another place.
    if (foot && glm::length(foot->point - (p - best.to_p)) < kSamePlace * diagonal_) {
      const bool clear = distance > 0.5 * diagonal_;
      const double value = clear ? sign * std::abs(foot->distance) : foot->distance;
      return {value, (clear && inside != (foot->distance < 0.0) ? -1.0 : 1.0) * foot->normal, true};
    }
  }
  return {sign * distance, unitOr(sign * best.to_p, Vec3(1.0, 0.0, 0.0)), true};
}

}  // namespace palpate::vdb
