#include "bake/columns.h"

#include <tbb/enumerable_thread_specific.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "bake/bake_plan.h"
#include "bake/radix_sort.h"
#include "bake/wall_count.h"

namespace palpate::vdb {
namespace {

int signOf(double v) { return v < 0.0 ? -1 : 1; }

}  // namespace

Columns::Columns(const Solid& solid, MeshSign sign, const Progress& progress) {
  tbb::enumerable_thread_specific<std::vector<Crossing>> parts;
  parallelWithProgress(solid.triangles.size(), progress, "bake mesh: telling inside from outside",
                       0.1, 0.15, [&](std::size_t t) {
                         const auto& [i, j, k] = solid.triangles[t];
                         const Vec3& a = solid.vertices[i];
                         const Vec3& b = solid.vertices[j];
                         const Vec3& c = solid.vertices[k];
                         // A hair beyond the triangle's box, where rounding could still let a side
                         // be crossed.
                         constexpr double kHair = 1e-6;
                         const Vec3 lo = glm::min(glm::min(a, b), c) - kHair;
                         const Vec3 hi = glm::max(glm::max(a, b), c) + kHair;
                         for (int x = static_cast<int>(std::ceil(lo.x)); x <= hi.x; ++x) {
                           for (int y = static_cast<int>(std::ceil(lo.y)); y <= hi.y; ++y) {
                             const WallHit hit = hitWall(a, b, c, x, y);
                             if (hit.entered == 0) continue;
                             parts.local().push_back({x, y, hit.z, hit.entered, solid.part_of[t]});
                           }
                         }
                       });
  std::vector<Crossing> crossings;
  for (auto& part : parts) crossings.insert(crossings.end(), part.begin(), part.end());
  sortCrossings(crossings);
  findRoles(solid, crossings, sign);
  makeSpans(crossings);
  flood(sign);
}

/// Sorts crossings by column, and upwards in each.
void Columns::sortCrossings(std::vector<Crossing>& crossings) {
  if (crossings.empty()) return;
  Crossing lo = crossings.front();
  Crossing hi = lo;
  for (const Crossing& c : crossings) {
    lo.x = std::min(lo.x, c.x);
    lo.y = std::min(lo.y, c.y);
    hi.x = std::max(hi.x, c.x);
    hi.y = std::max(hi.y, c.y);
  }
  const auto across = [](int from, int to) {
    return static_cast<std::uint64_t>(static_cast<std::int64_t>(to) - from);
  };
  const int bits = bitsFor(across(lo.y, hi.y));
  radixSort(crossings, bits + bitsFor(across(lo.x, hi.x)),
            [&](const Crossing& c) { return across(lo.x, c.x) << bits | across(lo.y, c.y); });
  // Threads left crossings in any order, so that within a column they are sorted by all their
  // members.
  for (auto begin = crossings.begin(); begin != crossings.end();) {
    auto end = begin;
    while (end != crossings.end() && end->x == begin->x && end->y == begin->y) ++end;
    std::sort(begin, end, [](const Crossing& a, const Crossing& b) {
      return std::tie(a.z, a.part, a.entered) < std::tie(b.z, b.part, b.entered);
    });
    begin = end;
  }
}

void Columns::findRoles(const Solid& solid, const std::vector<Crossing>& crossings, MeshSign sign) {
  roles_.assign(solid.parts.size(), 1);
  if (solid.parts.size() < 2 || sign == MeshSign::kFlood) return;
  constexpr std::uint32_t kNone = 0xffffffffU;
  struct Nest {
    std::size_t crossings = 0;
    std::size_t enclosed = 0;
    std::uint32_t container = kNone;  ///< the largest of the parts around it
  };
  std::vector<Nest> nests(solid.parts.size());
  const auto size = [&](std::uint32_t part) { return std::abs(solid.parts[part].volume); };
  WallCount counts(roles_);
  for (std::size_t n = 0; n < crossings.size(); ++n) {
    const Crossing& here = crossings[n];
    if (n == 0 || crossings[n - 1].x != here.x || crossings[n - 1].y != here.y) counts.clear();
    Nest& nest = nests[here.part];
    ++nest.crossings;
    bool enclosed = false;
    for (const auto& [part, count] : counts.all()) {
      if (part == here.part) continue;
      enclosed = true;
      const bool larger = nest.container == kNone || size(part) > size(nest.container) ||
                          (size(part) == size(nest.container) && part < nest.container);
      if (larger) nest.container = part;
    }
    nest.enclosed += enclosed ? 1 : 0;
    counts.add(here.part, here.entered);
  }
  for (std::uint32_t part = 0; part < nests.size(); ++part) {
    const Nest& nest = nests[part];
    if (nest.container == kNone) continue;
    const SolidPart& inner = solid.parts[part];
    const SolidPart& outer = solid.parts[nest.container];
    // A part is never the cavity of a smaller part, which then sticks out of it; the smaller part
    // may be a cavity of this one.
    if (size(part) > size(nest.container)) continue;
    const bool opposite = signOf(inner.volume) != signOf(outer.volume);
    const bool whole = nest.enclosed == nest.crossings;
    if (opposite) roles_[part] = -1;
    if (opposite && !whole && !doubt_) {
      doubt_ = {
          inner.place,
          "a part of it winds against the part that it overlaps, and may be a hollow in it or "
          "inside out"};
    }
    if (whole && std::max(inner.minority, outer.minority) > 0.25 && !doubt_) {
      doubt_ = {
          inner.place,
          "a part of it lies within another, and its triangles wind at random, so it may be a "
          "cavity or solid"};
    }
  }
}

void Columns::makeSpans(const std::vector<Crossing>& crossings) {
  if (!crossings.empty()) first_x_ = crossings.front().x;
  WallCount counts(roles_);
  bool in_cavity = false;
  for (std::size_t n = 0; n < crossings.size(); ++n) {
    const Crossing& here = crossings[n];
    if (n == 0 || crossings[n - 1].x != here.x || crossings[n - 1].y != here.y) {
      counts.clear();
      in_cavity = false;
      rows_.resize(static_cast<std::size_t>(here.x - first_x_) + 1, columns_.size());
      columns_.push_back({here.y, spans_.size()});
    }
    const bool before = counts.isInside();
    counts.add(here.part, here.entered);
    const bool after = counts.isInside();
    in_cavity = in_cavity || counts.isInCavity();
    if (before == after) {
      has_idle_walls_ = true;
    } else if (after) {
      spans_.push_back({here.z, here.z, in_cavity});
    } else {
      spans_.back().end = here.z;
      in_cavity = counts.isInCavity();
    }
  }
  rows_.push_back(columns_.size());
  columns_.push_back({0, spans_.size()});
}

std::pair<std::size_t, std::size_t> Columns::findFrom(int x, int y) const noexcept {
  const auto row = static_cast<std::size_t>(static_cast<std::int64_t>(x) - first_x_);
  if (x < first_x_ || row + 1 >= rows_.size()) return {0, 0};
  const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row]);
  const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row + 1]);
  const auto column = std::lower_bound(
      begin, end, y, [](const Column& candidate, int wanted) { return candidate.y < wanted; });
  return {static_cast<std::size_t>(column - columns_.begin()), rows_[row + 1]};
}

std::size_t Columns::find(int x, int y) const noexcept {
  const auto [column, end] = findFrom(x, y);
  return column != end && columns_[column].y == y ? column : columns_.size() - 1;
}

bool Columns::isInside(int x, int y, int z) const noexcept {
  const std::size_t column = find(x, y);
  if (column + 1 == columns_.size()) return false;
  for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
    if (spans_[n].begin < z && z <= spans_[n].end) return true;
  }
  return false;
}

std::array<std::uint8_t, 8> Columns::areInside(int x, int y, int z) const noexcept {
  std::array<std::uint8_t, 8> inside{};
  for (auto [column, end] = findFrom(x, y); column != end && columns_[column].y < y + 8; ++column) {
    std::uint8_t& bits = inside[static_cast<std::size_t>(columns_[column].y - y)];
    for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
      // Integers above `begin`, up to `end`.
      const double first = std::clamp(std::floor(spans_[n].begin) + 1.0 - z, 0.0, 8.0);
      const double last = std::clamp(std::floor(spans_[n].end) + 1.0 - z, 0.0, 8.0);
      const auto below = [](double count) { return (1U << static_cast<unsigned>(count)) - 1U; };
      bits = static_cast<std::uint8_t>(bits | (below(last) & ~below(first)));
    }
  }
  return inside;
}

}  // namespace palpate::vdb
