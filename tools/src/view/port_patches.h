#pragma once
/// Where the ports of a scene are on the surfaces of its layers, for the eye.

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
  /// `size` [m]: of what is looked at.
  PortPatches(ScenePtr scene, double size);

  /// `net`: of the whole surface of the layer `region`. A triangle that a port's rim goes through
  /// is cut up until its parts have sides of a 16th. `is_wanted` is asked now and then; once it
  /// says no, the rest is left out.
  void add(RegionId region, const SurfaceNet& net, const std::function<bool()>& is_wanted);

  /// By PortId; empty where no surface has the port.
  [[nodiscard]] const std::vector<SurfaceNet>& patches() const noexcept { return patches_; }

 private:
  class Cutter;
  /// Where a port's mask is, and how wide at least: triangles there are made no larger.
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
