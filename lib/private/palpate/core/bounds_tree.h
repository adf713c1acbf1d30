#pragma once
/// A bounding-volume hierarchy over axis-aligned boxes: finds which of many things may be near a
/// point or meet a box.

#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/export.h"

namespace palpate {

/// Immutable after construction; visits are real-time safe (their stack is fixed, the tree's depth
/// is bounded by halving). Items are numbered as in the constructor's list; empty boxes are never
/// visited, infinite ones always.
class PALPATE_EXPORT BoundsTree {
 public:
  BoundsTree() = default;
  explicit BoundsTree(std::span<const Box3> boxes);

  [[nodiscard]] bool isEmpty() const noexcept { return nodes_.empty(); }

  /// Calls f(item) for each item whose box comes within `radius` [m] of `p` [m].
  template <typename F>
  void visit(const Vec3& p, double radius, F&& f) const noexcept {
    walk([&](const Box3& box) { return isNear(box, p, radius); }, f);
  }

  /// Whether the boxes have a point in common.
  [[nodiscard]] static bool meet(const Box3& a, const Box3& b) noexcept {
    return a.lo.x <= b.hi.x && b.lo.x <= a.hi.x && a.lo.y <= b.hi.y && b.lo.y <= a.hi.y &&
           a.lo.z <= b.hi.z && b.lo.z <= a.hi.z;
  }

  /// Calls f(item) for each item whose box has a point in common with `box` [m].
  template <typename F>
  void visitMeeting(const Box3& box, F&& f) const {
    walk([&](const Box3& each) { return meet(each, box); }, f);
  }

  /// Calls f(item) for items whose boxes come within a radius of `p`, roughly the nearest boxes
  /// first. The radius [m] shrinks as the visit goes on: it is `radius` at first, then what f
  /// returned last. A negative radius visits the boxes that contain `p`.
  template <typename F>
  void visitNearest(const Vec3& p, double radius, F&& f) const noexcept {
    if (nodes_.empty()) return;
    struct Entry {
      std::uint32_t node;
      double square;  ///< [m^2] squared distance to its box
    };
    Entry stack[kMaxDepth];
    int depth = 0;
    stack[depth++] = {0, squareTo(nodes_[0].box, p)};
    double limit = radius > 0.0 ? radius * radius : 0.0;
    while (depth > 0) {
      const Entry entry = stack[--depth];
      if (!(entry.square <= limit)) continue;
      const Node& node = nodes_[entry.node];
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (!(squareTo(boxes_[i], p) <= limit)) continue;
          const double narrowed = f(items_[i]);
          limit = narrowed > 0.0 ? narrowed * narrowed : 0.0;
        }
        continue;
      }
      Entry near{node.first, squareTo(nodes_[node.first].box, p)};
      Entry far{node.first + 1, squareTo(nodes_[node.first + 1].box, p)};
      if (far.square < near.square) std::swap(near, far);
      stack[depth++] = far;
      stack[depth++] = near;
    }
  }

 private:
  static constexpr int kMaxDepth = 96;  // two entries a level; 2^32 items need 32 levels
  struct Node {
    Box3 box;
    std::uint32_t first = 0;  ///< leaf: first item; inner: left child, the right one follows it
    std::uint32_t count = 0;  ///< items of a leaf; 0: inner
  };

  /// Calls f(item) for each item for which `is_met` returns true of its box and of all boxes around
  /// it.
  template <typename Met, typename F>
  void walk(const Met& is_met, F& f) const {
    if (nodes_.empty()) return;
    std::uint32_t stack[kMaxDepth];
    int depth = 0;
    stack[depth++] = 0;
    while (depth > 0) {
      const Node& node = nodes_[stack[--depth]];
      if (!is_met(node.box)) continue;
      if (node.count > 0) {
        for (std::uint32_t i = node.first; i < node.first + node.count; ++i) {
          if (is_met(boxes_[i])) f(items_[i]);
        }
      } else {
        stack[depth++] = node.first;
        stack[depth++] = node.first + 1;
      }
    }
  }

  static bool isNear(const Box3& box, const Vec3& p, double radius) noexcept {
    return squareTo(box, p) <= radius * radius;
  }
  static double squareTo(const Box3& box, const Vec3& p) noexcept {
    const Vec3 apart = glm::max(glm::max(box.lo - p, p - box.hi), Vec3(0.0));
    return glm::dot(apart, apart);
  }
  void split(std::uint32_t node, std::uint32_t begin, std::uint32_t end);

  std::vector<Node> nodes_;
  std::vector<Box3> boxes_;  ///< in the order of items_
  std::vector<std::uint32_t> items_;
};

}  // namespace palpate
