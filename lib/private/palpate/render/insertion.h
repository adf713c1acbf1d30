#pragma once
/// A needle on its way through the tissues of a scene: which of them it pierced and where, how much
/// of its shaft is in each, and what was cut.

#include <array>
#include <cstdint>
#include <span>

#include "palpate/contact/cut.h"
#include "palpate/contact/shaft_channel.h"
#include "palpate/contact/shaft_slip.h"
#include "palpate/render/contents.h"
#include "palpate/render/haptic_renderer.h"

namespace palpate {

/// The needle is straight and rigid, and its tip is the proxy: its shaft lies along the line from
/// the point where it first went in, its fulcrum, to the tip. Each tissue that was pierced holds
/// the part of the shaft that is in it, along the shaft and sideways; only the tissue that contains
/// the tip is cut.
///
/// A tick takes the tip through the walls one after the other, however far ahead the hand is. At
/// each wall the tip stops on the wall, which is pressed by as far as the hand is beyond it; the
/// wall either gives way at its own force or holds the tip. Each tissue that is passed is cut all
/// the way from where it was entered to where it was left, and holds that part of the shaft from
/// then on. A tip on a wall that no force opens does not cut the tissue in front of it.
///
/// Where a wall holds the tip, the hand goes on without it, and feels the forces of friction and
/// cutting all that way. If these forces changed meanwhile, the hand could gain more energy on its
/// way back than it spent on its way in. So their component towards the wall keeps its value until
/// the tip is at the hand again or goes through.
///
/// A value type of fixed size; real-time safe.
class Insertion {
 public:
  /// The most tissues that the shaft can be in at the same time. If it pierces more, all let go
  /// until the tip is out.
  static constexpr std::size_t kMaxLayers = 64;
  /// The most cuts that are remembered; then the oldest is forgotten.
  static constexpr std::size_t kMaxCuts = 32;

  struct Tick {
    Vec3 tip{0.0, 0.0, 0.0};         ///< [m] the proxy
    Vec3 hand{0.0, 0.0, 0.0};        ///< [m]
    Vec3 velocity{0.0, 0.0, 0.0};    ///< [m/s] of the hand
    RegionId region = kOutside;      ///< of the proxy
    std::span<RegionEntry> entries;  ///< entries of this tick; their member `cut` is filled in
    std::span<const HeldWall> rests_on{};  ///< walls that hold the proxy and that no force opens
  };
  struct Force {
    Vec3 tip{0.0, 0.0, 0.0};  ///< [N] on the hand, from cutting and from friction along the shaft
    /// [N] on the proxy, perpendicular to the shaft: minus the gradient of the stored energy
    Vec3 lateral{0.0, 0.0, 0.0};
  };

  [[nodiscard]] Force step(const Contents& contents, const Tick& tick) noexcept;
  void reset() noexcept { *this = {}; }
  /// [J] Energy at the last step: in tissue that sticks to the shaft, that holds it sideways, and
  /// that the tip presses before it is cut; plus the work that the force will do on a hand that
  /// went on without the tip, on its way back to the tip.
  [[nodiscard]] double stored() const noexcept { return stored_ - glm::dot(felt_, beyond_); }
  /// Whether this can be an insertion in a scene with that many regions.
  [[nodiscard]] bool isOf(std::size_t regions) const noexcept;

 private:
  /// A tissue, or a gap between tissues, that contains the tip or that the tip went through.
  struct Layer {
    RegionId from = kOutside;
    RegionId region = kOutside;
    Vec3 normal{0.0, 0.0, 0.0};  ///< [-] where it was entered, towards `from`; zero if not known
    Cut cut;                     ///< it begins where the layer was entered
    ShaftSlip slip;
    ShaftChannel channel;
  };
  struct Remembered {
    RegionId region = kOutside;
    Cut cut;
  };

  void cross(const Contents& contents, RegionEntry& step) noexcept;
  void push(const RegionEntry& step, double same_way) noexcept;
  void pop(double same_way) noexcept;
  void letGo(double same_way) noexcept;
  [[nodiscard]] bool isBackThrough(const Layer& layer, const RegionEntry& step,
                                   double same_way) const noexcept;
  [[nodiscard]] Remembered* cutNear(RegionId region, const Vec3& p, double radius) noexcept;
  struct ShaftForce {
    double against = 0.0;         ///< [N] against going in, from tissue that sticks to the shaft
    double damping = 0.0;         ///< [N] against going in, from the speed
    Vec3 axis{0.0, 0.0, 0.0};     ///< [-] the direction of going in
    Vec3 lateral{0.0, 0.0, 0.0};  ///< [N]
  };
  [[nodiscard]] ShaftForce shaftForce(const Contents& contents, const Tick& tick) noexcept;
  [[nodiscard]] Vec3 feltBeyond(const Vec3& force, const Tick& tick) noexcept;

  std::array<Layer, kMaxLayers> layers_{};
  std::size_t count_ = 0;
  std::array<Remembered, kMaxCuts> cuts_{};
  std::size_t cut_count_ = 0;
  std::size_t next_cut_ = 0;  ///< when full: index of the oldest
  bool started_ = false;
  bool is_lost_ = false;          ///< there were more tissues than it can keep apart
  RegionId region_ = kOutside;    ///< at the last step
  Vec3 tip_{0.0, 0.0, 0.0};       ///< [m] at the last step
  Vec3 velocity_{0.0, 0.0, 0.0};  ///< [m/s] at this step
  Vec3 felt_{0.0, 0.0, 0.0};      ///< [N] force of cutting and sticking at the last step
  Vec3 beyond_{0.0, 0.0, 0.0};    ///< [m] from the tip to the hand, at the last step
  double stored_ = 0.0;           ///< [J]
  double reach_ = 0.0;            ///< [m] from the fulcrum to the tip, at the last step
};

}  // namespace palpate
