#include "bake/edges.h"

#include <cmath>
#include <utility>

#include "bake/radix_sort.h"

namespace palpate::vdb {

std::vector<Side> sortedSides(const std::vector<Triangle>& triangles) {
  std::vector<Side> sides;
  sides.reserve(3 * triangles.size());
  for (std::uint32_t t = 0; t < triangles.size(); ++t) {
    for (std::size_t n = 0; n < 3; ++n) {
      const std::uint32_t from = triangles[t][n];
      const std::uint32_t to = triangles[t][(n + 1) % 3];
      sides.push_back({std::min(from, to), std::max(from, to), t, from < to});
    }
  }
  // Sides come triangle by triangle, and a stable sort keeps that order where corners are the same.
  std::uint32_t most = 0;
  for (const Side& side : sides) most = std::max(most, side.high);
  const int bits = bitsFor(most);
  radixSort(sides, 2 * bits,
            [&](const Side& side) { return std::uint64_t{side.low} << bits | side.high; });
  return sides;
}

std::vector<bool> turnAlike(const std::vector<Vec3>& vertices, const std::vector<Side>& sides,
                            std::vector<Triangle>& triangles) {
  constexpr std::uint32_t kNone = 0xffffffffU;
  struct Neighbor {
    std::uint32_t triangle = kNone;
    bool agrees = true;
  };
  // Each triangle has three sides, so that three entries are enough.
  std::vector<std::array<Neighbor, 3>> neighbors(triangles.size());
  const auto add = [&](std::uint32_t to, std::uint32_t triangle, bool agrees) {
    for (Neighbor& place : neighbors[to]) {
      if (place.triangle != kNone) continue;
      place = {triangle, agrees};
      return;
    }
  };
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    if (end - begin != 2) return;
    const Side& a = sides[begin];
    const Side& b = sides[begin + 1];
    add(a.triangle, b.triangle, a.upwards != b.upwards);
    add(b.triangle, a.triangle, a.upwards != b.upwards);
  });
  enum class Turn : std::uint8_t { kUnseen, kKept, kTurned };
  std::vector<Turn> turns(triangles.size(), Turn::kUnseen);
  std::vector<bool> result(triangles.size(), false);
  std::vector<std::uint32_t> patch;
  for (std::uint32_t first = 0; first < triangles.size(); ++first) {
    if (turns[first] != Turn::kUnseen) continue;
    turns[first] = Turn::kKept;
    patch.assign(1, first);
    double kept = 0.0;
    double turned = 0.0;
    for (std::size_t n = 0; n < patch.size(); ++n) {
      const Turn here = turns[patch[n]];
      (here == Turn::kKept ? kept : turned) += areaOf(vertices, triangles[patch[n]]);
      for (const Neighbor& next : neighbors[patch[n]]) {
        if (next.triangle == kNone || turns[next.triangle] != Turn::kUnseen) continue;
        const bool same = next.agrees == (here == Turn::kKept);
        turns[next.triangle] = same ? Turn::kKept : Turn::kTurned;
        patch.push_back(next.triangle);
      }
    }
    const Turn wrong = kept >= turned ? Turn::kTurned : Turn::kKept;
    for (const std::uint32_t t : patch) {
      if (turns[t] != wrong) continue;
      std::swap(triangles[t][1], triangles[t][2]);
      result[t] = true;
    }
  }
  return result;
}

}  // namespace palpate::vdb
