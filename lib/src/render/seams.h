#pragma once
/// Seams: lines on one surface where its wall changes from one material to another, and which share
/// of a press near one each wall bears.

#include <array>
#include <span>

#include "cell_walker.h"
#include "palpate/contact/slide.h"

namespace palpate {

/// The share of a press `distance` [m] on this side of a straight seam that this side bears, where
/// the patch has the radius `radius` [m], more than 0: that of the pressure under a ball (Hertz:
/// sqrt(1 - r^2) over the patch), which along any line is spread like 1 - u^2. All of it from one
/// radius on, half on the seam.
struct SeamShare {
  double value = 1.0;
  double by_distance = 0.0;  ///< [1/m]
  double by_radius = 0.0;    ///< [1/m]
};
[[nodiscard]] SeamShare seamShare(double distance, double radius) noexcept;

/// The point nearest to `place` [m], which is on the surface of `wall`, where the surface of
/// `other` crosses that one: Newton's steps. Not found where the two run along each other, or no
/// such point is within `farthest` [m].
struct SeamPoint {
  Vec3 at{0.0, 0.0, 0.0};  ///< [m]
  bool found = false;
};
[[nodiscard]] SeamPoint seamPoint(const Field& wall, const Field& other, const Vec3& place,
                                  double farthest) noexcept;

/// Scratch of one renderer: nothing in it is left for the next tick.
class Seams {
 public:
  /// Leaves near the patch that are looked at, and seams that count: the nearest ones. Where there
  /// are more, the patch is taken to end at the nearest of those that do not count, so that none
  /// comes or goes at once.
  static constexpr std::size_t kMostLeaves = 64;
  static constexpr std::size_t kMostSeams = 10;
  static constexpr std::size_t kMostParts = std::size_t{1} << kMostSeams;

  Seams(const Scene& scene, CellWalker& walker) : scene_(scene), walker_(walker) {}

  /// A new tick: add() names each leaf that is near the proxy.
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
  /// True if `leaf` is on the surface that was asked for last, or coincides with it.
  [[nodiscard]] bool isOnSurface(LeafId leaf) const noexcept;

  /// A piece of the surface around a place, and the share of the press that it bears: all shares
  /// are 1.
  struct Part {
    Facet facet;
    double share = 1.0;
    Vec3 by_place{
        0.0, 0.0,
        0.0};  ///< [1/m] its gradient where the place moves and the press stays as it is, ...
    Vec3 by_press{0.0, 0.0, 0.0};  ///< [1/m] ... and the other way round
  };
  /// The pieces around `place` [m] on the wall `held`, a facet of `leaf`, that a press from the
  /// hand to the proxy by `press` [m] bears on. None: it bears on that facet alone. Real-time safe.
  [[nodiscard]] std::span<const Part> at(LeafId leaf, const HeldWall& held, const Vec3& place,
                                         const Vec3& press) noexcept;

 private:
  /// A seam: the leaves that change side there together.
  struct Seam {
    std::array<LeafId, 8> leaf{};
    std::size_t count = 0;
    Vec3 at{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0};  ///< towards the side that the place is on
    double distance = 0.0;
    SeamShare share;
    Vec3 away{0.0, 0.0, 0.0};  ///< gradient of the distance
  };
  void gather(LeafId leaf, const HeldWall& held) noexcept;
  void findSeams(const HeldWall& held, const Vec3& place, double radius) noexcept;
  void addSeam(const Seam& seam) noexcept;
  void leaveOut(const Seam& seam) noexcept;
  /// The wall behind the surface, on the far side of the seams whose bits are set; not closed where
  /// there is none.
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
      0.0;  ///< [m] radius: that of the press, or up to the nearest seam that is left out
  Vec3 patch_away_{0.0, 0.0, 0.0};  ///< gradient of that by the place, in the second case
  bool leaves_out_ = false;
  std::array<Part, kMostParts> part_{};
};

}  // namespace palpate
