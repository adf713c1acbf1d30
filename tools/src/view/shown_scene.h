#pragma once
/// ShownScene: a scene as a page shows it: names, colors, words, and surfaces that are made one
/// after the other.

#include <atomic>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "loaded_scene.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene.h"
#include "report.h"

namespace palpate::tools {

/// Room around all that has bounds, for the eye.
[[nodiscard]] Box3 viewBox(const Scene& scene);

/// Where a hand begins that has no place of its own: in the start region, above the scene if that
/// is the outside.
[[nodiscard]] Vec3 handStart(const Scene& scene);

/// What the probe feels at a place, in words.
struct FeltWords {
  std::string content;  ///< of the proxy's region; empty: nothing is felt in it
  std::string wall;     ///< that is pressed; empty: none
};
[[nodiscard]] FeltWords feltAt(const Scene& scene, const Vec3& hip, const TickResult& result);

class ShownScene {
 public:
  /// Surfaces err by this share of the view's diagonal at most, where the finest lattice allows.
  static constexpr double kTolerance = 5e-4;

  /// Reads what it needs of `loaded`, and makes the surfaces in a thread of its own. `number`: how
  /// many scenes were shown before.
  ShownScene(ScenePtr scene, const LoadedScene& loaded, std::string text, int number);
  ~ShownScene();
  ShownScene(const ShownScene&) = delete;
  ShownScene& operator=(const ShownScene&) = delete;

  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] const Json& json() const noexcept { return json_; }
  /// Null if it was not made yet, or there is none.
  [[nodiscard]] std::shared_ptr<const std::string> surface(std::size_t region) const;
  /// How many regions were looked at so far, in their order.
  [[nodiscard]] int surfacesDone() const noexcept { return done_.load(); }

 private:
  void makeSurfaces();

  ScenePtr scene_;
  int number_;
  Json json_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const std::string>> surfaces_;
  std::atomic<int> done_{0};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::tools
