#pragma once
/// The force laws of the walls near the proxy, and whether walls of several kinds are felt at once.

#include <array>
#include <vector>

#include "flattened_wall.h"
#include "layers_beneath.h"
#include "near_walls.h"
#include "palpate/contact/felt_height.h"
#include "palpate/contact/series.h"
#include "palpate/render/tick_state.h"
#include "proxy_solver.h"
#include "seams.h"

namespace palpate {

/// Scratch of one renderer: nothing in it carries over to the next tick.
class FeltWalls final : public SoftKinds {
 public:
  FeltWalls(const Scene& scene, CellWalker& walker);

  /// [N/m] The stiffness of a wall at `x` [m]: that of its material, or of the layers behind it.
  [[nodiscard]] MaterialMap::Sample stiffness(LeafId leaf, const Facet& facet, const HeldWall& held,
                                              const Vec3& x) noexcept;
  /// The force law of that wall there.
  [[nodiscard]] SharedWall felt(LeafId leaf, const Facet& facet, const HeldWall& held,
                                const Vec3& x, SmoothedField& smoothed) noexcept;
  /// The force laws there of that wall and of those beside it on the same surface; call press() and
  /// differ() first.
  [[nodiscard]] SharedWalls shared(LeafId leaf, const Facet& facet, const HeldWall& held,
                                   const Vec3& x, SmoothedField& smoothed) noexcept;
  [[nodiscard]] SharedWalls shared(const WallContact& contact, const Vec3& x) noexcept {
    return shared(contact.leaf, contact.facet, contact.held, x, smoothed_[0]);
  }
  /// True if differ() found that a wall that holds the proxy shares the press with others.
  [[nodiscard]] bool hasSeam() const noexcept { return has_seam_; }

  /// True if a wall of this material is one linear spring, the same everywhere.
  [[nodiscard]] bool isPlain(const Facet& facet) const noexcept {
    return is_plain_[static_cast<std::size_t>(facet.material)];
  }

  /// Finds the walls within `reach` [m] of the proxy, which `contact` holds; true if they are of
  /// several kinds that meet at an angle. Then seriesForce() may be called, until the walker moves.
  [[nodiscard]] bool differ(const ContactSet& contact, double reach) noexcept;
  /// Whether walls of the present region, or of those that it leads to freely, may push by
  /// different laws.
  [[nodiscard]] bool mayDiffer() const noexcept { return may_differ_[walker_.region()]; }
  /// The leaves of the walls that differ() found, including those of the contact.
  [[nodiscard]] FeltLeaves leaves() const noexcept;
  /// Restricts differ() to the walls of the contact and `known`, until this is called with null.
  void findOnly(const FeltLeaves* known) noexcept { known_ = known; }
  /// Sets the way from the hand to the proxy [m], which determines the width of the patch that is
  /// pressed. Call it first in each tick.
  void press(const Vec3& way) noexcept { press_ = way; }
  /// [N/m] A stiffness higher than that of any wall of the scene, at any depth for which its shapes
  /// have room.
  [[nodiscard]] double stop() const noexcept { return stop_; }

  [[nodiscard]] std::size_t count() const noexcept override { return count_; }
  [[nodiscard]] LocalProjection nearest(std::size_t index, const Vec3& from,
                                        const Vec3& place) noexcept override;
  [[nodiscard]] const SharedWalls& law(std::size_t index) const noexcept override {
    return group_[index].law;
  }
  [[nodiscard]] Change change(std::size_t index, const LocalProjection& on) const noexcept override;

 private:
  /// Share of the depth by which texture may at most lower or raise a wall.
  static constexpr double kHeldTexture = 0.5;
  static constexpr double kHeldShading = 0.9;

  struct Near {
    LeafId leaf = 0;
    Facet facet;
    HeldWall held;
  };
  /// Walls of one kind.
  struct Group {
    int kind = -1;
    int own = 0;          ///< number of the part behind the walls, where their feel depends on it
    bool shares = false;  ///< the group is one surface on which other walls take part of the press
    std::array<Near, kMaxProjectionWalls> wall{};
    std::array<HeldWall, kMaxProjectionWalls> held{};     ///< the same, at the depth of the press
    std::array<FlattenedWall, kMaxProjectionWalls> flat;  ///< replacement fields of some of them
    std::size_t count = 0;
    SharedWalls law;  ///< at the place of the proxy
  };
  void sortKinds();
  [[nodiscard]] bool mayDiffer(RegionId region) const;
  [[nodiscard]] std::vector<bool> usedByWalls() const;
  [[nodiscard]] const Material& material(const Facet& facet) const noexcept {
    return scene_.materials()[static_cast<std::size_t>(facet.material)];
  }
  [[nodiscard]] static bool isWall(const Facet& facet) noexcept;
  [[nodiscard]] int ownOf(const Near& wall) const noexcept;
  [[nodiscard]] bool feelsAlike(const Facet& a, const Facet& b) const noexcept;
  void findGroups(const ContactSet& contact, double reach) noexcept;
  [[nodiscard]] bool isWallAt(const Near& wall, LeafId beside, const Vec3& place) noexcept;
  [[nodiscard]] Vec3 byProxy(const HeldWall& held, const Vec3& rise) const noexcept;
  [[nodiscard]] Vec3 footOn(const HeldWall& held) const noexcept;
  [[nodiscard]] bool isFeltAlready() const noexcept;
  [[nodiscard]] bool isShared(const Near& wall) noexcept;
  void sortSeams();
  void findConvexLeaves();
  void add(const Near& wall) noexcept;
  void setLaw(Group& group, SmoothedField& smoothed) noexcept;
  void flatten(Group& group) const noexcept;
  [[nodiscard]] LocalProjection ontoPlanes(const Group& group, const Vec3& place) const noexcept;

  const Scene& scene_;
  CellWalker& walker_;
  NearWalls near_;
  LayersBeneath beneath_;
  std::vector<int> kind_;      ///< by material: equal for those that feel the same
  std::vector<double> reach_;  ///< [m] by material: depth up to which its texture counts
  std::vector<double>
      contrast_;  ///< [m] by material: infinite where its stiffness is read at a point
  std::vector<bool> is_plain_;   ///< by material
  std::vector<bool> is_convex_;  ///< by leaf: it is a convex solid
  std::vector<bool>
      may_differ_;  ///< by region: its walls, or those of regions that it leads to freely
  Seams seams_;
  bool has_seam_ = false;
  double stop_ = 0.0;
  Vec3 press_{0.0, 0.0, 0.0};
  std::array<Group, kMost> group_{};
  std::size_t count_ = 0;
  const FeltLeaves* known_ = nullptr;
  std::array<SmoothedField, kMost> smoothed_{};
};

}  // namespace palpate
