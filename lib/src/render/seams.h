#pragma once
/// Seams: lines on one surface where its wall changes from one material to another, and the share
/// of a press near a seam that each wall bears.

#include <array>
#include <span>

#include "cell_walker.h"
#include "palpate/contact/slide.h"

namespace palpate {

/// The share of a press that is borne by this side of a straight seam `distance` [m] away, where
/// the patch has the radius `radius` [m], more than 0. The pressure is that under a ball (Hertz:
/// sqrt(1 - r^2) over the patch), which integrates to 1 - u^2 across the seam. The share is 1 from
/// a distance of one radius on, and one half on the seam.
struct SeamShare {
  double value = 1.0;
  double by_distance = 0.0;  ///< [1/m]
  double by_radius = 0.0;    ///< [1/m]
};
[[nodiscard]] SeamShare seamShare(double distance, double radius) noexcept;

/// The point nearest to `place` [m], a point on the surface of `wall`, where the surface of `other`
/// crosses it, found by Newton's steps. Not found where the two surfaces are almost tangent, or if
/// no such point is within `farthest` [m].
struct SeamPoint {
  Vec3 at{0.0, 0.0, 0.0};  ///< [m]
  bool found = false;
};
[[nodiscard]] SeamPoint seamPoint(const Field& wall, const Field& other, const Vec3& place,
                                  double farthest) noexcept;

/// Scratch of one renderer: nothing in it carries over to the next tick.
class Seams {
 public:
  /// The most leaves near the patch that are examined, and the most seams that count: the nearest
  /// ones. If there are more, the patch is taken to end at the nearest of the others, so that no
  /// seam appears or disappears abruptly.
  static constexpr std::size_t kMostLeaves = 64;
  static constexpr std::size_t kMostSeams = 10;
  static constexpr std::size_t kMostParts = std::size_t{1} << kMostSeams;

  Seams(const Scene& scene, CellWalker& walker) : scene_(scene), walker_(walker) {}

  /// Starts a new tick; then call add() for each leaf that is near the proxy.
  void clear() noexcept { count_ = 0; }
  void add(LeafId leaf) noexcept {
    if (count_ < near_.size()) near_[count_++] = leaf;
  }
  /// True if no other leaf coincides with the wall `held`, a facet of `leaf`.
  [[nodiscard]] bool isAlone(LeafId leaf, const HeldWall& held) noexcept {
    gather(leaf, held);
    return surface_count_ == 1;
  }
  /// The facet at `place` [m], on the other side of the leaves `turned`, of all leaves that
  /// coincide there.
  [[nodiscard]] Facet facetOf(LeafId leaf, const HeldWall& held, const Vec3& place,
                              std::span<const LeafId> turned = {}) noexcept {
    gather(leaf, held);
    return walker_.facetAside(turned, {surface_.data(), surface_count_}, place);
  }
  /// True if `leaf` is on the surface that was looked up last, or coincides with it.
  [[nodiscard]] bool isOnSurface(LeafId leaf) const noexcept;

  /// A part of the surface around a place, and the share of the press that it bears: all shares add
  /// up to 1.
  struct Part {
    Facet facet;
    double share = 1.0;
    Vec3 by_place{0.0, 0.0, 0.0};  ///< [1/m] gradient of `share` by the place at constant press
    Vec3 by_press{0.0, 0.0, 0.0};  ///< [1/m] gradient of `share` by the press at constant place
  };
  /// The parts around `place` [m] on the wall `held`, a facet of `leaf`, that bear a press whose
  /// way from the hand to the proxy is `press` [m]. Empty: that facet bears all of it. Real-time
  /// safe.
  [[nodiscard]] std::span<const Part> at(LeafId leaf, const HeldWall& held, const Vec3& place,
                                         const Vec3& press) noexcept;

 private:
  /// A seam: the leaves that change side together there.
  struct Seam {
    std::array<LeafId, 8> leaf{};
    std::size_t count = 0;
    Vec3 at{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0};  ///< pointing to the side that the place is on
    double distance = 0.0;
    SeamShare share;
    Vec3 away{0.0, 0.0, 0.0};  ///< gradient of the distance
  };
  void gather(LeafId leaf, const HeldWall& held) noexcept;
  void findSeams(const HeldWall& held, const Vec3& place, double radius) noexcept;
  void addSeam(const Seam& seam) noexcept;
  void leaveOut(const Seam& seam) noexcept;
  /// The wall of the surface on the far side of the seams whose bits are set; not closed where
  /// there is no wall.
  [[nodiscard]] Facet facetAcross(unsigned across, const Vec3& place) noexcept;

  const Scene& scene_;
  CellWalker& walker_;
  std::array<LeafId, kMostLeaves> near_{};
  std::size_t count_ = 0;
  std::array<LeafId, 8> surface_{};  ///< the leaf, and those that coincide with it
  std::size_t surface_count_ = 0;
  std::array<Seam, kMostSeams> seam_{};
  std::size_t seam_count_ = 0;
  double patch_ =
      0.0;  ///< [m] radius: that of the press, or the distance of the nearest seam that is left out
  Vec3 patch_away_{0.0, 0.0, 0.0};  ///< in the second case: its gradient by the place
  bool leaves_out_ = false;
  std::array<Part, kMostParts> part_{};
};

}  // namespace palpate
