#include "picture/picture.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"
#include "picture/cutaway.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

/// Size of the view of a scene without a bounded layer and without a track.
constexpr double kFallbackSize = 0.2;  // [m]
/// If a hand moves within less than this share of the scene, the view is a close-up ...
constexpr double kSmallTrack = 1.0 / 8.0;
/// ... that shows this many times the hand's own extent.
constexpr double kCloseView = 6.0;

Box3 contentBox(const Scene& scene, const Track& track) {
  Box3 box = scene.bounds();
  box = box.unitedWith(track.bounds());
  if (box.isEmpty()) box = {Vec3(-0.5 * kFallbackSize), Vec3(0.5 * kFallbackSize)};
  const Vec3 size = box.size();
  return box.grownBy(std::max(0.04 * std::max({size.x, size.y, size.z}), 1e-6));
}

/// The view that shows `box` as large as possible.
View viewOf(const CutPlane& plane, const Box3& box, int width, int height) {
  double lo_u = kInfinity, hi_u = -kInfinity, lo_v = kInfinity, hi_v = -kInfinity;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3 p = box.lo;
    for (int i = 0; i < 3; ++i) {
      if (((corner >> i) & 1) != 0) p[i] = box.hi[i];
    }
    lo_u = std::min(lo_u, plane.u(p));
    hi_u = std::max(hi_u, plane.u(p));
    lo_v = std::min(lo_v, plane.v(p));
    hi_v = std::max(hi_v, plane.v(p));
  }
  View view;
  view.plane = plane;
  view.width = width;
  view.height = height;
  view.step = std::max((hi_u - lo_u) / width, (hi_v - lo_v) / height);
  view.left = 0.5 * (lo_u + hi_u) - 0.5 * width * view.step;
  view.top = 0.5 * (lo_v + hi_v) + 0.5 * height * view.step;
  return view;
}

CutPlane choosePlane(const Sheet& s, const Box3& box) {
  if (s.options.plane) return *s.options.plane;
  if (!s.options.track.points.empty()) return planeAlong(s.options.track, s.unit);
  const Box3 bounds = s.scene.bounds();
  return planeAcross(1, (bounds.isEmpty() ? box : bounds).center().y, s.unit);
}

/// The box to show: all, or, if the hand moved only in a small part, that part.
Box3 closeBox(Sheet& s, const Box3& all) {
  if (s.options.track.points.empty()) return all;
  const Box3 track = s.options.track.bounds();
  const double moved = glm::length(track.size());
  if (moved > kSmallTrack * glm::length(all.size()) || !(moved > 0.0)) return all;
  s.zoomed = true;
  const Vec3 half(0.5 * kCloseView * moved);
  return {track.center() - half, track.center() + half};
}

void drawTitle(Sheet& s) {
  TextStyle head = s.font(23);
  head.bold = true;
  s.canvas.text({s.left, s.px(38)}, s.options.title, head);
  std::string line = "cut " + s.plane.name;
  if (s.options.image) line += "; gray values of " + vdb::fileName(s.options.image->source);
  if (s.zoomed) line += "; close to where the hand moved (the frame on the right)";
  s.canvas.text({s.left, s.px(64)}, line, s.font(15, kFaintInk));
}

void drawPanel(Sheet& s) {
  Raster raster(s.view.width, s.view.height);
  for (int y = 0; y < s.view.height; ++y) {
    for (int x = 0; x < s.view.width; ++x) {
      const Vec3 p = s.view.world(x + 0.5, y + 0.5);
      Color color = s.paint.at(s.section.at(x, y), p);
      if (s.lines) color = mixed(color, kInk, s.lines->inkAt(p, s.plane.normal(), s.view.step));
      raster.set(x, y, color);
    }
  }
  s.canvas.clip(s.left, s.top, s.view.width, s.view.height);
  s.canvas.image(raster, s.left, s.top);
  drawBoundaries(s);
  drawFelt(
      s, [&](const Vec3& p) { return s.onSheet(s.view.pixel(p)); }, s.view.step);
  drawTrack(s);
  s.canvas.unclip();
  s.canvas.frame(s.left, s.top, s.view.width, s.view.height, {rgb(0xB9B9C0), s.px(1)});
  drawScaleBar(s);
  drawAxes(s);
  drawNames(s);
}

/// Draws the view in space; returns where it ends.
double drawInset(Sheet& s, const Box3& box, Console& console) {
  const double x = s.options.width - s.side;
  const double y = s.top;
  const int width = static_cast<int>(s.side - s.px(24));
  const int height = static_cast<int>(s.px(370));
  std::vector<Vec3> path;
  const std::size_t stride = std::max<std::size_t>(1, s.options.track.points.size() / 2000);
  for (std::size_t i = 0; i < s.options.track.points.size(); i += stride) {
    path.push_back(s.options.track.points[i].proxy);
  }
  const SpaceScene space{s.scene, s.paint, box, s.plane};
  Camera camera = cameraOn(s.plane);
  fitCamera(camera, space, path, width, height);
  const Raster raster = drawSpace(space, camera, console.progress());
  s.canvas.image(raster, x, y);
  s.canvas.clip(x, y, width, height);
  const auto at = [&](const Vec3& p) {
    const Pixel q = camera.pixel(p);
    return Pixel{q.x + x, q.y + y};
  };
  std::vector<Pixel> line;
  line.reserve(path.size());
  for (const Vec3& p : path) line.push_back(at(p));
  s.canvas.line(line, {rgb(0xFFFFFF, 0.8), s.px(4.5)});
  s.canvas.line(line, {kProxyInk, s.px(2.2)});
  if (s.zoomed) {
    s.canvas.line(
        {at(s.view.world(0, 0)), at(s.view.world(s.view.width, 0)),
         at(s.view.world(s.view.width, s.view.height)), at(s.view.world(0, s.view.height))},
        {kFaintInk, s.px(1.5)}, true);
  }
  s.canvas.unclip();
  return y + height;
}

/// A mask has only two values, not gray ones.
bool isMask(const vdb::Image& image) {
  std::array<float, 2> seen{};
  std::size_t count = 0;
  for (const float value : image.values) {
    if (std::find(seen.begin(), seen.begin() + count, value) != seen.begin() + count) continue;
    if (count == seen.size()) return false;
    seen[count++] = value;
  }
  return true;
}

}  // namespace

std::shared_ptr<const vdb::Image> pictureImage(const std::vector<SceneImage>& images,
                                               const std::string& wanted) {
  for (const SceneImage& image : images) {
    if (wanted.empty() ? image.has_names : image.name != wanted) continue;
    if (vdb::isStandIn(image.file)) {
      if (wanted.empty()) continue;
      throw inputError("pack.no_scan", "the scan '" + wanted + "' is not in the bundle",
                       "draw it from the scene that was packed, or name the file of a scan",
                       image.file);
    }
    auto read = std::make_shared<const vdb::Image>(vdb::readImage(image.file, image.options));
    if (!wanted.empty() || !isMask(*read)) return read;
  }
  if (wanted.empty()) return nullptr;
  return std::make_shared<const vdb::Image>(vdb::readImage(wanted, {}));
}

Picture drawPicture(const Scene& scene, const PictureOptions& options, Console& console) {
  Sheet s(scene, options);
  const Box3 box = contentBox(scene, options.track);
  s.plane = choosePlane(s, box);
  s.side = s.px(430);
  s.left = s.px(86);
  s.top = s.px(84);
  const int width = static_cast<int>(options.width - s.left - s.side - s.px(34));
  const int height = static_cast<int>(options.height - s.top - s.px(72));
  const Box3 shown = closeBox(s, box);
  s.view = viewOf(s.plane, shown, std::max(width, 64), std::max(height, 64));
  if (s.lines) s.lines->check(s.view.step);
  feelPlane(s, shown, console.progress());

  s.canvas.fill(rgb(0xFFFFFF));
  s.section = cutSection(scene, s.view, console.progress());
  drawTitle(s);
  drawPanel(s);
  drawLegend(s, drawInset(s, box, console));
  return {s.canvas.png(), s.plane};
}

}  // namespace palpate::tools
