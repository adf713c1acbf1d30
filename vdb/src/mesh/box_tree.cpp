#include "mesh/box_tree.h"

#include <algorithm>
#include <numeric>
#include <utility>

namespace palpate::vdb {

BoxTree::BoxTree(std::vector<Box3> boxes) : boxes_(std::move(boxes)), order_(boxes_.size()) {
  std::iota(order_.begin(), order_.end(), 0U);
  if (!boxes_.empty()) build(0, static_cast<std::uint32_t>(boxes_.size()));
}

std::uint32_t BoxTree::build(std::uint32_t begin, std::uint32_t end) {
  constexpr std::uint32_t kLeaf = 4;
  const auto at = static_cast<std::uint32_t>(nodes_.size());
  Node node{{}, begin, end, 0};
  Box3 centers;
  for (std::uint32_t n = begin; n < end; ++n) {
    const Box3& box = boxes_[order_[n]];
    node.box.include(box.lo);
    node.box.include(box.hi);
    centers.include(box.center());
  }
  nodes_.push_back(node);
  if (end - begin <= kLeaf) return at;
  const Vec3 size = centers.size();
  const int axis = size.x >= size.y && size.x >= size.z ? 0 : (size.y >= size.z ? 1 : 2);
  const std::uint32_t middle = begin + (end - begin) / 2;
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](std::uint32_t a, std::uint32_t b) {
                     const double first = boxes_[a].lo[axis] + boxes_[a].hi[axis];
                     const double second = boxes_[b].lo[axis] + boxes_[b].hi[axis];
                     return first != second ? first < second : a < b;
                   });
  build(begin, middle);
  const std::uint32_t right = build(middle, end);
  nodes_[at].right = right;
  return at;
}

}  // namespace palpate::vdb
