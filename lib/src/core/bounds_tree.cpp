#include "palpate/core/bounds_tree.h"

#include <algorithm>
#include <numeric>

namespace palpate {
namespace {

constexpr std::uint32_t kItemsPerLeaf = 4;

/// The coordinate by which boxes are sorted; infinite boxes gather in the middle.
double middle(const Box3& box, int axis) {
  const double m = 0.5 * (box.lo[axis] + box.hi[axis]);
  return std::isfinite(m) ? m : 0.0;
}

}  // namespace

BoundsTree::BoundsTree(std::span<const Box3> boxes) {
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (!boxes[i].isEmpty()) items_.push_back(static_cast<std::uint32_t>(i));
  }
  if (items_.empty()) return;
  boxes_.assign(boxes.begin(), boxes.end());  // indexed by item number while splitting
  nodes_.emplace_back();
  split(0, 0, static_cast<std::uint32_t>(items_.size()));
  std::vector<Box3> ordered;
  ordered.reserve(items_.size());
  for (const std::uint32_t item : items_) ordered.push_back(boxes_[item]);
  boxes_ = std::move(ordered);
}

void BoundsTree::split(std::uint32_t node, std::uint32_t begin, std::uint32_t end) {
  Box3 all;
  Box3 middles;
  for (std::uint32_t i = begin; i < end; ++i) {
    const Box3& box = boxes_[items_[i]];
    all = all.unitedWith(box);
    middles.include({middle(box, 0), middle(box, 1), middle(box, 2)});
  }
  nodes_[node].box = all;
  if (end - begin <= kItemsPerLeaf) {
    nodes_[node].first = begin;
    nodes_[node].count = end - begin;
    return;
  }
  const Vec3 extent = middles.size();
  const int axis =
      extent.x >= extent.y && extent.x >= extent.z ? 0 : (extent.y >= extent.z ? 1 : 2);
  // Splitting into halves by count limits the tree's depth, whatever the boxes are.
  const std::uint32_t half = begin + (end - begin) / 2;
  std::nth_element(items_.begin() + begin, items_.begin() + half, items_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double ma = middle(boxes_[a], axis);
                     const double mb = middle(boxes_[b], axis);
                     return ma != mb ? ma < mb : a < b;
                   });
  const auto left = static_cast<std::uint32_t>(nodes_.size());
  nodes_[node].first = left;
  nodes_.emplace_back();
  nodes_.emplace_back();
  split(left, begin, half);
  split(left + 1, half, end);
}

}  // namespace palpate
