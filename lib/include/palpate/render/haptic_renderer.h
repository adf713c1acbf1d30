#pragma once
/// HapticRenderer: HIP in, force out, one tick at a time. The scene is shared and const; all that changes from tick
/// to tick is the RendererState owned here, and what was changed of the contents.

#include <memory>
#include <optional>
#include <span>
#include <utility>

#include "palpate/contact/force_guard.h"
#include "palpate/render/contents.h"
#include "palpate/render/renderer_state.h"
#include "palpate/render/tick.h"
#include "palpate/scene/scene.h"

namespace palpate {

struct RendererSettings {
  std::optional<RendererKind> kind = {};  ///< not given: as the scene says
  PaperParameters paper = {};             ///< paper's renderer only; goes before the scene's own
  ForceLimits limits = {};                ///< none unless asked for, so that closed forms hold
};

/// One algorithm of haptic rendering. Construction may throw and allocate; all else never allocates, locks, throws or
/// blocks, and belongs to one thread at a time.
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
    return details().first(crossing_count_);
  }

  /// The regions that the proxy came into in the last update(), in path order: each layer that it went through, however
  /// many there were. The last one is TickResult::region, if there is any. Valid until the next update().
  [[nodiscard]] std::span<const RegionEntry> entries() const noexcept {
    return entered().first(entry_count_);
  }

  /// From the next tick on, the content of `region` feels as `change` says; what is felt may jump. False, and
  /// nothing is changed, for an unknown region or a value out of its range. Real-time safe, on the thread
  /// that update() is called on. It stays so after reset(); an empty change takes it back.
  [[nodiscard]] bool setContent(RegionId region, const ContentChange& change) noexcept {
    return contents_.change(region, change);
  }

  /// [N, world] The force of the last update() before its limits; zero if that held the last state.
  [[nodiscard]] const Vec3& unlimitedForce() const noexcept { return unlimited_; }

  /// [J] Work on the hand since the first tick, up to the last, of what is a source of energy by its nature: flows,
  /// lattices whose potential differs where a region is entered and left, and walls that give way while the hand is so
  /// far ahead that the next one it comes to press holds more than they did. A hand that got no more than
  /// this from the renderer met a passive world. Counted before the limits of the force.
  [[nodiscard]] double sourceWork() const noexcept { return state_.source.work; }

  /// Back to the start region, with no port passed and no hole made; the next update() is a first tick.
  void reset() noexcept;

  /// All that the last tick left for the next.
  [[nodiscard]] const RendererState& state() const noexcept { return state_; }
  /// The same, and this renderer goes on from it as each other does that is given it: bit for bit. What it knows of the
  /// leaves around the proxy it finds anew in the next tick.
  [[nodiscard]] const RendererState& checkpoint() noexcept {
    resume();
    return state_;
  }
  /// Goes on from `state` as the renderer that it was taken from would: bit for bit if that gave it by checkpoint(), else
  /// but for rounding, since what a renderer knows of the leaves around the proxy, which is not in the state, decides
  /// which of them it looks at once more. False, and nothing is changed, if it cannot be a state of this scene. What
  /// setContent() changed is not part of it. Until the next tick crossings() and entries() are empty.
  [[nodiscard]] bool setState(const RendererState& state) noexcept;

 protected:
  HapticRenderer(ScenePtr scene, const ForceLimits& limits)
      : scene_(std::move(scene)), contents_(*scene_) {
    state_.guard = ForceGuard(limits);
    state_.last.region = scene_->startRegion();  // reported until the first good tick
  }

  /// Drag of the content of `region` at the tip `p` [m], of which `share` is felt by a hand that moves at
  /// `velocity` [m/s]. Counts what the flow does.
  [[nodiscard]] Vec3 dragForce(RegionId region, const Vec3& p, const Vec3& velocity,
                               double share) noexcept;
  /// The lattice's force of `region` at the tip `p` [m]; once a tick. Counts its potential where it jumps.
  [[nodiscard]] Vec3 latticeForce(RegionId region, const Vec3& p) noexcept;

  ScenePtr scene_;
  RendererState state_;
  Contents contents_;

 private:
  /// The algorithm's own tick: `hip` is finite, the force is not limited yet. state_.hip is that of the tick before.
  [[nodiscard]] virtual TickResult step(const HipState& hip) noexcept = 0;
  /// state_ was replaced: what is derived from it is to be made anew.
  virtual void resume() noexcept = 0;
  /// At least as many crossings as the last step() reported events.
  [[nodiscard]] virtual std::span<const PortCrossing> details() const noexcept = 0;
  /// The entries of the last step().
  [[nodiscard]] virtual std::span<const RegionEntry> entered() const noexcept = 0;

  Vec3 unlimited_{0.0, 0.0, 0.0};   ///< [N] of the last tick
  std::size_t crossing_count_ = 0;  ///< of the last tick
  std::size_t entry_count_ = 0;     ///< of the last tick
};

/// @throws Error (kInput) if the scene is null or asks the paper's renderer for what it cannot do.
[[nodiscard]] std::unique_ptr<HapticRenderer> makeRenderer(ScenePtr scene,
                                                           RendererSettings settings = {});

}  // namespace palpate
