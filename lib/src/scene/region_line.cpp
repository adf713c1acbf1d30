#include "region_line.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

namespace palpate {
namespace {

constexpr std::size_t kMostCells = 10000;
/// Share of the line that is left for the rounding of places along it.
constexpr double kRounding = 1e-9;

/// Where the straight way from `from` to `to` is within `box`, as shares of the way.
std::optional<std::pair<double, double>> within(const Box3& box, const Vec3& from, const Vec3& to) {
  double enter = 0.0;
  double leave = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    const double way = to[axis] - from[axis];
    if (way == 0.0) {
      if (from[axis] < box.lo[axis] || from[axis] > box.hi[axis]) return {};
      continue;
    }
    const double a = (box.lo[axis] - from[axis]) / way;
    const double b = (box.hi[axis] - from[axis]) / way;
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (enter > leave) return {};
  return std::pair(enter, leave);
}

}  // namespace

void RegionLine::begin(const Vec3& from, const Vec3& to) {
  from_ = from;
  along_ = to - from;
  length_ = glm::length(along_);
  walls_are_found_ = false;
  walls_are_set_ = false;
  signs_.clear();
  is_changed_ = true;
  fixed_from_ = kInfinity;
  fixed_to_ = -kInfinity;
  to_ = to;
  find(false, candidates_);
}

void RegionLine::find(bool between, std::vector<Candidate>& found) const {
  found.clear();
  const Vec3 middle = 0.5 * (from_ + to_);
  const Vec3 margin(kRounding * length_);
  partition_.tree().visit(middle, 0.5 * length_ * (1.0 + 1e-6), [&](std::uint32_t item) {
    const Leaf& leaf = partition_.leaves()[item];
    if (leaf.is_between != between) return;
    Candidate candidate;
    candidate.bounds = leaf.field->bounds();
    const auto part =
        within({candidate.bounds.lo - margin, candidate.bounds.hi + margin}, from_, to_);
    if (!part) return;
    candidate.leaf = static_cast<LeafId>(item);
    candidate.field = leaf.field.get();
    // No point lies before the line's beginning or behind its end, so no limit is needed there.
    candidate.enters = part->first > 0.0 ? part->first * length_ : -kInfinity;
    candidate.leaves = part->second < 1.0 ? part->second * length_ : kInfinity;
    const Box3 domain = leaf.field->lipschitzDomain();
    if (domain.contains(from_) && domain.contains(to_)) candidate.per_slope = 1.0 / leaf.lipschitz;
    found.push_back(candidate);
  });
}

RegionId RegionLine::at(const Vec3& p) {
  const double place = glm::dot(p - from_, along_) / std::max(length_, 1e-300);
  if (!is_changed_ && place > fixed_from_ && place < fixed_to_) return region_;
  fixed_from_ = -kInfinity;
  fixed_to_ = kInfinity;
  std::size_t insides = 0;
  for (Candidate& candidate : candidates_) {
    look(candidate, p, place);
    if (signs_.inside(candidate.leaf)) ++insides;
  }
  const bool may_be_between = insides > 1;
  if (may_be_between || walls_are_set_) {
    if (!walls_are_found_) find(true, walls_);
    walls_are_found_ = true;
    for (Candidate& wall : walls_) {
      const auto& [first, second] = partition_.leaves()[wall.leaf].ends;
      if (signs_.inside(first) && signs_.inside(second)) {
        look(wall, p, place);
      } else {
        set(wall.leaf, false);
      }
    }
    walls_are_set_ = may_be_between;
  }
  if (is_changed_) region_ = regionHere();
  is_changed_ = false;
  return region_;
}

void RegionLine::look(Candidate& candidate, const Vec3& p, double place) {
  if (place < candidate.enters) {
    fixed_to_ = std::min(fixed_to_, candidate.enters);
    set(candidate.leaf, false);
    return;
  }
  if (place > candidate.leaves) {
    fixed_from_ = std::max(fixed_from_, candidate.leaves);
    set(candidate.leaf, false);
    return;
  }
  if (!(place > candidate.fixed_from && place < candidate.fixed_to)) ask(candidate, p, place);
  fixed_from_ = std::max(fixed_from_, std::max(candidate.fixed_from, candidate.enters));
  fixed_to_ = std::min(fixed_to_, std::min(candidate.fixed_to, candidate.leaves));
  set(candidate.leaf, candidate.inside);
}

void RegionLine::ask(Candidate& candidate, const Vec3& p, double place) const {
  const double value = candidate.field->value(p);
  candidate.inside = value < 0.0 && candidate.bounds.contains(p);
  // If the value is not a number, the sign is not known to be the same anywhere else.
  const double fixed = std::fabs(value) * candidate.per_slope - kRounding * length_;
  candidate.fixed_from = fixed > 0.0 ? place - fixed : kInfinity;
  candidate.fixed_to = fixed > 0.0 ? place + fixed : -kInfinity;
}

void RegionLine::set(LeafId leaf, bool inside) {
  if (inside == signs_.inside(leaf)) return;
  signs_.set(leaf, inside);
  is_changed_ = true;
}

RegionId RegionLine::regionHere() {
  inside_.clear();
  signs_.forInside([this](LeafId leaf) { inside_.push_back(leaf); });
  const auto known = cells_.find(inside_);
  if (known != cells_.end()) return known->second;
  if (cells_.size() >= kMostCells) cells_.clear();
  const RegionId region = partition_.regionOf(signs_);
  cells_.emplace(inside_, region);
  return region;
}

}  // namespace palpate
