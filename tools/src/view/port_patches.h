#pragma once
/// PortPatches: the parts of layers' surfaces where a scene's ports are, for display.

#include <functional>
#include <vector>

#include "palpate/scene/scene.h"
#include "view/surface_net.h"

namespace palpate::tools {

/// Collects the parts of layers' surfaces that are ports: open ones, and those that open when they
/// are pressed, whatever other ports have to be passed before. Ports of sheets, whose surfaces are
/// not shown, have none.
class PortPatches {
 public:
  /// `size` [m]: diagonal of the viewed box.
  PortPatches(ScenePtr scene, double size);

  /// `net` is the whole surface of the layer `region`. A triangle that crosses a port's rim is cut
  /// up until its parts have sides of a 16th of its own. Asks `is_wanted` now and then; once that
  /// returns false, the rest is left out.
  void add(RegionId region, const SurfaceNet& net, const std::function<bool()>& is_wanted);

  /// By PortId; empty where no surface has the port.
  [[nodiscard]] const std::vector<SurfaceNet>& patches() const noexcept { return patches_; }

 private:
  class Cutter;
  /// The box of a port's mask, and its least width: larger triangles in the box are cut up.
  struct Extent {
    Box3 box;
    double width = 0.0;  ///< [m]
  };
  [[nodiscard]] static Extent extentOf(const Scene& scene, const Port& port);

  ScenePtr scene_;
  double size_;  ///< [m]
  std::vector<SurfaceNet> patches_;
  std::vector<Extent> extents_;  ///< of ports with a mask that has bounds
};

}  // namespace palpate::tools
