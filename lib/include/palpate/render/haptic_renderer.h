#pragma once
/// HapticRenderer: HIP in, force out, one tick at a time. The scene is shared and const; every mutable
/// bit of haptic rendering is owned here.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "palpate/contact/force_guard.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// What the device says at one tick.
struct HipState {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] the haptic interface point P
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] by whatever estimator the caller names
  double dt = 1e-3;              ///< [s] since the last tick; used by slew limit and ramp only
};

/// How the proxy went through a port.
struct PortCrossing {
  enum class How : std::uint8_t {
    kOpen,      ///< the port stood open
    kPuncture,  ///< its wall gave way to the force; a port that makes holes has a new one here
    kHole,      ///< by a hole made before, at its reopening force
  };
  PortId port = 0;
  RegionId from = kOutside;
  RegionId to = kOutside;
  How how = How::kOpen;
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] where the surface was crossed
  Vec3 normal{0.0, 0.0,
              0.0};    ///< [-, world] of the surface there, back to where the proxy came from; zero
                       ///< where the surface has none
  double force = 0.0;  ///< [N] elastic normal force that it gave way to; 0 where it stood open
};

/// What one tick came to.
struct TickResult {
  /// Crossings that one tick can make: what would cross more often goes on in the next tick.
  static constexpr std::size_t kMaxEvents = 32;

  Vec3 force{0.0, 0.0, 0.0};  ///< [N, world] on the hand; always finite
  Vec3 proxy{0.0, 0.0, 0.0};  ///< [m, world] the tip held in its region
  RegionId region = kOutside;
  bool contact = false;          ///< a closed wall is pressed
  std::uint8_t event_count = 0;  ///< crossings of this tick that passed a port, in path order
  std::array<PortId, kMaxEvents> events{};
};

/// How the paper's algorithms nudge the contact point back onto the surface (its alpha term).
enum class AlphaForm {
  kByMetric,  ///< kLength for distances (exact and bound fields), kNewton for implicit ones
  kLength,    ///< alpha S N / |N|, as printed: its strength depends on the field's scale
  kNewton,    ///< alpha S N / (N . N)
};

struct RendererSettings {
  std::optional<RendererKind> kind = {};        ///< not given: as the scene says
  AlphaForm alpha_form = AlphaForm::kByMetric;  ///< paper's renderer only
  double alpha = 1.0;                           ///< [-] paper's renderer only
  ForceLimits limits = {};  ///< none unless asked for, so that closed forms hold
};

/// One algorithm of section 3 of DESIGN.md. Construction may throw and allocate; update() and reset()
/// never allocate, lock, throw or block.
class HapticRenderer {
 public:
  /// [m] No hand is that far away: such a position is a broken one. Beyond it double precision no longer
  /// tells one side of a wall from the other along the way there.
  static constexpr double kFarthest = 1e4;

  virtual ~HapticRenderer() = default;
  HapticRenderer(const HapticRenderer&) = delete;
  HapticRenderer& operator=(const HapticRenderer&) = delete;

  /// One tick. A non-finite position or velocity, or a position more than kFarthest from the origin in any
  /// coordinate, gives zero force and changes no state; the next good tick goes on from where the proxy
  /// was. The force is finite and within the limits.
  [[nodiscard]] TickResult update(const HipState& hip) noexcept;

  /// Each crossing of TickResult::events of the last update(), in path order. Valid until the next one.
  [[nodiscard]] std::span<const PortCrossing> crossings() const noexcept {
    return details().first(last_.event_count);
  }

  /// Back to the start region, with no port passed and no hole made; the next update() is a first tick.
  void reset() noexcept;

 protected:
  /// `start` is the region told until the first good tick.
  HapticRenderer(const ForceLimits& limits, RegionId start) : guard_(limits), start_(start) {
    last_.region = start;
  }

 private:
  /// The algorithm's own tick: `hip` is finite, the force is not limited yet.
  [[nodiscard]] virtual TickResult step(const HipState& hip) noexcept = 0;
  virtual void forget() noexcept = 0;
  /// At least as many crossings as the last step() told events.
  [[nodiscard]] virtual std::span<const PortCrossing> details() const noexcept = 0;

  ForceGuard guard_;
  RegionId start_;
  TickResult last_;
};

/// @throws Error (kInput) if the scene is null or asks the paper's renderer for what it cannot do.
[[nodiscard]] std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene,
                                                           RendererSettings settings = {});

}  // namespace palpate
