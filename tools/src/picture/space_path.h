#pragma once
/// The path of the tip in a picture in space, colored by the force on the hand.

#include <functional>
#include <vector>

#include "picture/ray_march.h"
#include "picture/sheet.h"

namespace palpate::tools {

class SpacePath {
 public:
  /// Maps a point [m] to the sheet.
  using Place = std::function<Pixel(const Vec3&)>;

  /// Long tracks are reduced to fewer points.
  explicit SpacePath(const Track& track);

  [[nodiscard]] bool empty() const noexcept { return shown_.empty(); }
  [[nodiscard]] std::size_t size() const noexcept { return shown_.size(); }
  [[nodiscard]] std::vector<Vec3> tips() const;

  /// Finds the points that are hidden from `camera`.
  void look(const SpaceScene& space, const Camera& camera);
  /// Draws the first `count` points; hidden parts thin and faint.
  void draw(Sheet& s, const Place& at, std::size_t count) const;
  /// Draws hand, tip and force at point `index`; the longest force is drawn `longest` pixels long.
  void drawHand(Sheet& s, const Camera& camera, const Place& at, std::size_t index,
                double longest) const;
  /// Draws the key of the colors, below `y` in the right column.
  void drawBar(Sheet& s, double y) const;

 private:
  [[nodiscard]] int shadeAt(std::size_t i) const;

  std::vector<Track::Point> shown_;
  std::vector<bool> is_hidden_;
  double peak_ = 0.0;  ///< [N]
};

/// The color of a path where the force is `share` of the largest.
[[nodiscard]] Color forceColor(double share);

}  // namespace palpate::tools
