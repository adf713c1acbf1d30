#pragma once
/// The common part of both renderers: the state that they own, changed contents, the limits of the
/// force, and the count of sources.

#include <span>
#include <utility>

#include "palpate/render/contents.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/render/tick_state.h"

namespace palpate {

class RendererBase : public HapticRenderer {
 public:
  [[nodiscard]] TickResult update(const HipState& hip) noexcept final;
  [[nodiscard]] std::span<const PortCrossing> crossings() const noexcept final {
    return details().first(crossing_count_);
  }
  [[nodiscard]] std::span<const RegionEntry> entries() const noexcept final {
    return entered().first(entry_count_);
  }
  [[nodiscard]] bool setContent(RegionId region, const ContentChange& change) noexcept final {
    return contents_.change(region, change);
  }
  [[nodiscard]] const Vec3& unlimitedForce() const noexcept final { return unlimited_; }
  [[nodiscard]] ForceSlope slope(const HipState& hip) const noexcept final;
  [[nodiscard]] double sourceWork() const noexcept final { return state_.source.work; }
  void reset() noexcept final;
  [[nodiscard]] RendererState state() const noexcept final { return state_.sealed(); }
  [[nodiscard]] RendererState checkpoint() noexcept final {
    resume();
    return state_.sealed();
  }
  [[nodiscard]] bool setState(const RendererState& sealed) noexcept final;

 protected:
  RendererBase(ScenePtr scene, RendererKind kind, const ForceLimits& limits)
      : scene_(std::move(scene)), contents_(*scene_), kind_(kind) {
    state_.kind = kind;
    state_.guard = ForceGuard(limits.over(scene_->forceLimits()));
    state_.last.region = scene_->startRegion();  // reported until the first good tick
  }

  /// Drag of the content of `region` at the tip `p` [m], reduced to `share`, on a hand that moves
  /// at `velocity` [m/s]. Also counts the work of the flow.
  [[nodiscard]] Vec3 dragForce(RegionId region, const Vec3& p, const Vec3& velocity,
                               double share) noexcept;
  /// The lattice's force of `region` at the tip `p` [m]; to be called once a tick. Also counts
  /// jumps of its potential.
  [[nodiscard]] Vec3 latticeForce(RegionId region, const Vec3& p) noexcept;

  ScenePtr scene_;
  TickState state_;
  Contents contents_;

 private:
  /// The algorithm's own tick: `hip` is finite, the returned force is not limited yet. state_.hip
  /// is the hand's position in the tick before.
  [[nodiscard]] virtual TickResult step(const HipState& hip) noexcept = 0;
  /// Called after state_ was replaced: computes anew what is derived from it.
  virtual void resume() noexcept = 0;
  /// The crossings of the last step(), at least as many as it reported events.
  [[nodiscard]] virtual std::span<const PortCrossing> details() const noexcept = 0;
  /// The entries of the last step().
  [[nodiscard]] virtual std::span<const RegionEntry> entered() const noexcept = 0;

  RendererKind kind_;
  Vec3 unlimited_{0.0, 0.0, 0.0};   ///< [N] of the last tick
  std::size_t crossing_count_ = 0;  ///< of the last tick
  std::size_t entry_count_ = 0;     ///< of the last tick
};

}  // namespace palpate
