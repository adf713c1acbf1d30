#pragma once
/// SceneSwap: hands a scene and its renderer to the servo thread, which neither frees nor waits.

#include <atomic>
#include <memory>
#include <utility>

#include "palpate/render/haptic_renderer.h"

namespace palpate::devices {

/// One thread offers, one takes.
class SceneSwap {
 public:
  SceneSwap() = default;
  ~SceneSwap() {
    delete offered_.load();
    delete retired_.load();
  }
  SceneSwap(const SceneSwap&) = delete;
  SceneSwap& operator=(const SceneSwap&) = delete;

  /// May allocate and free; frees what the servo thread has put away.
  void offer(ScenePtr scene, std::unique_ptr<HapticRenderer> renderer) {
    auto pair = std::make_unique<Pair>(Pair{std::move(scene), std::move(renderer)});
    delete retired_.exchange(nullptr, std::memory_order_acq_rel);
    delete offered_.exchange(pair.release(), std::memory_order_acq_rel);
  }

  /// Real-time safe. True if the offered one took the place of the old one, which the other thread frees later.
  [[nodiscard]] bool take(ScenePtr& scene, std::unique_ptr<HapticRenderer>& renderer) noexcept {
    // A scene is taken only when there is room to put the old one away.
    if (offered_.load(std::memory_order_relaxed) == nullptr ||
        retired_.load(std::memory_order_acquire) != nullptr) {
      return false;
    }
    Pair* pair = offered_.exchange(nullptr, std::memory_order_acq_rel);
    if (pair == nullptr) return false;
    std::swap(scene, pair->scene);
    std::swap(renderer, pair->renderer);
    retired_.store(pair, std::memory_order_release);
    return true;
  }

 private:
  struct Pair {
    ScenePtr scene;
    std::unique_ptr<HapticRenderer> renderer;
  };
  std::atomic<Pair*> offered_{nullptr};
  std::atomic<Pair*> retired_{nullptr};
};

}  // namespace palpate::devices
