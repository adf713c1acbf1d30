#include "picture/space_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "palpate/core/error.h"
#include "palpate/scene/suggestion.h"
#include "palpate/vdb/text.h"
#include "picture/animation.h"
#include "picture/cutaway.h"
#include "picture/sheet.h"
#include "picture/space_path.h"

namespace palpate::tools {
namespace {

constexpr int kFrameTime = 50;          // [ms]
constexpr double kLongestForce = 0.16;  // share of the panel's height
constexpr double kRoom = 0.02;          // margin around the scene, as a share of its size
constexpr double kEmpty = 0.1;  // [m] half width of the view of a scene without a bounded layer

PictureOptions withoutTrack(PictureOptions picture) {
  picture.track = {};
  return picture;
}

Box3 boxOf(const Scene& scene, const Track& track) {
  Box3 box = scene.bounds().unitedWith(track.bounds());
  if (box.isEmpty()) box = {Vec3(-kEmpty), Vec3(kEmpty)};
  return box.grownBy(std::max(kRoom * glm::length(box.size()), 1e-6));
}

std::vector<double> opacities(const Scene& scene, const SpaceView& view) {
  std::vector<double> all(scene.regions().size(), 1.0);
  std::vector<std::string_view> known;
  for (std::size_t i = 1; i < all.size(); ++i) known.push_back(scene.regions()[i].name);
  for (const auto& [name, share] : view.opacity) {
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

/// The parts that all frames share, and those that differ.
class SpaceSheet {
 public:
  SpaceSheet(const Scene& scene, const PictureOptions& picture, const SpaceView& view,
             Console& console)
      : view_(view),
        bare_(withoutTrack(picture)),
        sheet_(scene, bare_),
        console_(console),
        path_(picture.track),
        space_{scene,
               sheet_.paint,
               boxOf(scene, picture.track),
               picture.plane,
               opacities(scene, view),
               view.slices,
               sheet_.lines ? &*sheet_.lines : nullptr} {
    Sheet& s = sheet_;
    s.side = s.px(430);
    s.left = s.px(24);
    s.top = s.px(84);
    s.view.width = std::max(64, static_cast<int>(bare_.width - s.left - s.side - s.px(20)));
    s.view.height = std::max(64, static_cast<int>(bare_.height - s.top - s.px(24)));
    fillLegend();
    Vec3 toward = view_.toward.value_or(cameraOn(planeAcross(1, 0.0, s.unit)).toward);
    if (space_.plane) {
      if (!view_.toward) toward = cameraOn(*space_.plane).toward;
      CutPlane& plane = *space_.plane;
      if (glm::dot(plane.normal(), toward) < 0.0) plane.right = -plane.right;
      s.plane = plane;
    }
    ahead_ = cameraFrom(toward);
  }

  std::string draw(const FrameSink& sink) {
    if (space_.plane) feelPlane(sheet_, space_.box, console_.progress());
    if (view_.motion == SpaceView::Motion::kNone) {
      look(0.0);
      frame(render(), path_.size());
      return sheet_.canvas.png();
    }
    std::optional<Animation> animation;
    if (!sink) animation.emplace(bare_.width, bare_.height);
    std::optional<Raster> raster;
    for (int i = 0; i < view_.frames; ++i) {
      checkStop();
      if (view_.motion == SpaceView::Motion::kTurn) {
        look(2.0 * std::numbers::pi * i / view_.frames);
        frame(render(), path_.size());
      } else {
        if (!raster) {
          look(0.0);
          raster = render();
        }
        const auto last =
            static_cast<std::size_t>(i + 1) * path_.size() / static_cast<std::size_t>(view_.frames);
        frame(*raster, std::max<std::size_t>(last, 1));
      }
      if (sink) sink(i, sheet_.canvas.png());
      if (animation) animation->add(sheet_.canvas, kFrameTime);
    }
    return animation ? animation->finish() : std::string();
  }

 private:
  /// The legend lists the contents of the section: here, everything in the scene that is visible.
  void fillLegend() {
    Sheet& s = sheet_;
    s.opacity = space_.opacity;
    for (std::size_t i = 1; i < s.scene.regions().size(); ++i) {
      if (s.opacity[i] <= 0.0) continue;
      s.section.cells.push_back(i);
    }
    if (s.scene.ports().empty()) return;
    Boundary port;
    port.kind = Boundary::Kind::kPort;
    s.section.boundaries.push_back(std::move(port));
  }

  /// Turns the camera about z from its first position.
  void look(double angle) {
    const auto turned = [&](const Vec3& v) {
      const double c = std::cos(angle);
      const double s = std::sin(angle);
      return Vec3(c * v.x - s * v.y, s * v.x + c * v.y, v.z);
    };
    const int width = sheet_.view.width;
    const int height = sheet_.view.height;
    camera_.toward = turned(ahead_.toward);
    camera_.right = turned(ahead_.right);
    camera_.up = turned(ahead_.up);
    camera_.width = width;
    camera_.height = height;
    if (view_.around) {
      camera_.center = view_.around->center;
      camera_.step = 2.0 * view_.around->radius / std::min(width, height);
    } else if (view_.motion == SpaceView::Motion::kTurn) {
      fitAll();
    } else {
      fitCamera(camera_, space_, path_.tips(), width, height);
    }
    sheet_.view.step = camera_.step;
    if (sheet_.lines) sheet_.lines->check(camera_.step);
    path_.look(space_, camera_);
  }
  /// Fits all frames, so that nothing leaves the picture during a turn and the scale does not jump.
  void fitAll() {
    camera_.center = space_.box.center();
    const Vec3 half = 0.5 * space_.box.size();
    const double tilt = std::abs(camera_.toward.z);
    const double across = std::hypot(half.x, half.y);
    const double upright = half.z * std::sqrt(std::max(0.0, 1.0 - tilt * tilt)) + across * tilt;
    camera_.step = std::max(2.0 * across / camera_.width, 2.0 * upright / camera_.height);
  }

  Raster render() { return drawSpace(space_, camera_, console_.progress()); }

  [[nodiscard]] Pixel at(const Vec3& p) const { return sheet_.onSheet(camera_.pixel(p)); }

  void frame(const Raster& raster, std::size_t points) {
    Sheet& s = sheet_;
    const auto place = [this](const Vec3& p) { return at(p); };
    s.canvas.fill(rgb(0xFFFFFF));
    TextStyle head = s.font(23);
    head.bold = true;
    s.canvas.text({s.left, s.px(38)}, bare_.title, head);
    std::string line = space_.plane ? "cut " + space_.plane->name : "in space";
    for (const CutPlane& slice : space_.slices) line += "; slice " + slice.name;
    if (bare_.image && (space_.plane || !space_.slices.empty())) {
      line += "; gray values of " + vdb::fileName(bare_.image->source);
    }
    s.canvas.text({s.left, s.px(64)}, line, s.font(15, kFaintInk));
    s.canvas.clip(s.left, s.top, s.view.width, s.view.height);
    s.canvas.image(raster, s.left, s.top);
    // Seen from behind, the arrows on the cut face would cover the surfaces that hide them.
    if (space_.plane && glm::dot(space_.plane->normal(), camera_.toward) > 0.0) {
      drawFelt(s, place, camera_.step);
    }
    path_.draw(s, place, points);
    if (view_.motion == SpaceView::Motion::kReplay) {
      path_.drawHand(s, camera_, place, points - 1, kLongestForce * s.view.height);
    }
    s.canvas.unclip();
    drawScaleBar(s);
    drawTriad();
    path_.drawBar(s, drawLegend(s, s.top - s.px(20)));
  }

  /// Shows the directions of the axes, in the panel's lower right corner.
  void drawTriad() {
    static constexpr const char* kNames[] = {"x", "y", "z"};
    static constexpr const char* kSides[] = {"right", "front", "up"};
    Sheet& s = sheet_;
    const double arm = s.px(36);
    const Pixel root{s.left + s.view.width - s.px(66), s.top + s.view.height - s.px(62)};
    for (int axis = 0; axis < 3; ++axis) {
      const Vec3 tip = arm * Vec3(camera_.right[axis], camera_.up[axis], camera_.toward[axis]);
      const Pixel end{root.x + tip.x, root.y - tip.y};
      // An axis towards or away from the viewer would be a dot under its own name.
      if (std::hypot(tip.x, tip.y) < 0.15 * arm) continue;
      s.canvas.arrow(root, end, {kFaintInk, s.px(1.6)}, s.px(7));
      TextStyle style = s.font(13, kFaintInk);
      style.align = Align::kCenter;
      style.halo = s.px(3);
      s.canvas.text({root.x + 1.4 * tip.x, root.y - 1.4 * tip.y + s.px(4)},
                    bare_.anatomical ? kSides[axis] : kNames[axis], style);
    }
  }

  const SpaceView& view_;
  PictureOptions bare_;
  Sheet sheet_;
  Console& console_;
  SpacePath path_;
  SpaceScene space_;
  Camera camera_;
  Camera ahead_;  ///< the camera before it is turned
};

}  // namespace

std::string drawSpacePicture(const Scene& scene, const PictureOptions& picture,
                             const SpaceView& view, Console& console, const FrameSink& sink) {
  return SpaceSheet(scene, picture, view, console).draw(sink);
}

}  // namespace palpate::tools
