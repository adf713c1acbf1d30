#pragma once
/// The picture of a scene in space: seen from anywhere, turning, or with a hand that moves in it.

#include <map>
#include <optional>
#include <string>

#include "picture/canvas.h"
#include "picture/picture.h"

namespace palpate::tools {

struct SpaceView {
  /// From the scene at the viewer; not given: at the front, right and above of the cut, or of y.
  std::optional<Vec3> toward = {};
  std::map<std::string, double> opacity = {};  ///< 0 to 1, by layer; others are opaque
  enum class Motion { kNone, kTurn, kReplay } motion = Motion::kNone;
  int frames = 1;  ///< of a turn by 360 degrees, or of the whole track
};

/// Without a motion a PNG, else an animated WebP. `picture.plane`, if given, is what is cut along, turned to face the viewer; the
/// track is colored by force. @throws Error: kUsage for a layer that the scene lacks, kOperation, kCancelled.
[[nodiscard]] std::string drawSpacePicture(const Scene& scene, const PictureOptions& picture,
                                           const SpaceView& view, Console& console);

/// How a track is colored where the force is `share` of the largest.
[[nodiscard]] Color forceColor(double share);

}  // namespace palpate::tools
