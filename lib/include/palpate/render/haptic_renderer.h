#pragma once
/// HapticRenderer: HIP in, force out, one tick at a time. The scene is shared and const; every mutable
/// bit of haptic rendering is owned here.

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>

#include "palpate/contact/force_guard.h"
#include "palpate/render/contents.h"
#include "palpate/scene/scene.h"

namespace palpate {

/// What the device says at one tick.
struct HipState {
  Vec3 position{0.0, 0.0, 0.0};  ///< [m, world] the haptic interface point P
  Vec3 velocity{0.0, 0.0, 0.0};  ///< [m/s, world] by whatever estimator the caller names
  double dt = 1e-3;              ///< [s] since the last tick; for limits, and what relaxes in time
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
  bool contact = false;  ///< a closed wall is pressed
  /// The proxy rests where it is closest to the hand, within the stated tolerances; false: it is on its way
  /// there, at a point that is allowed and no further from the hand than the last one, out of budget for this tick.
  bool settled = true;
  std::uint8_t event_count = 0;  ///< crossings of this tick that passed a port, in path order
  std::array<PortId, kMaxEvents> events{};
};

struct RendererSettings {
  std::optional<RendererKind> kind = {};  ///< not given: as the scene says
  PaperParameters paper = {};             ///< paper's renderer only; goes before the scene's own
  ForceLimits limits = {};                ///< none unless asked for, so that closed forms hold
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

  /// From the next tick on, the content of `region` feels as `change` says; what is felt may jump. False, and
  /// nothing is changed, for an unknown region or a value out of its range. Real-time safe, on the thread
  /// that update() is called on. It stays so after reset(); an empty change takes it back.
  [[nodiscard]] bool setContent(RegionId region, const ContentChange& change) noexcept {
    return contents_.change(region, change);
  }

  /// [J] Work on the hand since the first tick, up to the last, of what is a source of energy by its nature: flows,
  /// and lattices whose potential differs where a region is entered and left. A hand that got no more than
  /// this from the renderer met a passive world. Counted before the limits of the force.
  [[nodiscard]] double sourceWork() const noexcept { return source_work_; }

  /// Back to the start region, with no port passed and no hole made; the next update() is a first tick.
  void reset() noexcept;

 protected:
  HapticRenderer(const Scene& scene, const ForceLimits& limits)
      : contents_(scene), guard_(limits), start_(scene.startRegion()) {
    last_.region = start_;  // told until the first good tick
  }

  /// Drag of the content of `region` at the tip `p` [m], of which `share` is felt by a hand that moves at
  /// `velocity` [m/s]. Counts what the flow does.
  [[nodiscard]] Vec3 dragForce(RegionId region, const Vec3& p, const Vec3& velocity,
                               double share) noexcept;
  /// The lattice's force of `region` at the tip `p` [m]; once a tick. Counts its potential where it jumps.
  [[nodiscard]] Vec3 latticeForce(RegionId region, const Vec3& p) noexcept;

  Contents contents_;

 private:
  /// The algorithm's own tick: `hip` is finite, the force is not limited yet.
  [[nodiscard]] virtual TickResult step(const HipState& hip) noexcept = 0;
  virtual void forget() noexcept = 0;
  /// At least as many crossings as the last step() told events.
  [[nodiscard]] virtual std::span<const PortCrossing> details() const noexcept = 0;

  ForceGuard guard_;
  RegionId start_;
  TickResult last_;
  bool has_hip_ = false;
  Vec3 last_hip_{0.0, 0.0, 0.0};   ///< [m] of the last good tick
  Vec3 flow_push_{0.0, 0.0, 0.0};  ///< [N]
  double lattice_energy_ = 0.0;    ///< [J] at the tip in this tick
  bool in_lattice_ = false;        ///< felt in this tick
  RegionId lattice_region_ = kOutside;
  std::uint32_t lattice_version_ = 0;
  double source_work_ = 0.0;  ///< [J]
};

/// @throws Error (kInput) if the scene is null or asks the paper's renderer for what it cannot do.
[[nodiscard]] std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene,
                                                           RendererSettings settings = {});

}  // namespace palpate
