#pragma once
/// A needle on its way through the tissues of a scene: which of them it pierced, where, how much of
/// its shaft is in each, and what was cut.

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
/// where it first went in, which is its fulcrum, to the tip. Tissues pierced one after another each
/// hold the part of the shaft that is in them, along it and sideways; only the one that the tip is
/// in is cut.
///
/// A tick takes the tip through the walls one after the other, however far ahead the hand is: each
/// wall is met with the tip at it, is pressed by as much as the hand is beyond it, and gives way to
/// its own force or stops the tip. Each tissue gone through is cut all the way from where it was
/// entered to where it was left, and holds that much of the shaft from then on. A tip on a wall
/// that no force opens cuts nothing of what is before it.
///
/// Where a wall holds the tip, the hand goes on without it, and what friction and cutting push with
/// is felt all that way. It must not change out there to what gives the hand more on its way back
/// than it took on its way in: the part of it towards the wall then stays what it was, until the
/// tip is at the hand again or goes through.
///
/// A value of fixed size; real-time safe.
class Insertion {
 public:
  /// Tissues that the shaft is in at the same time. Pierced beyond that, all let go until the tip
  /// is out.
  static constexpr std::size_t kMaxLayers = 64;
  /// Cuts that are remembered; the oldest is forgotten.
  static constexpr std::size_t kMaxCuts = 32;

  struct Tick {
    Vec3 tip{0.0, 0.0, 0.0};               ///< [m] the proxy
    Vec3 hand{0.0, 0.0, 0.0};              ///< [m]
    Vec3 velocity{0.0, 0.0, 0.0};          ///< [m/s] of the hand
    RegionId region = kOutside;            ///< of the proxy
    std::span<RegionEntry> entries;        ///< of this tick; their `cut` is filled in
    std::span<const HeldWall> rests_on{};  ///< walls that hold the proxy and open to no force
  };
  struct Force {
    Vec3 tip{0.0, 0.0, 0.0};  ///< [N] on the hand, of cutting and of friction along the shaft
    Vec3 lateral{0.0, 0.0,
                 0.0};  ///< [N] on the proxy, square to the shaft: the slope of what is stored
  };

  [[nodiscard]] Force step(const Contents& contents, const Tick& tick) noexcept;
  void reset() noexcept { *this = {}; }
  /// [J] At the last step, in what sticks to the shaft, holds it sideways, and is pressed by the
  /// tip before it is cut; and what a hand that went on without the tip takes on its way back to
  /// it.
  [[nodiscard]] double stored() const noexcept { return stored_ - glm::dot(felt_, beyond_); }
  /// Whether this can be an insertion in a scene of so many regions.
  [[nodiscard]] bool isOf(std::size_t regions) const noexcept;

 private:
  /// A tissue, or a gap between tissues, that the tip is in or went through.
  struct Layer {
    RegionId from = kOutside;
    RegionId region = kOutside;
    Vec3 normal{0.0, 0.0, 0.0};  ///< [-] where it was entered, back to `from`; zero if not known
    Cut cut;                     ///< begins where it was entered
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
    double against = 0.0;         ///< [N] going in, of what sticks to the shaft
    double damping = 0.0;         ///< [N] going in, by the speed
    Vec3 axis{0.0, 0.0, 0.0};     ///< [-] the way in
    Vec3 lateral{0.0, 0.0, 0.0};  ///< [N]
  };
  [[nodiscard]] ShaftForce shaftForce(const Contents& contents, const Tick& tick) noexcept;
  [[nodiscard]] Vec3 feltBeyond(const Vec3& force, const Tick& tick) noexcept;

  std::array<Layer, kMaxLayers> layers_{};
  std::size_t count_ = 0;
  std::array<Remembered, kMaxCuts> cuts_{};
  std::size_t cut_count_ = 0;
  std::size_t next_cut_ = 0;  ///< when full: the oldest
  bool started_ = false;
  bool is_lost_ = false;          ///< more tissues than it can keep apart
  RegionId region_ = kOutside;    ///< at the last step
  Vec3 tip_{0.0, 0.0, 0.0};       ///< [m] at the last step
  Vec3 velocity_{0.0, 0.0, 0.0};  ///< [m/s] at this step
  Vec3 felt_{0.0, 0.0, 0.0};      ///< [N] of cutting and what sticks, at the last step
  Vec3 beyond_{0.0, 0.0, 0.0};    ///< [m] from the tip to the hand, at the last step
  double stored_ = 0.0;           ///< [J]
  double reach_ = 0.0;  ///< [m] from where the shaft first went in to the tip, at the last step
};

}  // namespace palpate
