#pragma once
/// The `constraint` renderer (DESIGN.md section 3): the proxy minimises |x - P|^2 over its region along
/// a connected path; the wall pushes the hand back to it.

#include <array>

#include "cell_walker.h"
#include "insertion.h"
#include "layers_beneath.h"
#include "palpate/contact/maxwell_branch.h"
#include "palpate/contact/planes.h"
#include "palpate/contact/slide.h"
#include "palpate/contact/wall_spring.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

class ConstraintRenderer final : public HapticRenderer {
 public:
  ConstraintRenderer(ScenePtr scene, const RendererSettings& settings);

 private:
  [[nodiscard]] TickResult step(const HipState& hip) noexcept override;
  void forget() noexcept override;
  [[nodiscard]] std::span<const PortCrossing> details() const noexcept override {
    return walker_.crossings();
  }

  /// The closed walls at the proxy: what the local problem is made of, and which of them hold it.
  struct Contact {
    std::array<LeafId, kMaxPlanes> leaf{};
    std::array<Facet, kMaxPlanes> facet{};
    std::array<FieldJet, kMaxPlanes> jet{};
    std::array<Plane, kMaxPlanes> plane{};
    std::size_t planes = 0;
    std::array<Vec3, kMaxPlanes> probe{};   ///< HeldWall::probe
    std::array<bool, kMaxPlanes> slides{};  ///< parallel to a wall that holds
    std::array<HeldWall, 3> held{};         ///< the working set
    std::array<std::size_t, 3> index{};     ///< of held walls among the planes
    std::size_t count = 0;
    std::array<LeafId, kMaxPlanes>
        sliding{};  ///< leaves that motion along the held walls must not see
    std::size_t sliding_count = 0;
    Vec3 step{0.0, 0.0, 0.0};  ///< [m] of the local problem
    Vec3 pull{0.0, 0.0, 0.0};  ///< [m] tangential rest of it, after friction
    Vec3 lag{0.0, 0.0, 0.0};   ///< [m] tangential rest of it that friction holds

    [[nodiscard]] std::span<const HeldWall> walls() const noexcept { return {held.data(), count}; }
    [[nodiscard]] double load() const noexcept;  ///< [m] length of the sum of multiplier * normal
  };

  /// One of the walls that meet in a crease of a leaf at the proxy.
  struct Piece {
    LeafId leaf = 0;
    Vec3 normal{0.0, 0.0, 0.0};  ///< [-] as last felt
    Vec3 probe{0.0, 0.0, 0.0};   ///< [-] where to ask for it, see HeldWall
    bool is_felt = false;
    std::size_t plane = 0;  ///< of the contact's
  };
  static constexpr std::size_t kMaxPieces = 6;

  void start(const Vec3& hip) noexcept;
  void track(const Vec3& hip) noexcept;
  void findContact(const Vec3& hip) noexcept;
  [[nodiscard]] bool feelPieces(LeafId leaf, const Facet& facet) noexcept;
  void forgetPieces() noexcept;
  void aimProbes() noexcept;
  /// [m] how far beside a crease its walls are asked for.
  [[nodiscard]] double reachOf(LeafId leaf) const noexcept;
  void holdByFriction() noexcept;
  [[nodiscard]] bool puncture() noexcept;
  [[nodiscard]] bool slide(const Vec3& hip) noexcept;
  [[nodiscard]] bool slideBy(const Vec3& hip, const Vec3& by, bool must_improve,
                             std::span<const HeldWall> walls) noexcept;
  [[nodiscard]] bool unfold(const Vec3& hip, const Vec3& toward) noexcept;
  [[nodiscard]] bool unfoldLeaf(const Vec3& hip, LeafId leaf, const Vec3& toward) noexcept;
  [[nodiscard]] bool unfoldAround(const Vec3& hip) noexcept;
  [[nodiscard]] bool hasTurned(bool impatient) const noexcept;
  void letGoAtRim() noexcept;
  [[nodiscard]] bool isSettled(const Vec3& hip) const noexcept;
  [[nodiscard]] bool isOnWalls() const noexcept;
  [[nodiscard]] Vec3 shaded(const HeldWall& held, const Facet& facet, double radius) const noexcept;
  void relax(double dt) noexcept;
  [[nodiscard]] Vec3 wallForce(const Vec3& velocity) noexcept;
  [[nodiscard]] Vec3 contentForce(const HipState& hip) noexcept;
  [[nodiscard]] MaterialMap::Sample stiffnessOf(std::size_t held) noexcept;
  [[nodiscard]] double contentShare() noexcept;
  void fadeContent(const Vec3& hip) noexcept;
  [[nodiscard]] const Material& wallMaterial(const Facet& facet) const noexcept {
    return scene_->materials()[static_cast<std::size_t>(facet.material)];
  }
  /// The spring of a held wall at the proxy.
  [[nodiscard]] WallSpring springOf(std::size_t held) noexcept {
    const Material& wall = wallMaterial(contact_.facet[contact_.index[held]]);
    const Vec3& x = walker_.position();
    return {stiffnessOf(held).value, wall.curve.stiffening.at(x), wall.curve.exponent,
            wall.curve.reference};
  }

  ScenePtr scene_;
  CellWalker walker_;
  LayersBeneath beneath_;
  Contact contact_;
  std::array<Piece, kMaxPieces> pieces_{};
  std::size_t piece_count_ = 0;
  int unfolds_left_ = 0;
  struct {
    Vec3 position{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0};
    LeafId leaf = 0;
  } before_;  ///< the slide before: where it began, on what
  bool started_ = false;
  bool is_first_ = true;  ///< no tick yet
  Vec3 last_hip_{0.0, 0.0, 0.0};
  RegionId felt_region_ = kOutside;
  double content_share_ = 1.0;
  bool sticking_ = false;
  bool has_friction_ = false;  ///< of the walls that hold the proxy
  /// [m] How far the proxy's springs would draw it along the walls to where they are softer, by the tick before. With
  /// friction the cone is about there; without, the force has the term for it.
  Vec3 lean_{0.0, 0.0, 0.0};
  bool tick_begins_ = false;
  struct {
    MaxwellBranch state;
    double depth = 0.0;          ///< [m] at the last tick
    int material = -1;           ///< of the wall pressed; -1: none
    RegionId region = kOutside;  ///< from where
  } branch_;
  Insertion insertion_;
  bool is_pressed_ = false;  ///< walls within the tolerance count as reached
};

}  // namespace palpate
