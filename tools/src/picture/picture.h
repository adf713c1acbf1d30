#pragma once
/// The picture of a scene: a flat section with names, walls, ports, the hand's path and the forces;
/// the scene in space with its front cut away; and a legend.

#include <map>
#include <memory>
#include <optional>
#include <string>

#include "console.h"
#include "loaded_scene.h"
#include "palpate/scene/scene.h"
#include "palpate/vdb/image.h"
#include "picture/cut_plane.h"
#include "picture/track.h"

namespace palpate::tools {

struct PictureOptions {
  std::string title;
  std::optional<CutPlane> plane;            ///< not given: along the track, or through the middle
  int width = 1600;                         ///< [pixels]
  int height = 1000;                        ///< [pixels]
  Track track;                              ///< may be empty
  std::shared_ptr<const vdb::Image> image;  ///< gray values; may be null
  /// For layers that have a color of their own
  std::map<std::string, vdb::LabelColor> colors = {};
  bool anatomical = false;    ///< x, y, z run to the right, the front and up
  double line_spacing = 0.0;  ///< [m] spacing of the lines of equal distance; 0: none
  int forces = 0;             ///< number of restForces() arrows along the longer side; 0: none
};

/// The image with the gray values to show: the one of a scene's `images` called `wanted`, else the
/// file `wanted`; if `wanted` is empty, the first of `images` without label names; null if there is
/// none. @throws Error (kInput).
[[nodiscard]] std::shared_ptr<const vdb::Image> pictureImage(const std::vector<SceneImage>& images,
                                                             const std::string& wanted);

struct Picture {
  std::string png;  ///< the file's bytes
  CutPlane plane;   ///< the plane of the cut
};

/// @throws Error: kOperation, kCancelled.
[[nodiscard]] Picture drawPicture(const Scene& scene, const PictureOptions& options,
                                  Console& console);

}  // namespace palpate::tools
