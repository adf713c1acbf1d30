#pragma once
/// Which of many boxes meet another one.

#include <cstdint>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// A binary tree of boxes, halved along the longest side of their centers' box.
class BoxTree {
 public:
  explicit BoxTree(std::vector<Box3> boxes);

  [[nodiscard]] const Box3& box(std::uint32_t n) const noexcept { return boxes_[n]; }

  /// Calls visit(n) for the number of every box that has a point in common with `box`.
  template <typename Visit>
  void forEachMeeting(const Box3& box, const Visit& visit) const {
    // Halves that are equal to one make a tree of 2^32 boxes 32 deep.
    std::uint32_t stack[64];
    int depth = 0;
    if (!nodes_.empty()) stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!meet(node.box, box)) continue;
      if (node.right != 0) {
        stack[depth++] = node.right;
        stack[depth++] = static_cast<std::uint32_t>(&node - nodes_.data()) + 1;
        continue;
      }
      for (std::uint32_t n = node.begin; n < node.end; ++n) {
        if (meet(boxes_[order_[n]], box)) visit(order_[n]);
      }
    }
  }

  [[nodiscard]] static bool meet(const Box3& a, const Box3& b) noexcept {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y &&
           a.lo.z <= b.hi.z && b.lo.z <= a.hi.z;
  }

 private:
  /// Its left half follows it.
  struct Node {
    Box3 box;
    std::uint32_t begin, end;  ///< in order_
    std::uint32_t right = 0;   ///< 0: a leaf
  };

  std::uint32_t build(std::uint32_t begin, std::uint32_t end);

  std::vector<Box3> boxes_;
  std::vector<std::uint32_t> order_;
  std::vector<Node> nodes_;
};

}  // namespace palpate::vdb
