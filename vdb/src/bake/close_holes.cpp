#include <cmath>
#include <unordered_map>
#include <utility>

#include "bake/edges.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kMostForLeastArea = 100;

/// Edges that lack triangles, directed as the missing triangles would run; an edge occurs once for
/// each triangle that it lacks.
using Missing = std::unordered_map<std::uint32_t, std::vector<std::uint32_t>>;

/// Splits edges into simple loops. In each vertex as many edges begin as end, so that any walk
/// comes back to a vertex it has seen; the edges walked since then are a loop.
std::vector<std::vector<std::uint32_t>> loopsOf(Missing& missing,
                                                const std::vector<std::uint32_t>& starts) {
  std::vector<std::vector<std::uint32_t>> loops;
  std::vector<std::uint32_t> walk;
  std::unordered_map<std::uint32_t, std::size_t> place;
  for (const std::uint32_t start : starts) {
    while (!missing[start].empty()) {
      walk.assign(1, start);
      place.clear();
      place[start] = 0;
      while (!walk.empty()) {
        auto& next = missing[walk.back()];
        if (next.empty()) break;
        const std::uint32_t to = next.back();
        next.pop_back();
        const auto seen = place.find(to);
        if (seen == place.end()) {
          place[to] = walk.size();
          walk.push_back(to);
          continue;
        }
        const auto begin = walk.begin() + static_cast<std::ptrdiff_t>(seen->second);
        loops.emplace_back(begin, walk.end());
        for (auto v = begin + 1; v != walk.end(); ++v) place.erase(*v);
        walk.erase(begin + 1, walk.end());
        if (walk.size() == 1) break;
      }
    }
  }
  return loops;
}

/// The triangles of least total area that span a loop, found by dynamic programming over its arcs.
std::vector<Triangle> leastLid(const std::vector<Vec3>& vertices,
                               const std::vector<std::uint32_t>& loop) {
  const std::size_t n = loop.size();
  std::vector<double> best(n * n, 0.0);
  std::vector<std::size_t> apex(n * n, 0);
  for (std::size_t span = 2; span < n; ++span) {
    for (std::size_t i = 0; i + span < n; ++i) {
      const std::size_t k = i + span;
      best[i * n + k] = kInfinity;
      for (std::size_t m = i + 1; m < k; ++m) {
        const double area =
            best[i * n + m] + best[m * n + k] + areaOf(vertices, {loop[i], loop[m], loop[k]});
        if (area < best[i * n + k]) {
          best[i * n + k] = area;
          apex[i * n + k] = m;
        }
      }
    }
  }
  std::vector<Triangle> lid;
  std::vector<std::pair<std::size_t, std::size_t>> arcs{{0, n - 1}};
  while (!arcs.empty()) {
    const auto [i, k] = arcs.back();
    arcs.pop_back();
    if (k - i < 2) continue;
    const std::size_t m = apex[i * n + k];
    lid.push_back({loop[i], loop[m], loop[k]});
    arcs.emplace_back(i, m);
    arcs.emplace_back(m, k);
  }
  return lid;
}

std::vector<Triangle> fan(std::vector<Vec3>& vertices, const std::vector<std::uint32_t>& loop) {
  // Each side counts by its length, so that many short ones do not pull the middle towards them.
  Vec3 sum(0.0);
  double length = 0.0;
  for (std::size_t n = 0; n < loop.size(); ++n) {
    const Vec3& a = vertices[loop[n]];
    const Vec3& b = vertices[loop[(n + 1) % loop.size()]];
    const double side = glm::distance(a, b);
    sum += side * 0.5 * (a + b);
    length += side;
  }
  const auto middle = static_cast<std::uint32_t>(vertices.size());
  vertices.push_back(length > 0.0 ? sum / length : vertices[loop[0]]);
  std::vector<Triangle> lid;
  for (std::size_t n = 0; n < loop.size(); ++n) {
    lid.push_back({loop[n], loop[(n + 1) % loop.size()], middle});
  }
  return lid;
}

}  // namespace

std::vector<Hole> closeHoles(std::vector<Vec3>& vertices, const std::vector<Side>& sides) {
  Missing missing;
  std::vector<std::uint32_t> starts;
  forEachEdge(sides, [&](std::size_t begin, std::size_t end) {
    int balance = 0;
    for (std::size_t n = begin; n < end; ++n) balance += sides[n].upwards ? 1 : -1;
    const std::uint32_t from = balance > 0 ? sides[begin].high : sides[begin].low;
    const std::uint32_t to = balance > 0 ? sides[begin].low : sides[begin].high;
    for (int n = 0; n < std::abs(balance); ++n) {
      missing[from].push_back(to);
      starts.push_back(from);
    }
  });
  std::vector<Hole> holes;
  for (std::vector<std::uint32_t>& loop : loopsOf(missing, starts)) {
    if (loop.size() < 3) continue;  // there and back: two lacking sides that cancel
    Hole hole;
    hole.lid = loop.size() <= kMostForLeastArea ? leastLid(vertices, loop) : fan(vertices, loop);
    for (const Triangle& t : hole.lid) hole.area += areaOf(vertices, t);
    hole.loop = std::move(loop);
    holes.push_back(std::move(hole));
  }
  return holes;
}

}  // namespace palpate::vdb
