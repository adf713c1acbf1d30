#include "bake/curved.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <unordered_map>
#include <utility>

#include "bake/edges.h"
#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

/// [voxels] A patch is flat if no control point is farther than this from its facet.
constexpr double kFlat = 1e-4;
/// Memory for a triangle and its share of everything else, while it is cut and while it is baked.
constexpr std::uint64_t kBytesPerTriangle = 300;

/// A side's control points: near where it begins and near where it ends.
using Inner = std::array<Vec3, 2>;

class Patches {
 public:
  Patches(const Solid& solid, double crease) : solid_(solid), sides_(solid.triangles.size()) {
    const std::vector<Side> edges = sortedSides(solid.triangles);
    findNormals(edges, std::cos(crease));
    forEachEdge(edges, [&](std::size_t begin, std::size_t end) { bend(edges, begin, end); });
  }

  [[nodiscard]] bool isFlat(std::size_t triangle) const {
    for (std::size_t n = 0; n < 3; ++n) {
      const Inner straight = straightSide(cornerOf(triangle, n), cornerOf(triangle, n + 1));
      for (std::size_t end = 0; end < 2; ++end) {
        if (glm::distance(sides_[triangle][n][end], straight[end]) > kFlat) return false;
      }
    }
    return true;
  }

  /// `at`: barycentric coordinates.
  [[nodiscard]] Vec3 point(std::size_t triangle, const Vec3& at) const {
    const auto& s = sides_[triangle];
    const Vec3& a = cornerOf(triangle, 0);
    const Vec3& b = cornerOf(triangle, 1);
    const Vec3& c = cornerOf(triangle, 2);
    const Vec3 edge = (s[0][0] + s[0][1] + s[1][0] + s[1][1] + s[2][0] + s[2][1]) / 6.0;
    const Vec3 middle = 1.5 * edge - (a + b + c) / 6.0;
    const double u = at.x;
    const double v = at.y;
    const double w = at.z;
    return u * u * u * a + v * v * v * b + w * w * w * c +
           3.0 * (u * u * v * s[0][0] + u * v * v * s[0][1] + v * v * w * s[1][0] +
                  v * w * w * s[1][1] + w * w * u * s[2][0] + w * u * u * s[2][1]) +
           6.0 * u * v * w * middle;
  }

 private:
  [[nodiscard]] const Vec3& cornerOf(std::size_t triangle, std::size_t n) const {
    return solid_.vertices[solid_.triangles[triangle][n % 3]];
  }

  static Inner straightSide(const Vec3& from, const Vec3& to) {
    return {(2.0 * from + to) / 3.0, (from + 2.0 * to) / 3.0};
  }

  /// The corner of its triangle at which a side begins.
  [[nodiscard]] std::size_t placeOf(const Side& side) const {
    const Triangle& t = solid_.triangles[side.triangle];
    const std::uint32_t from = side.upwards ? side.low : side.high;
    return static_cast<std::size_t>(std::find(t.begin(), t.end(), from) - t.begin());
  }

  [[nodiscard]] Vec3 facing(std::size_t triangle) const {
    const Vec3& a = cornerOf(triangle, 0);
    return unitOr(glm::cross(cornerOf(triangle, 1) - a, cornerOf(triangle, 2) - a), Vec3(0.0));
  }

  /// Normals are means over the corners that meet in a vertex without a crease between them.
  void findNormals(const std::vector<Side>& edges, double crease_cosine) {
    const std::size_t count = solid_.triangles.size();
    std::vector<std::size_t> parent(3 * count);
    std::iota(parent.begin(), parent.end(), std::size_t{0});
    const auto root = [&](std::size_t n) {
      while (parent[n] != n) n = parent[n] = parent[parent[n]];
      return n;
    };
    forEachEdge(edges, [&](std::size_t begin, std::size_t end) {
      if (end - begin != 2 || edges[begin].upwards == edges[begin + 1].upwards) return;
      const Side& a = edges[begin];
      const Side& b = edges[begin + 1];
      if (!(glm::dot(facing(a.triangle), facing(b.triangle)) > crease_cosine)) return;
      // Each of the two sides begins where the other ends.
      const std::size_t at_a = placeOf(a);
      const std::size_t at_b = placeOf(b);
      parent[root(std::size_t{3} * a.triangle + at_a)] =
          root(std::size_t{3} * b.triangle + (at_b + 1) % 3);
      parent[root(std::size_t{3} * b.triangle + at_b)] =
          root(std::size_t{3} * a.triangle + (at_a + 1) % 3);
    });
    std::vector<Vec3> sums(3 * count, Vec3(0.0));
    for (std::size_t t = 0; t < count; ++t) {
      for (std::size_t n = 0; n < 3; ++n) {
        const Vec3 to = cornerOf(t, n + 1) - cornerOf(t, n);
        const Vec3 back = cornerOf(t, n + 2) - cornerOf(t, n);
        const double squares = glm::dot(to, to) * glm::dot(back, back);
        if (squares > 0.0) sums[root(3 * t + n)] += glm::cross(to, back) / squares;
      }
    }
    normals_.resize(3 * count);
    for (std::size_t n = 0; n < normals_.size(); ++n) {
      normals_[n] = unitOr(sums[root(n)], facing(n / 3));
    }
  }

  void bend(const std::vector<Side>& edges, std::size_t begin, std::size_t end) {
    const Side& first = edges[begin];
    const Side& second = edges[end - 1];
    const Vec3& low = solid_.vertices[first.low];
    const Vec3& high = solid_.vertices[first.high];
    Inner inner = straightSide(low, high);
    // An edge of three triangles has no smooth surface to follow.
    if (end - begin <= 2) {
      inner[0] = low + way(first, second, true, high - low) / 3.0;
      inner[1] = high + way(first, second, false, low - high) / 3.0;
    }
    for (std::size_t n = begin; n < end; ++n) {
      const Side& side = edges[n];
      sides_[side.triangle][placeOf(side)] = side.upwards ? inner : Inner{inner[1], inner[0]};
    }
  }

  /// Tangent of the boundary curve at one end of an edge; `along` leads from there to the other
  /// end.
  [[nodiscard]] Vec3 way(const Side& first, const Side& second, bool from_low,
                         const Vec3& along) const {
    const auto normal = [&](const Side& side) {
      const std::size_t begin = placeOf(side);
      return normals_[std::size_t{3} * side.triangle +
                      (side.upwards == from_low ? begin : (begin + 1) % 3)];
    };
    const Vec3 a = normal(first);
    const Vec3 b = normal(second);
    const Vec3 line = glm::cross(a, b);
    const double length = glm::length(line);
    Vec3 result = along;
    if (length > 0.05) {
      result = glm::dot(along, line) / (length * length) * line;
    } else if (glm::dot(a, b) > 0.0) {
      const Vec3 mean = unitOr(a + b, a);
      result = along - glm::dot(along, mean) * mean;
    }
    // A surface that leaves its facet steeply is not smooth there: the side stays straight.
    const double length_of_side = glm::length(along);
    const double cosine = glm::length(result) / length_of_side;
    if (!(cosine > 0.5 && length_of_side > 0.0)) return along;
    // With this length the cubic follows an arc of a circle up to an error of sixth order.
    return 2.0 / ((1.0 + cosine) * cosine) * result;
  }

  const Solid& solid_;
  std::vector<std::array<Inner, 3>> sides_;
  std::vector<Vec3> normals_;  ///< of each corner of each triangle
};

/// Part of a patch.
struct Piece {
  Triangle corners;
  std::uint32_t patch;
  std::array<Vec3, 3> at;  ///< its corners, in barycentric coordinates of the patch
};

class Cutter {
 public:
  Cutter(Solid& solid, const Patches& patches, double side, std::uint64_t max_memory)
      : solid_(solid), patches_(patches), side_(side), max_memory_(max_memory) {
    pieces_.reserve(solid.triangles.size());
    for (std::uint32_t t = 0; t < solid.triangles.size(); ++t) {
      pieces_.push_back({solid.triangles[t], t, {Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(0, 0, 1)}});
      flat_.push_back(patches.isFlat(t));
    }
  }

  [[nodiscard]] std::vector<Piece> run() {
    constexpr int kMostRounds = 24;
    for (int round = 0; round < kMostRounds; ++round) {
      middles_.clear();
      for (const Piece& piece : pieces_) halve(piece);
      if (middles_.empty()) break;
      std::vector<Piece> before;
      before.swap(pieces_);
      const std::size_t more = before.size() + 2 * middles_.size();
      if (more * kBytesPerTriangle > max_memory_) {
        throw Error(ErrorKind::kOperation, {"bake.memory",
                                            "smooth facets of this mesh need more than " +
                                                std::to_string(more) + " triangles",
                                            "use larger voxels, or leave the facets as they are"});
      }
      pieces_.reserve(more);
      for (const Piece& piece : before) cut(piece);
    }
    return std::move(pieces_);
  }

 private:
  static std::uint64_t nameOf(std::uint32_t a, std::uint32_t b) {
    return std::uint64_t{std::min(a, b)} << 32 | std::max(a, b);
  }

  /// Gives the long sides of a curved piece a vertex in their middle.
  void halve(const Piece& piece) {
    if (flat_[piece.patch]) return;
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t a = piece.corners[n];
      const std::uint32_t b = piece.corners[(n + 1) % 3];
      if (!(glm::distance(solid_.vertices[a], solid_.vertices[b]) > side_)) continue;
      const auto [entry, is_new] =
          middles_.try_emplace(nameOf(a, b), static_cast<std::uint32_t>(solid_.vertices.size()));
      if (!is_new) continue;
      const Vec3 at = 0.5 * (piece.at[n] + piece.at[(n + 1) % 3]);
      solid_.vertices.push_back(patches_.point(piece.patch, at));
    }
  }

  void cut(const Piece& piece) {
    // The corners, then the middles of the sides that begin at them.
    constexpr std::uint32_t kNone = 0xffffffffU;
    std::array<std::uint32_t, 6> v{};
    std::array<Vec3, 6> at{};
    std::size_t count = 0;
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t next = (n + 1) % 3;
      v[n] = piece.corners[n];
      at[n] = piece.at[n];
      const auto middle = middles_.find(nameOf(piece.corners[n], piece.corners[next]));
      v[3 + n] = middle == middles_.end() ? kNone : middle->second;
      at[3 + n] = 0.5 * (piece.at[n] + piece.at[next]);
      count += v[3 + n] == kNone ? 0 : 1;
    }
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
      pieces_.push_back({{v[a], v[b], v[c]}, piece.patch, {at[a], at[b], at[c]}});
    };
    if (count == 0) {
      pieces_.push_back(piece);
      return;
    }
    if (count == 3) {
      add(0, 3, 5);
      add(3, 1, 4);
      add(5, 4, 2);
      add(3, 4, 5);
      return;
    }
    for (std::size_t n = 0; n < 3; ++n) {
      const std::size_t next = (n + 1) % 3;
      const std::size_t last = (n + 2) % 3;
      if (count == 1 && v[3 + n] != kNone) {
        add(n, 3 + n, last);
        add(3 + n, next, last);
        return;
      }
      if (count == 2 && v[3 + n] == kNone) {
        // The two halved sides meet in `last`. Besides the corner there, a quadrangle is left,
        // which is cut along its shorter diagonal.
        add(3 + next, last, 3 + last);
        const auto length = [&](std::size_t a, std::size_t b) {
          return glm::distance(solid_.vertices[v[a]], solid_.vertices[v[b]]);
        };
        if (length(n, 3 + next) < length(next, 3 + last)) {
          add(n, next, 3 + next);
          add(n, 3 + next, 3 + last);
        } else {
          add(n, next, 3 + last);
          add(next, 3 + next, 3 + last);
        }
        return;
      }
    }
  }

  Solid& solid_;
  const Patches& patches_;
  double side_;
  std::uint64_t max_memory_;
  std::vector<Piece> pieces_;
  std::vector<bool> flat_;  ///< for each patch
  std::unordered_map<std::uint64_t, std::uint32_t> middles_;
};

}  // namespace

void makeCurved(Solid& solid, double crease, double side, std::uint64_t max_memory) {
  // Patches still refer to the corners of the original facets.
  const Solid facets = solid;
  const Patches patches(facets, crease);
  const std::vector<Piece> pieces = Cutter(solid, patches, side, max_memory).run();
  solid.triangles.clear();
  std::vector<std::uint32_t> part_of;
  for (const Piece& piece : pieces) {
    solid.triangles.push_back(piece.corners);
    if (!facets.part_of.empty()) part_of.push_back(facets.part_of[piece.patch]);
  }
  solid.part_of = std::move(part_of);
}

}  // namespace palpate::vdb
