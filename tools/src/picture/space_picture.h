#pragma once
/// The picture of a scene in space: seen from anywhere, turning, or with a hand that moves in it.

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "picture/canvas.h"
#include "picture/picture.h"

namespace palpate::tools {

struct SpaceView {
  /// From the scene at the viewer; not given: at the front, right and above of the cut, or of y.
  std::optional<Vec3> toward = {};
  struct Around {
    Vec3 center{0.0, 0.0, 0.0};  ///< [m]
    double radius = 0.0;         ///< [m]
  };
  std::optional<Around> around = {};           ///< what is looked at; not given: all
  std::map<std::string, double> opacity = {};  ///< 0 to 1, by layer; others are opaque
  std::vector<CutPlane> slices = {};
  enum class Motion { kNone, kTurn, kReplay } motion = Motion::kNone;
  int frames = 1;  ///< of a turn by 360 degrees, or of the whole track
};

/// Takes a frame of a motion, from 0 on, as a PNG.
using FrameSink = std::function<void(int frame, const std::string& png)>;

/// Without a motion a PNG, else an animated WebP; or, with a sink for the frames, nothing.
/// `picture.plane`, if given, is what is cut along, turned to face the viewer; the track is colored
/// by force.
/// @throws Error: kUsage for a layer that the scene lacks, kOperation, kCancelled.
[[nodiscard]] std::string drawSpacePicture(const Scene& scene, const PictureOptions& picture,
                                           const SpaceView& view, Console& console,
                                           const FrameSink& sink = {});

}  // namespace palpate::tools
