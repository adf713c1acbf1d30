#include "bake/columns.h"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_sort.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "bake/bake_plan.h"

namespace palpate::vdb {
namespace {

/// Twice the area of a, b and (x, y) seen along z; positive if (x, y) is left of a -> b.
double leftOf(const Vec3& a, const Vec3& b, double x, double y) noexcept {
  return (b.x - a.x) * (y - a.y) - (b.y - a.y) * (x - a.x);
}

/// What a side adds to the winding number of its triangle about (x, y): whether it crosses the line
/// from there towards +x, upwards or downwards. Both triangles of an edge compute the very same
/// number, so that the sum over a closed surface is zero whatever the rounding.
int crossesUpwards(const Vec3& from, const Vec3& to, double x, double y) noexcept {
  if (from.y <= y && to.y > y) return leftOf(from, to, x, y) > 0.0 ? 1 : 0;
  if (to.y <= y && from.y > y) return leftOf(to, from, x, y) > 0.0 ? -1 : 0;
  return 0;
}

/// Height of the triangle's plane over (x, y), within the triangle's own.
double heightAt(const Vec3& a, const Vec3& b, const Vec3& c, double x, double y) noexcept {
  const double u = leftOf(b, c, x, y);
  const double v = leftOf(c, a, x, y);
  const double w = leftOf(a, b, x, y);
  const double sum = u + v + w;
  const double lo = std::min({a.z, b.z, c.z});
  const double hi = std::max({a.z, b.z, c.z});
  const double z = sum != 0.0 ? (u * a.z + v * b.z + w * c.z) / sum : lo;
  return std::clamp(z, lo, hi);
}

/// Winding numbers of the parts that are not zero on the way up a column.
class Counts {
 public:
  explicit Counts(const std::vector<int>* roles = nullptr) : roles_(roles) {}

  void add(std::uint32_t part, int entered) {
    for (auto count = counts_.begin(); count != counts_.end(); ++count) {
      if (count->first != part) continue;
      count->second += entered;
      if (count->second == 0) {
        change(part, -1);
        counts_.erase(count);
      }
      return;
    }
    counts_.emplace_back(part, entered);
    change(part, 1);
  }
  [[nodiscard]] const std::vector<std::pair<std::uint32_t, int>>& all() const { return counts_; }
  [[nodiscard]] bool isInside() const { return sum_ > 0; }
  [[nodiscard]] bool isInCavity() const { return cavities_ > 0; }
  void clear() {
    counts_.clear();
    sum_ = 0;
    cavities_ = 0;
  }

 private:
  void change(std::uint32_t part, int by) {
    if (roles_ == nullptr) return;
    sum_ += by * (*roles_)[part];
    if ((*roles_)[part] < 0) cavities_ += by;
  }

  const std::vector<int>* roles_;
  std::vector<std::pair<std::uint32_t, int>> counts_;
  int sum_ = 0;
  int cavities_ = 0;
};

int signOf(double v) { return v < 0.0 ? -1 : 1; }

}  // namespace

Columns::Columns(const Solid& solid, MeshSign sign, const Progress& progress) {
  tbb::enumerable_thread_specific<std::vector<Crossing>> parts;
  parallelWithProgress(
      solid.triangles.size(), progress, "bake mesh: telling inside from outside", 0.1, 0.15,
      [&](std::size_t t) {
        const auto& [i, j, k] = solid.triangles[t];
        const Vec3& a = solid.vertices[i];
        const Vec3& b = solid.vertices[j];
        const Vec3& c = solid.vertices[k];
        // A hair beyond the triangle's box, where rounding could still find a side to be crossed.
        constexpr double kHair = 1e-6;
        const Vec3 lo = glm::min(glm::min(a, b), c) - kHair;
        const Vec3 hi = glm::max(glm::max(a, b), c) + kHair;
        for (int x = static_cast<int>(std::ceil(lo.x)); x <= hi.x; ++x) {
          for (int y = static_cast<int>(std::ceil(lo.y)); y <= hi.y; ++y) {
            const int turns = crossesUpwards(a, b, x, y) + crossesUpwards(b, c, x, y) +
                              crossesUpwards(c, a, x, y);
            if (turns == 0) continue;
            // Seen from above counterclockwise is the upper side, by which +z leaves the solid.
            parts.local().push_back({x, y, heightAt(a, b, c, x, y), -turns, solid.part_of[t]});
          }
        }
      });
  std::vector<Crossing> crossings;
  for (auto& part : parts) crossings.insert(crossings.end(), part.begin(), part.end());
  tbb::parallel_sort(crossings.begin(), crossings.end(), [](const Crossing& a, const Crossing& b) {
    return std::tie(a.x, a.y, a.z, a.part, a.entered) < std::tie(b.x, b.y, b.z, b.part, b.entered);
  });
  findRoles(solid, crossings, sign);
  makeSpans(crossings);
  flood(sign);
}

void Columns::findRoles(const Solid& solid, const std::vector<Crossing>& crossings, MeshSign sign) {
  roles_.assign(solid.parts.size(), 1);
  if (solid.parts.size() < 2 || sign == MeshSign::kFlood) return;
  constexpr std::uint32_t kNone = 0xffffffffU;
  struct Nest {
    std::size_t crossings = 0;
    std::size_t enclosed = 0;
    std::uint32_t container = kNone;  ///< the largest of those around
  };
  std::vector<Nest> nests(solid.parts.size());
  const auto size = [&](std::uint32_t part) { return std::abs(solid.parts[part].volume); };
  Counts counts;
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
    // A larger part that a smaller one sticks out of is no cavity; the smaller one may be.
    if (size(part) > size(nest.container)) continue;
    const bool opposite = signOf(inner.volume) != signOf(outer.volume);
    const bool whole = nest.enclosed == nest.crossings;
    if (opposite) roles_[part] = -1;
    if (opposite && !whole && !doubt_) {
      doubt_ = {
          inner.place,
          "a part of it is turned the other way than the one it overlaps, and may be a hollow "
          "in it or inside out"};
    }
    if (whole && std::max(inner.minority, outer.minority) > 0.25 && !doubt_) {
      doubt_ = {inner.place,
                "a part of it lies in another, and its triangles are turned at random: it may be a "
                "cavity or solid"};
    }
  }
}

void Columns::makeSpans(const std::vector<Crossing>& crossings) {
  if (!crossings.empty()) first_x_ = crossings.front().x;
  Counts counts(&roles_);
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

std::size_t Columns::find(int x, int y) const noexcept {
  const std::size_t none = columns_.size() - 1;
  const auto row = static_cast<std::size_t>(static_cast<std::int64_t>(x) - first_x_);
  if (x < first_x_ || row + 1 >= rows_.size()) return none;
  const auto begin = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row]);
  const auto end = columns_.begin() + static_cast<std::ptrdiff_t>(rows_[row + 1]);
  const auto column = std::lower_bound(
      begin, end, y, [](const Column& candidate, int wanted) { return candidate.y < wanted; });
  if (column == end || column->y != y) return none;
  return static_cast<std::size_t>(column - columns_.begin());
}

bool Columns::isInside(int x, int y, int z) const noexcept {
  const std::size_t column = find(x, y);
  if (column + 1 == columns_.size()) return false;
  for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
    if (spans_[n].begin < z && z <= spans_[n].end) return true;
  }
  return false;
}

std::array<bool, 8> Columns::areInside(int x, int y, int z) const noexcept {
  std::array<bool, 8> inside{};
  const std::size_t column = find(x, y);
  if (column + 1 == columns_.size()) return inside;
  for (std::size_t n = columns_[column].first; n < columns_[column + 1].first; ++n) {
    for (int step = 0; step < 8; ++step) {
      if (spans_[n].begin < z + step && z + step <= spans_[n].end) {
        inside[static_cast<std::size_t>(step)] = true;
      }
    }
  }
  return inside;
}

}  // namespace palpate::vdb
