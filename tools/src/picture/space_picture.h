#pragma once
/// A picture of a scene in space: seen from any side, turning, or with a hand moving in it.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "picture/canvas.h"
#include "picture/picture.h"

namespace palpate::tools {

struct SpaceView {
  /// Direction from the scene to the viewer; not given: at the front, right and above of the cut,
  /// or of a cut across y.
  std::optional<Vec3> toward = {};
  struct Around {
    Vec3 center{0.0, 0.0, 0.0};  ///< [m]
    double radius = 0.0;         ///< [m]
  };
  std::optional<Around> around = {};           ///< the part to show; not given: all
  std::map<std::string, double> opacity = {};  ///< 0 to 1, by layer; others are opaque
  std::vector<CutPlane> slices = {};
  enum class Motion { kNone, kTurn, kReplay } motion = Motion::kNone;
  int frames = 1;  ///< number of frames of a turn by 360 degrees, or of the whole track
};

/// Receives each frame of a motion, counted from 0, as a PNG.
using FrameSink = std::function<void(int frame, const std::string& png)>;

/// Returns a PNG without a motion, else an animated WebP; nothing if `sink` takes the frames.
/// `picture.plane`, if given, is the plane of the cut, turned to face the viewer; the track is
/// colored by force.
/// @throws Error: kUsage for a layer that the scene lacks, kOperation, kCancelled.
[[nodiscard]] std::string drawSpacePicture(const Scene& scene, const PictureOptions& picture,
                                           const SpaceView& view, Console& console,
                                           const FrameSink& sink = {});

}  // namespace palpate::tools
