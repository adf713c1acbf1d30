#pragma once
/// SceneSwap: hands a scene and its renderer to the servo thread, which neither frees memory nor
/// waits.

#include <atomic>
#include <cstdint>
#include <memory>
#include <optional>
#include <utility>

#include "palpate/render/haptic_renderer.h"

namespace palpate::devices {

/// Data of an offer that the servo thread needs when it takes the scene.
struct OfferTag {
  std::uint64_t number = 0;  ///< of the offer, counted from 1; a scene may be offered several times
  std::uint64_t scene = 0;   ///< SessionTick::scene
  bool goes_on = false;      ///< SceneOffer::goes_on
  double max_growth = kInfinity;  ///< [N/s] limit of the force in this scene
};

/// A scene and its renderer on their way to the servo thread, and the state that the offer is based
/// on.
struct OfferedScene {
  ScenePtr scene;
  std::unique_ptr<HapticRenderer> renderer;
  OfferTag tag = {};
  /// The number of regions that the probe had entered when the renderer's state was taken; no value
  /// if it has no earlier state.
  std::optional<std::uint64_t> entries = {};
};

/// One thread offers, one thread takes.
class SceneSwap {
 public:
  SceneSwap() = default;
  ~SceneSwap() {
    delete offered_.load();
    delete retired_.load();
  }
  SceneSwap(const SceneSwap&) = delete;
  SceneSwap& operator=(const SceneSwap&) = delete;

  /// May allocate and free; frees what the servo thread has put away. Returns the number of the
  /// scene that was offered before and will never be taken, if there is one.
  std::optional<std::uint64_t> offer(OfferedScene offered) {
    auto made = std::make_unique<OfferedScene>(std::move(offered));
    delete retired_.exchange(nullptr, std::memory_order_acq_rel);
    const std::unique_ptr<OfferedScene> forgotten(
        offered_.exchange(made.release(), std::memory_order_acq_rel));
    return forgotten ? std::optional(forgotten->tag.number) : std::nullopt;
  }

  enum class Taken { kNothing, kOld, kNew };
  /// Real-time safe. kNew: the offered scene and renderer replaced `scene` and `renderer`, which
  /// the other thread frees later. kOld: the offer is based on a state from before the last of
  /// `entries` regions, and was put away.
  [[nodiscard]] Taken take(ScenePtr& scene, std::unique_ptr<HapticRenderer>& renderer,
                           std::uint64_t entries, OfferTag& tag) noexcept {
    // A scene is taken only if there is room to put the old one away.
    if (offered_.load(std::memory_order_relaxed) == nullptr ||
        retired_.load(std::memory_order_acquire) != nullptr) {
      return Taken::kNothing;
    }
    OfferedScene* offered = offered_.exchange(nullptr, std::memory_order_acq_rel);
    if (offered == nullptr) return Taken::kNothing;
    const bool is_old = offered->entries && *offered->entries != entries;
    tag = offered->tag;
    if (!is_old) {
      std::swap(scene, offered->scene);
      std::swap(renderer, offered->renderer);
    }
    retired_.store(offered, std::memory_order_release);
    return is_old ? Taken::kOld : Taken::kNew;
  }

 private:
  std::atomic<OfferedScene*> offered_{nullptr};
  std::atomic<OfferedScene*> retired_{nullptr};
};

}  // namespace palpate::devices
