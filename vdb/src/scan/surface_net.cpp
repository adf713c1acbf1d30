#include "scan/surface_net.h"

#include <algorithm>
#include <array>
#include <cstdint>

#include "palpate/core/error.h"

namespace palpate::vdb {
namespace {

// Corner c of a cell is at (c & 1, c >> 1 & 1, c >> 2 & 1). Edge 4 a + n runs along axis a from the
// n-th corner whose bit a is 0; n counts the other two bits, the lower axis first.

constexpr int lowCorner(int edge) {
  const int axis = edge / 4;
  const int u = axis == 0 ? 1 : 0;
  const int v = axis == 2 ? 1 : 2;
  return ((edge & 1) << u) | ((edge >> 1 & 1) << v);
}

constexpr int edgeBetween(int a, int b) {
  const int low = std::min(a, b);
  const int axis = (a ^ b) == 1 ? 0 : (a ^ b) == 2 ? 1 : 2;
  const int u = axis == 0 ? 1 : 0;
  const int v = axis == 2 ? 1 : 2;
  return 4 * axis + (low >> u & 1) + 2 * (low >> v & 1);
}

/// How the crossed edges of one cell fall into sheets.
struct CellCase {
  std::uint8_t sheets = 0;
  std::array<std::int16_t, 12> sheet_of_edge{};  ///< -1: not crossed
};

CellCase makeCase(unsigned inside) {
  std::array<int, 12> group{};
  for (int e = 0; e < 12; ++e) {
    const int low = lowCorner(e);
    const int high = low | (1 << (e / 4));
    group[static_cast<std::size_t>(e)] = (inside >> low & 1U) != (inside >> high & 1U) ? e : -1;
  }
  const auto join = [&](int a, int b) {
    const int from = group[static_cast<std::size_t>(a)];
    const int to = group[static_cast<std::size_t>(b)];
    for (int& g : group) g = g == from ? to : g;
  };
  for (int axis = 0; axis < 3; ++axis) {
    const int u = 1 << ((axis + 1) % 3);
    const int v = 1 << ((axis + 2) % 3);
    for (const int side : {0, 1 << axis}) {
      const int ring[4] = {side, side | u, side | u | v, side | v};
      const auto is_in = [&](int n) { return (inside >> ring[n & 3] & 1U) != 0; };
      const auto edge = [&](int n) { return edgeBetween(ring[n & 3], ring[(n + 1) & 3]); };
      const bool ambiguous = is_in(0) == is_in(2) && is_in(1) == is_in(3) && is_in(0) != is_in(1);
      if (ambiguous) {
        // The sheet goes round each inside corner by itself.
        for (int n = 0; n < 4; ++n) {
          if (is_in(n)) join(edge(n + 3), edge(n));
        }
        continue;
      }
      int seen = -1;
      for (int n = 0; n < 4; ++n) {
        if (group[static_cast<std::size_t>(edge(n))] < 0) continue;
        if (seen >= 0) join(seen, edge(n));
        seen = edge(n);
      }
    }
  }
  CellCase result;
  std::array<int, 12> number{};
  number.fill(-1);
  for (std::size_t e = 0; e < 12; ++e) {
    result.sheet_of_edge[e] = -1;
    if (group[e] < 0) continue;
    int& sheet = number[static_cast<std::size_t>(group[e])];
    if (sheet < 0) sheet = result.sheets++;
    result.sheet_of_edge[e] = static_cast<std::int16_t>(sheet);
  }
  return result;
}

const std::array<CellCase, 256>& cellCases() {
  static const auto cases = [] {
    std::array<CellCase, 256> all;
    for (unsigned c = 0; c < 256; ++c) all[c] = makeCase(c);
    return all;
  }();
  return cases;
}

class Builder {
 public:
  Builder(const Lattice& lattice, const Image& image)
      : lattice_(lattice),
        image_(image),
        points_{lattice.box[0] + 2, lattice.box[1] + 2, lattice.box[2] + 2},
        strides_{1, points_[0], static_cast<std::ptrdiff_t>(points_[0]) * points_[1]},
        flip_(glm::determinant(image.axes) < 0.0) {
    mesh_.source = image.source;
  }

  Mesh build() {
    // A cell is named by its lowest point; the last layer of points has none.
    cases_.resize(lattice_.values.size());
    first_vertex_.resize(lattice_.values.size());
    for (int k = 0; k + 1 < points_[2]; ++k) {
      for (int j = 0; j + 1 < points_[1]; ++j) {
        for (int i = 0; i + 1 < points_[0]; ++i) addVertices(i, j, k);
      }
    }
    // The outermost points are outside, so crossed edges never lie on the border of the lattice.
    for (int k = 0; k + 1 < points_[2]; ++k) {
      for (int j = 0; j + 1 < points_[1]; ++j) {
        for (int i = 0; i + 1 < points_[0]; ++i) addQuads(i, j, k);
      }
    }
    return std::move(mesh_);
  }

 private:
  [[nodiscard]] std::ptrdiff_t at(int i, int j, int k) const noexcept {
    return i + strides_[1] * j + strides_[2] * k;
  }
  [[nodiscard]] float value(std::ptrdiff_t n) const noexcept {
    return lattice_.values[static_cast<std::size_t>(n)];
  }

  void addVertices(int i, int j, int k) {
    const std::ptrdiff_t n = at(i, j, k);
    unsigned inside = 0;
    std::array<double, 8> corner{};
    for (unsigned c = 0; c < 8; ++c) {
      const float v = value(n + (c & 1U) + strides_[1] * (c >> 1U & 1U) + strides_[2] * (c >> 2U));
      corner[c] = static_cast<double>(v);
      inside |= (v < 0.0F ? 1U : 0U) << c;
    }
    cases_[static_cast<std::size_t>(n)] = static_cast<std::uint8_t>(inside);
    if (inside == 0 || inside == 255) return;
    const CellCase& cell = cellCases()[inside];
    if (mesh_.vertices.size() + cell.sheets > 0xFFFFFFFFU) {
      throw inputError("scan.too_large", "the surface has more than 2^32 points",
                       "crop or coarsen the image", image_.source);
    }
    first_vertex_[static_cast<std::size_t>(n)] = static_cast<std::uint32_t>(mesh_.vertices.size());
    std::array<Vec3, 4> sum{};
    std::array<int, 4> count{};
    for (int e = 0; e < 12; ++e) {
      const int sheet = cell.sheet_of_edge[static_cast<std::size_t>(e)];
      if (sheet < 0) continue;
      const int axis = e / 4;
      const int low = lowCorner(e);
      const double a = corner[static_cast<std::size_t>(low)];
      const double b = corner[static_cast<std::size_t>(low | (1 << axis))];
      // Kept off the lattice points, where the crossings of six edges would fall into one.
      const double t = std::clamp(a / (a - b), 0.01, 0.99);
      Vec3 crossing(low & 1, low >> 1 & 1, low >> 2 & 1);
      crossing[axis] += t;
      sum[static_cast<std::size_t>(sheet)] += crossing;
      ++count[static_cast<std::size_t>(sheet)];
    }
    // Lattice point (0, 0, 0) is the frame's, one voxel before the box.
    const Vec3 origin(i + lattice_.first[0] - 1, j + lattice_.first[1] - 1,
                      k + lattice_.first[2] - 1);
    for (std::size_t s = 0; s < cell.sheets; ++s) {
      mesh_.vertices.push_back(image_.toWorld(origin + sum[s] / static_cast<double>(count[s])));
    }
  }

  /// The vertex of the sheet that crosses edge `edge` of the cell at point `n`.
  [[nodiscard]] std::uint32_t vertex(std::ptrdiff_t n, int edge) const {
    const auto cell = static_cast<std::size_t>(n);
    const int sheet = cellCases()[cases_[cell]].sheet_of_edge[static_cast<std::size_t>(edge)];
    return first_vertex_[cell] + static_cast<std::uint32_t>(sheet);
  }

  void addQuads(int i, int j, int k) {
    const std::ptrdiff_t n = at(i, j, k);
    const unsigned inside = cases_[static_cast<std::size_t>(n)];
    if (inside == 0 || inside == 255) return;
    for (int axis = 0; axis < 3; ++axis) {
      const bool low_in = (inside & 1U) != 0;
      if (low_in == ((inside >> (1U << axis) & 1U) != 0)) continue;
      // The four cells around the edge, counter-clockwise seen against the axis.
      const int u = (axis + 1) % 3;
      const int v = (axis + 2) % 3;
      const std::ptrdiff_t du = strides_[static_cast<std::size_t>(u)];
      const std::ptrdiff_t dv = strides_[static_cast<std::size_t>(v)];
      const auto edge = [&](int up_u, int up_v) {
        const int low = (up_u << u) | (up_v << v);
        return edgeBetween(low, low | (1 << axis));
      };
      std::array<std::uint32_t, 4> quad = {vertex(n, edge(0, 0)), vertex(n - du, edge(1, 0)),
                                           vertex(n - du - dv, edge(1, 1)),
                                           vertex(n - dv, edge(0, 1))};
      if (low_in == flip_) std::swap(quad[1], quad[3]);
      const auto& p = mesh_.vertices;
      // The shorter diagonal bends less.
      const Vec3 d02 = p[quad[2]] - p[quad[0]];
      const Vec3 d13 = p[quad[3]] - p[quad[1]];
      if (glm::dot(d02, d02) <= glm::dot(d13, d13)) {
        mesh_.triangles.push_back({quad[0], quad[1], quad[2]});
        mesh_.triangles.push_back({quad[0], quad[2], quad[3]});
      } else {
        mesh_.triangles.push_back({quad[1], quad[2], quad[3]});
        mesh_.triangles.push_back({quad[1], quad[3], quad[0]});
      }
    }
  }

  const Lattice& lattice_;
  const Image& image_;
  std::array<int, 3> points_;
  std::array<std::ptrdiff_t, 3> strides_;
  bool flip_;
  std::vector<std::uint8_t> cases_;
  std::vector<std::uint32_t> first_vertex_;
  Mesh mesh_;
};

}  // namespace

Mesh surfaceNet(const Lattice& lattice, const Image& image) {
  return Builder(lattice, image).build();
}

}  // namespace palpate::vdb
