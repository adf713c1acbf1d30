#include "picture/space_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/core/error.h"
#include "palpate/scene/suggestion.h"
#include "picture/animation.h"
#include "picture/cutaway.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

constexpr int kShades = 32;             // of a track
constexpr int kFrameTime = 50;          // [ms]
constexpr double kLongestForce = 0.16;  // of the panel's height
constexpr std::size_t kMostPoints = 4000;
constexpr double kRoom = 0.02;  // around the scene, of its size

/// What is on every frame, and what differs.
class SpaceSheet {
 public:
  SpaceSheet(const Scene& scene, const PictureOptions& picture, const SpaceView& view,
             Console& console)
      : view_(view),
        track_(picture.track),
        bare_(withoutTrack(picture)),
        sheet_(scene, bare_),
        console_(console),
        space_{scene, sheet_.paint, boxOf(scene, picture.track), picture.plane, opacities(scene)} {
    Sheet& s = sheet_;
    s.side = s.px(430);
    s.left = s.px(24);
    s.top = s.px(84);
    width_ = std::max(64, static_cast<int>(bare_.width - s.left - s.side - s.px(20)));
    height_ = std::max(64, static_cast<int>(bare_.height - s.top - s.px(24)));
    for (std::size_t i = 0; i < scene.regions().size(); ++i) {
      if (opacity(i) > 0.0) s.section.cells.push_back(i);  // for the legend
    }
    const std::size_t stride = std::max<std::size_t>(1, track_.points.size() / kMostPoints);
    for (std::size_t i = 0; i < track_.points.size(); i += stride)
      shown_.push_back(track_.points[i]);
    for (const Track::Point& p : track_.points) peak_ = std::max(peak_, glm::length(p.force));
    Vec3 toward = view_.toward.value_or(cameraOn(planeAcross(1, 0.0, s.unit)).toward);
    if (space_.plane) {
      if (!view_.toward) toward = cameraOn(*space_.plane).toward;
      CutPlane& plane = *space_.plane;
      if (glm::dot(plane.normal(), toward) < 0.0) plane.right = -plane.right;
    }
    toward_ = toward;
  }

  std::string draw() {
    if (view_.motion == SpaceView::Motion::kNone) {
      fit(0.0);
      frame(render(), shown_.size());
      return sheet_.canvas.png();
    }
    Animation animation(bare_.width, bare_.height);
    if (view_.motion == SpaceView::Motion::kTurn) {
      fitAll();
      for (int i = 0; i < view_.frames; ++i) {
        checkStop();
        turn(2.0 * std::numbers::pi * i / view_.frames);
        frame(render(), shown_.size());
        animation.add(sheet_.canvas, kFrameTime);
      }
    } else {
      fit(0.0);
      const Raster raster = render();
      for (int i = 0; i < view_.frames; ++i) {
        checkStop();
        const auto last = static_cast<std::size_t>(i + 1) * shown_.size() /
                          static_cast<std::size_t>(view_.frames);
        frame(raster, std::max<std::size_t>(last, 1));
        animation.add(sheet_.canvas, kFrameTime);
      }
    }
    return animation.finish();
  }

 private:
  static PictureOptions withoutTrack(PictureOptions picture) {
    picture.track = {};
    return picture;
  }
  static Box3 boxOf(const Scene& scene, const Track& track) {
    Box3 box = scene.bounds().unitedWith(track.bounds());
    constexpr double kEmpty = 0.1;  // [m] to each side, of a scene without a bounded layer
    if (box.isEmpty()) box = {Vec3(-kEmpty), Vec3(kEmpty)};
    return box.grownBy(std::max(kRoom * glm::length(box.size()), 1e-6));
  }
  [[nodiscard]] std::vector<double> opacities(const Scene& scene) const {
    std::vector<double> all(scene.regions().size(), 1.0);
    std::vector<std::string_view> known;
    for (std::size_t i = 1; i < all.size(); ++i) known.push_back(scene.regions()[i].name);
    for (const auto& [name, share] : view_.opacity) {
      const auto at = std::find(known.begin(), known.end(), name);
      if (at == known.end()) {
        throw Error(ErrorKind::kUsage,
                    {"usage.render", "--opacity: the scene has no layer '" + name + "'",
                     suggestionFor(name, known, "palpate info lists them")});
      }
      all[static_cast<std::size_t>(at - known.begin()) + 1] = share;
    }
    return all;
  }
  [[nodiscard]] double opacity(std::size_t region) const { return space_.opacity[region]; }

  void turn(double angle) {
    const Vec3 t = toward_;
    const double c = std::cos(angle);
    const double s = std::sin(angle);
    const Camera turned = cameraFrom({c * t.x - s * t.y, s * t.x + c * t.y, t.z});
    camera_.toward = turned.toward;
    camera_.right = turned.right;
    camera_.up = turned.up;
  }
  void fit(double angle) {
    turn(angle);
    std::vector<Vec3> points;
    points.reserve(shown_.size());
    for (const Track::Point& p : shown_) points.push_back(p.proxy);
    fitCamera(camera_, space_, points, width_, height_);
  }
  /// So that nothing leaves the picture on the way round, and nothing jumps.
  void fitAll() {
    camera_.width = width_;
    camera_.height = height_;
    camera_.center = space_.box.center();
    const Vec3 half = 0.5 * space_.box.size();
    const double tilt = std::abs(glm::normalize(toward_).z);
    const double across = std::hypot(half.x, half.y);
    const double upright = half.z * std::sqrt(1.0 - tilt * tilt) + across * tilt;
    camera_.step = std::max(2.0 * across / width_, 2.0 * upright / height_);
  }

  Raster render() { return drawSpace(space_, camera_, console_.progress()); }

  [[nodiscard]] Pixel at(const Vec3& p) const { return sheet_.onSheet(camera_.pixel(p)); }

  void frame(const Raster& raster, std::size_t points) {
    Sheet& s = sheet_;
    s.canvas.fill(rgb(0xFFFFFF));
    TextStyle head = s.font(23);
    head.bold = true;
    s.canvas.text({s.left, s.px(38)}, bare_.title, head);
    const std::string cut = space_.plane ? "cut " + space_.plane->name : "in space";
    s.canvas.text({s.left, s.px(64)}, cut, s.font(15, kFaintInk));
    s.canvas.clip(s.left, s.top, width_, height_);
    s.canvas.image(raster, s.left, s.top);
    drawPath(points);
    s.canvas.unclip();
    drawBar(drawLegend(s, s.top - s.px(20)));
  }

  void drawPath(std::size_t count) {
    Sheet& s = sheet_;
    if (shown_.empty()) return;
    std::vector<Pixel> line;
    line.reserve(count);
    for (std::size_t i = 0; i < count; ++i) line.push_back(at(shown_[i].proxy));
    s.canvas.line(line, {rgb(0xFFFFFF, 0.85), s.px(6.5)});
    for (std::size_t i = 0; i + 1 < count;) {
      // Neighbors of one shade are one stroke.
      const int shade = shadeAt(i);
      std::size_t end = i + 1;
      while (end + 1 < count && shadeAt(end) == shade) ++end;
      s.canvas.line({line.begin() + static_cast<std::ptrdiff_t>(i),
                     line.begin() + static_cast<std::ptrdiff_t>(end) + 1},
                    {forceColor((shade + 0.5) / kShades), s.px(3.6)});
      i = end;
    }
    if (view_.motion != SpaceView::Motion::kReplay) return;
    const Track::Point& now = shown_[count - 1];
    const Pixel tip = at(now.proxy);
    const Pixel hand = at(now.hip);
    s.canvas.line({tip, hand}, {kHipInk, s.px(2), {s.px(5), s.px(4)}});
    s.canvas.disk(hand, s.px(6), kHipInk);
    s.canvas.disk(tip, s.px(8), rgb(0xFFFFFF));
    s.canvas.disk(tip, s.px(6.5), kProxyInk);
    if (!(peak_ > 0.0)) return;
    const double length = kLongestForce * height_ / peak_;
    s.canvas.arrow(tip,
                   {tip.x + length * glm::dot(now.force, camera_.right),
                    tip.y - length * glm::dot(now.force, camera_.up)},
                   {kForceInk, s.px(3)}, s.px(12));
    s.canvas.text({s.left + s.px(8), s.top + height_ - s.px(10)},
                  formatNumber(glm::length(now.force), 2) + " N", s.font(20, kForceInk));
  }

  [[nodiscard]] int shadeAt(std::size_t i) const {
    if (!(peak_ > 0.0)) return 0;
    const double share = glm::length(shown_[i].force) / peak_;
    return std::clamp(static_cast<int>(kShades * share), 0, kShades - 1);
  }

  /// What the colors of the path mean.
  void drawBar(double y) {
    Sheet& s = sheet_;
    if (shown_.empty()) return;
    const double x = bare_.width - s.side + s.px(4);
    y += s.px(24);
    s.canvas.text({x, y}, "path of the tip, by the force on the hand", s.font(15));
    const double step = s.px(300) / kShades;
    for (int i = 0; i < kShades; ++i) {
      s.canvas.rectangle(x + i * step, y + s.px(10), step + 1.0, s.px(12),
                         forceColor((i + 0.5) / kShades));
    }
    s.canvas.text({x, y + s.px(40)}, "0", s.font(13, kFaintInk));
    TextStyle end = s.font(13, kFaintInk);
    end.align = Align::kRight;
    s.canvas.text({x + s.px(300), y + s.px(40)}, formatNumber(peak_, 3) + " N", end);
  }

  const SpaceView& view_;
  const Track& track_;
  PictureOptions bare_;
  Sheet sheet_;
  Console& console_;
  SpaceScene space_;
  Camera camera_;
  Vec3 toward_{0.0, -1.0, 0.0};
  std::vector<Track::Point> shown_;
  double peak_ = 0.0;  ///< [N]
  int width_ = 0;
  int height_ = 0;
};

}  // namespace

Color forceColor(double share) {
  // From dark to bright, blue to yellow, so that also eyes that tell red from green badly see which is more.
  constexpr Color kLow = rgb(0x1F3FA8);
  constexpr Color kMiddle = rgb(0xC3426B);
  constexpr Color kHigh = rgb(0xF5B70B);
  return share < 0.5 ? mixed(kLow, kMiddle, 2.0 * share) : mixed(kMiddle, kHigh, 2.0 * share - 1.0);
}

std::string drawSpacePicture(const Scene& scene, const PictureOptions& picture,
                             const SpaceView& view, Console& console) {
  return SpaceSheet(scene, picture, view, console).draw();
}

}  // namespace palpate::tools
