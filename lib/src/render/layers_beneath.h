#pragma once
/// The layers behind a wall along its inward normal, and the stiffness that they have together.

#include "cell_walker.h"
#include "palpate/contact/layered.h"
#include "palpate/contact/slide.h"

namespace palpate {

/// Belongs to one renderer; the scene is const, the scratch its own.
class LayersBeneath {
 public:
  /// `proxy` stands at the place from which the walls are felt, and must outlive this object.
  LayersBeneath(const Scene& scene, const CellWalker& proxy)
      : scene_(scene), proxy_(proxy), probe_(scene, place_) {}
  LayersBeneath(const LayersBeneath&) = delete;  // the probe refers to this object's place_
  LayersBeneath& operator=(const LayersBeneath&) = delete;

  /// The stiffness [N/m] of the layers behind the wall `held` of `leaf` at `x` [m], as `material`'s
  /// composite states, and its gradient along the wall. The last result is cached for the next call
  /// with the same place. Real-time safe: at most kMostStackLayers layers, and a tick's budget of
  /// evaluations.
  ///
  /// A layer is as stiff as its region's own wall; a layer without a wall, and the outside, are
  /// skipped, and the layer before continues there. Over the last quarter of the depth differences
  /// fade out, and a layer counts less the flatter the normal meets it, so that no layer appears
  /// abruptly. A layer that covers the wall at `x`, as beside a crease, is treated as one that
  /// begins right behind it.
  [[nodiscard]] MaterialMap::Sample stiffness(LeafId leaf, const Vec3& x, const HeldWall& held,
                                              const Facet& facet,
                                              const Material& material) noexcept;

 private:
  /// The stack found, with the derivatives of each of its layers by the pressed place on the wall.
  struct Found {
    std::array<StackLayer, kMostStackLayers> layers{};
    std::array<Vec3, kMostStackLayers> rise{};   // [N/m^2] gradient of the stiffness
    std::array<Vec3, kMostStackLayers> slope{};  // [-] gradient of the depth of its top
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
