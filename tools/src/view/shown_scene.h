#pragma once
/// ShownScene: a scene in the form that a page shows: names, colors, words; and surfaces, ports and
/// gray slices, which are made one after another.

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
#include "view/gray_slices.h"
#include "view/surface_net.h"

namespace palpate::tools {

/// The box of everything bounded, with a margin for the view.
[[nodiscard]] Box3 viewBox(const Scene& scene);

/// The starting place of a hand without a place of its own: in the start region, above the scene if
/// that is the outside.
[[nodiscard]] Vec3 handStart(const Scene& scene);

/// The feeling of the probe, in words. A parameter that differs from place to place is given by its
/// value at the proxy.
struct FeltWords {
  std::string content;  ///< of the proxy's region; empty: it is not felt
  std::string wall;     ///< the pressed wall; empty: none
};
[[nodiscard]] FeltWords feltAt(const Scene& scene, const Vec3& hip, const TickResult& result);

class ShownScene {
 public:
  /// Largest error of surfaces, as a share of the view's diagonal, if the finest lattice can reach
  /// it.
  static constexpr double kTolerance = 5e-4;

  /// Reads the needed parts of `loaded`, and makes the rest in a separate thread. `number`: how
  /// many scenes were shown before.
  ShownScene(ScenePtr scene, const LoadedScene& loaded, std::string text, int number);
  ~ShownScene();
  ShownScene(const ShownScene&) = delete;
  ShownScene& operator=(const ShownScene&) = delete;

  [[nodiscard]] const Scene& scene() const noexcept { return *scene_; }
  [[nodiscard]] int number() const noexcept { return number_; }
  [[nodiscard]] const Json& json() const noexcept { return json_; }
  [[nodiscard]] const std::string& text() const noexcept { return text_; }
  /// The surface of a region. Null if it is not made yet, or if the region has none.
  [[nodiscard]] std::shared_ptr<const std::string> surface(std::size_t region) const;
  /// The number of regions whose surfaces are done, in the order of regions.
  [[nodiscard]] int surfacesDone() const noexcept { return done_.load(); }
  /// The parts of surfaces where the port is, in the form of surface(). Null if they are not made
  /// yet, or if no surface has the port.
  [[nodiscard]] std::shared_ptr<const std::string> port(std::size_t port) const;
  [[nodiscard]] bool portsDone() const noexcept { return are_ports_done_.load(); }
  /// The gray slices of the scene's first image that is not a label image. Null if they are not
  /// made yet, or if there are none.
  [[nodiscard]] std::shared_ptr<const GraySlices> slices() const;

 private:
  struct LayerNet {
    RegionId region = kOutside;
    SurfaceNet net;
  };

  void make();
  /// Makes the layers' surfaces. Returns their nets, or none if the scene has no ports.
  [[nodiscard]] std::vector<LayerNet> makeSurfaces();
  void makePorts(const std::vector<LayerNet>& nets);
  void makeSlices();

  ScenePtr scene_;
  int number_;
  std::string text_;
  Json json_;
  std::vector<SceneImage> images_;
  mutable std::mutex mutex_;
  std::vector<std::shared_ptr<const std::string>> surfaces_;
  std::vector<std::shared_ptr<const std::string>> ports_;
  std::shared_ptr<const GraySlices> slices_;
  std::atomic<int> done_{0};
  std::atomic<bool> are_ports_done_{false};
  std::atomic<bool> stop_{false};
  std::thread thread_;
};

}  // namespace palpate::tools
