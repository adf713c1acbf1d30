#pragma once
/// A needle on its way through the tissues of a scene: which of them it pierced, where, how much of its
/// shaft is in each, and what was cut.

#include <array>
#include <cstdint>
#include <span>

#include "palpate/contact/cut.h"
#include "palpate/contact/shaft_slip.h"
#include "palpate/render/contents.h"
#include "palpate/render/tick.h"

namespace palpate {

/// The needle is straight and rigid, and its tip is the proxy: its shaft lies along the line from where it
/// first went in to the tip. Tissues pierced one after another each hold the part of the shaft that is in
/// them; only the one that the tip is in is cut. A value of fixed size; real-time safe.
class Insertion {
 public:
  /// Tissues that the shaft is in at the same time. Pierced beyond that, all let go until the tip is out.
  static constexpr std::size_t kMaxLayers = 64;
  /// Cuts that are remembered; the oldest is forgotten.
  static constexpr std::size_t kMaxCuts = 32;

  struct Tick {
    Vec3 tip{0.0, 0.0, 0.0};       ///< [m] the proxy
    Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s] of the hand
    RegionId region = kOutside;    ///< of the proxy
    std::span<const PortCrossing> crossings;
  };

  /// The force [N] on the hand.
  [[nodiscard]] Vec3 step(const Contents& contents, std::span<const Port> ports,
                          const Tick& tick) noexcept;
  void reset() noexcept { *this = {}; }
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
  };
  struct Remembered {
    RegionId region = kOutside;
    Cut cut;
  };
  struct Step {
    RegionId from = kOutside;
    RegionId to = kOutside;
    Vec3 point{0.0, 0.0, 0.0};
    Vec3 normal{0.0, 0.0, 0.0};
    double hole_radius = 0.0;  ///< [m]
  };

  void cross(const Contents& contents, const Step& step) noexcept;
  void push(const Step& step) noexcept;
  void pop() noexcept;
  void letGo() noexcept;
  [[nodiscard]] bool isBackThrough(const Layer& layer, const Step& step) const noexcept;
  [[nodiscard]] Remembered* cutNear(RegionId region, const Vec3& p, double radius) noexcept;
  [[nodiscard]] double shaftForce(const Contents& contents, const Tick& tick, const Vec3& axis,
                                  double advance) noexcept;

  std::array<Layer, kMaxLayers> layers_{};
  std::size_t count_ = 0;
  std::array<Remembered, kMaxCuts> cuts_{};
  std::size_t cut_count_ = 0;
  std::size_t next_cut_ = 0;  ///< when full: the oldest
  bool started_ = false;
  bool is_lost_ = false;          ///< more tissues than can be told apart
  RegionId region_ = kOutside;    ///< at the last step
  Vec3 tip_{0.0, 0.0, 0.0};       ///< [m] at the last step
  Vec3 velocity_{0.0, 0.0, 0.0};  ///< [m/s] at this step
  double reach_ = 0.0;  ///< [m] from where the shaft first went in to the tip, at the last step
};

}  // namespace palpate
