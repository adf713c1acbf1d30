#pragma once
/// What lies behind a wall along its inward normal, and how stiff all of it feels together.

#include "cell_walker.h"
#include "palpate/contact/layered.h"
#include "palpate/contact/slide.h"

namespace palpate {

/// Belongs to one renderer; const scene, scratch of its own.
class LayersBeneath {
 public:
  /// `proxy` stands where the walls are felt from, and outlives this.
  LayersBeneath(const Scene& scene, const CellWalker& proxy)
      : scene_(scene), proxy_(proxy), probe_(scene, place_) {}
  LayersBeneath(const LayersBeneath&) = delete;  // the probe works on this one's place
  LayersBeneath& operator=(const LayersBeneath&) = delete;

  /// The stiffness [N/m] of the layers behind the wall `held` of `leaf` at `x` [m], as `material`'s
  /// composite asks, and its gradient along the wall. The last answer is kept for the next question
  /// about the same place. Real-time safe: at most kMostStackLayers layers, and a tick's budget of
  /// evaluations.
  ///
  /// A layer is as stiff as its region's own wall; one without a wall, and what is outside, are not
  /// looked into: there the layer before goes on. Towards the end of the depth what differs fades
  /// out over its last quarter, and a layer counts the less the flatter the normal meets it, so
  /// that nothing appears at once. A layer that covers the wall at `x`, as beside a crease, is felt
  /// as one that begins right behind it.
  [[nodiscard]] MaterialMap::Sample stiffness(LeafId leaf, const Vec3& x, const HeldWall& held,
                                              const Facet& facet,
                                              const Material& material) noexcept;

 private:
  /// The stack found, with how each of its layers changes as the place pressed moves along the
  /// wall.
  struct Found {
    std::array<StackLayer, kMostStackLayers> layers{};
    std::array<Vec3, kMostStackLayers> rise{};   // [N/m^2] of the stiffness
    std::array<Vec3, kMostStackLayers> slope{};  // [-] of the depth of its top
    std::array<double, kMostStackLayers> top{};  // [m] depth of its top
    std::size_t count = 0;
  };

  void look(const Vec3& x, const HeldWall& held, RegionId beyond, double depth) noexcept;
  [[nodiscard]] bool isFlush(LeafId leaf, const Vec3& x, const HeldWall& held,
                             double depth) noexcept;
  void add(RegionId from, LeafId leaf, const Vec3& x, const HeldWall& held, double depth) noexcept;

  const Scene& scene_;
  const CellWalker& proxy_;
  PlaceState place_;
  CellWalker probe_;
  Found found_;
  LeafId last_leaf_ = 0;
  Vec3 last_x_{0.0, 0.0, 0.0};
  RegionId last_beyond_ = kOutside;
  bool has_last_ = false;
  MaterialMap::Sample last_;
};

}  // namespace palpate
