#pragma once
/// A bounding-volume hierarchy over axis-aligned boxes: which of many things may be near a point.

#include <cstdint>
#include <span>
#include <vector>

#include "palpate/core/math.h"

namespace palpate {

/// Immutable after construction; visit() is real-time safe (its stack is fixed, the tree's depth is
/// bounded by halving). Items are numbered as in the constructor's list; empty boxes are never met,
/// infinite ones always.
class BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(std::span<const Box3> boxes);

  [[nodiscard]] bool isEmpty() const noexcept { return nodes_.empty(); }

  /// Calls f(item) for each item whose box comes within `radius` [m] of `p` [m].
  template <typename F>
  void visit(const Vec3& p, double radius, F&& f) const noexcept {
    if (nodes_.empty()) return;
    std::uint32_t stack[kMaxDepth];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!isNear(node.box, p, radius)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (isNear(boxes_[i], p, radius)) f(items_[i]);
        }
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

 private:
  static constexpr int kMaxDepth = 96;  // two a level; 2^32 items need 32 levels
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  ///< leaf: first item; inner: left child, the right one follows it
    std::uint32_t count = 0;  ///< items of a leaf; 0: inner
  };

  static bool isNear(const Box3& box, const Vec3& p, double radius) noexcept {
    const Vec3 apart = glm::max(glm::max(box.lo - p, p - box.hi), Vec3(0.0));
    return glm::dot(apart, apart) <= radius * radius;
  }
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<Box3> boxes_;  ///< in the order of items_
  std::vector<std::uint32_t> items_;
};

}  // namespace palpate
