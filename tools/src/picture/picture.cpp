#include "picture/picture.h"

#include <algorithm>
#include <cmath>

#include "picture/canvas.h"
#include "picture/cutaway.h"
#include "picture/label_placer.h"
#include "picture/paint.h"
#include "picture/palette.h"
#include "picture/section.h"

namespace palpate::tools {
namespace {

/// Room for a scene without a bounded layer and without a track.
constexpr double kFallbackSize = 0.2;  // [m]
/// A hand that moves within less than this share of the scene is looked at closely ...
constexpr double kSmallTrack = 1.0 / 8.0;
/// ... with this many times its own extent in view.
constexpr double kCloseView = 6.0;
constexpr std::size_t kMostForces = 60;

/// The largest of 1, 2 and 5 times a power of ten that is at most `value`.
double niceBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double share = value / power;
  return (share >= 5.0 ? 5.0 : share >= 2.0 ? 2.0 : 1.0) * power;
}

/// From the segment between `a` and `b` to `p`.
double distanceTo(const Pixel& a, const Pixel& b, const Pixel& p) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double share =
      squared > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y);
}

Box3 contentBox(const Scene& scene, const Track& track) {
  Box3 box = scene.bounds();
  box = box.unitedWith(track.bounds());
  if (box.isEmpty()) box = {Vec3(-0.5 * kFallbackSize), Vec3(0.5 * kFallbackSize)};
  const Vec3 size = box.size();
  return box.grownBy(std::max(0.04 * std::max({size.x, size.y, size.z}), 1e-6));
}

/// The view that shows `box` as large as fits.
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

/// Draws one picture; the parts are in the order in which they are painted.
class PictureMaker {
 public:
  PictureMaker(const Scene& scene, const PictureOptions& options, Console& console)
      : scene_(scene),
        options_(options),
        console_(console),
        unit_{scene.lengthUnit(), scene.metresPerUnit()},
        scale_(std::clamp(std::min(options.width / 1600.0, options.height / 1000.0), 0.45, 4.0)),
        canvas_(options.width, options.height),
        paint_(options.image) {}

  CutPlane draw(const std::string& file) {
    const Box3 box = contentBox(scene_, options_.track);
    plane_ = choosePlane(box);
    side_ = px(430);
    left_ = px(86);
    top_ = px(84);
    const int width = static_cast<int>(options_.width - left_ - side_ - px(34));
    const int height = static_cast<int>(options_.height - top_ - px(72));
    view_ = viewOf(plane_, closeBox(box), std::max(width, 64), std::max(height, 64));

    canvas_.fill(rgb(0xFFFFFF));
    section_ = cutSection(scene_, view_, console_.progress());
    title();
    panel();
    const double bottom = inset(box);
    legend(bottom);
    canvas_.writePng(file);
    return plane_;
  }

 private:
  [[nodiscard]] double px(double at_full_size) const { return at_full_size * scale_; }
  [[nodiscard]] Pixel onSheet(const Pixel& p) const { return {p.x + left_, p.y + top_}; }
  [[nodiscard]] TextStyle font(double size, const Color& color = kInk) const {
    TextStyle style;
    style.size = px(size);
    style.color = color;
    return style;
  }

  [[nodiscard]] CutPlane choosePlane(const Box3& box) const {
    if (options_.plane) return *options_.plane;
    if (!options_.track.points.empty()) return planeAlong(options_.track, unit_);
    const Box3 bounds = scene_.bounds();
    return planeAcross(1, (bounds.isEmpty() ? box : bounds).center().y, unit_);
  }

  /// All, or if the hand moved in a small part only, that part.
  [[nodiscard]] Box3 closeBox(const Box3& all) const {
    if (options_.track.points.empty()) return all;
    const Box3 track = options_.track.bounds();
    const double moved = glm::length(track.size());
    if (moved > kSmallTrack * glm::length(all.size()) || !(moved > 0.0)) return all;
    zoomed_ = true;
    const Vec3 half(0.5 * kCloseView * moved);
    return {track.center() - half, track.center() + half};
  }

  void title() {
    TextStyle head = font(23);
    head.bold = true;
    canvas_.text({left_, px(38)}, options_.title, head);
    std::string line = "cut " + plane_.name;
    if (options_.image) line += "; grey values of " + fileName(options_.image->source);
    if (zoomed_) line += "; close to where the hand moved (the frame on the right)";
    canvas_.text({left_, px(64)}, line, font(15, kFaintInk));
  }

  static std::string fileName(const std::string& path) {
    return path.substr(path.find_last_of('/') + 1);
  }

  void panel() {
    Raster raster(view_.width, view_.height);
    for (int y = 0; y < view_.height; ++y) {
      for (int x = 0; x < view_.width; ++x) {
        raster.at(x, y) = paint_.at(section_.at(x, y), view_.world(x + 0.5, y + 0.5));
      }
    }
    canvas_.clip(left_, top_, view_.width, view_.height);
    canvas_.image(raster, left_, top_);
    for (const Boundary& line : section_.boundaries) boundary(line);
    track();
    canvas_.unclip();
    canvas_.frame(left_, top_, view_.width, view_.height, {rgb(0xB9B9C0), px(1)});
    scaleBar();
    axes();
    labels();
  }

  void boundary(const Boundary& line) {
    std::vector<Pixel> points;
    points.reserve(line.points.size());
    for (const Pixel& p : line.points) points.push_back(onSheet(p));
    switch (line.kind) {
      case Boundary::Kind::kNothing:
        return;
      case Boundary::Kind::kSheet:
      case Boundary::Kind::kWall:
        canvas_.line(points, {kWallInk, px(2.2)});
        break;
      case Boundary::Kind::kAbsent:
        canvas_.line(points, {kAbsentInk, px(1.5), {px(6), px(5)}});
        break;
      case Boundary::Kind::kPort:
        canvas_.line(points, {rgb(0xFFFFFF, 0.85), px(7)});
        canvas_.line(points, {kPortInk, px(4)});
        break;
      case Boundary::Kind::kPressed:
        canvas_.line(points, {kWallInk, px(2.2)});
        canvas_.line(points, {kPortInk, px(4), {px(5), px(7)}});
        break;
    }
    if (line.isPort() && line.from_a != line.from_b) oneWay(line);
  }

  /// A small arrow through a one-way port, away from its middle, where hands go.
  void oneWay(const Boundary& line) {
    const std::size_t middle = line.points.size() * 3 / 4;
    if (middle == 0) return;
    const std::size_t reach =
        std::min<std::size_t>(4, std::min(middle, line.points.size() - 1 - middle) + 1);
    const Pixel a = line.points[middle - std::min(reach, middle)];
    const Pixel b = line.points[std::min(middle + reach, line.points.size() - 1)];
    const double length = std::hypot(b.x - a.x, b.y - a.y);
    if (!(length > 0.0)) return;
    Pixel across{-(b.y - a.y) / length, (b.x - a.x) / length};
    const Pixel at = line.points[middle];
    const RegionId target = line.from_a ? line.b : line.a;
    const auto region = [&](double way) {
      const int x = std::clamp(static_cast<int>(at.x + way * across.x), 0, view_.width - 1);
      const int y = std::clamp(static_cast<int>(at.y + way * across.y), 0, view_.height - 1);
      return section_.at(x, y);
    };
    if (region(4.0) != target) across = {-across.x, -across.y};
    const Pixel m = onSheet(at);
    canvas_.arrow({m.x - across.x * px(16), m.y - across.y * px(16)},
                  {m.x + across.x * px(18), m.y + across.y * px(18)}, {kPortInk, px(2.5)}, px(12));
  }

  void track() {
    const auto& points = options_.track.points;
    if (points.empty()) return;
    std::vector<Pixel> hip;
    std::vector<Pixel> proxy;
    // A point that moves the line by less than a third of a pixel is left out.
    const auto extend = [&](std::vector<Pixel>& line, const Vec3& p) {
      const Pixel at = onSheet(view_.pixel(p));
      if (line.empty() || std::hypot(at.x - line.back().x, at.y - line.back().y) > 0.33)
        line.push_back(at);
    };
    for (const auto& p : points) {
      extend(hip, p.hip);
      extend(proxy, p.proxy);
    }
    // The proxy on top: the hand shows where a wall keeps them apart.
    canvas_.line(hip, {rgb(0xFFFFFF, 0.6), px(3.4)});
    canvas_.line(hip, {kHipInk, px(1.7), {px(7), px(4)}});
    canvas_.line(proxy, {rgb(0xFFFFFF, 0.75), px(6)});
    canvas_.line(proxy, {kProxyInk, px(3)});
    forces();
    canvas_.disk(hip.front(), px(6), rgb(0xFFFFFF));
    canvas_.disk(hip.front(), px(4.5), kHipInk);
    busy_.push_back(hip);
    busy_.push_back(proxy);
  }

  void forces() {
    const auto& points = options_.track.points;
    for (const auto& p : points) peak_ = std::max(peak_, glm::length(p.force));
    if (!(peak_ > 0.0)) return;
    const double longest = 0.13 * view_.height;
    std::vector<std::pair<Pixel, Pixel>> drawn;
    const auto draw = [&](const Track::Point& p) {
      const double length = longest * glm::length(p.force) / peak_;
      if (length < px(12) || drawn.size() >= kMostForces) return;
      const Pixel tail = onSheet(view_.pixel(p.proxy));
      const Pixel tip{tail.x + longest / peak_ * glm::dot(p.force, plane_.right),
                      tail.y - longest / peak_ * glm::dot(p.force, plane_.up)};
      // Where arrows would lie on one another the first stands for all.
      const bool taken = std::any_of(drawn.begin(), drawn.end(), [&](const auto& other) {
        return distanceTo(other.first, other.second, tail) < px(13) ||
               distanceTo(tail, tip, other.first) < px(13);
      });
      if (taken) return;
      drawn.emplace_back(tail, tip);
      canvas_.arrow(tail, tip, {kForceInk, px(2)}, px(9));
      busy_.push_back({tail, tip});
    };
    const auto strongest = std::max_element(
        points.begin(), points.end(),
        [](const auto& a, const auto& b) { return glm::length(a.force) < glm::length(b.force); });
    draw(*strongest);
    const std::size_t step = std::max<std::size_t>(1, points.size() / 400);
    for (std::size_t i = 0; i < points.size(); i += step) draw(points[i]);
  }

  void scaleBar() {
    const double length = niceBelow(0.22 * view_.width * view_.step / unit_.metres);
    const double width = length * unit_.metres / view_.step;
    const double x = left_ + px(18);
    const double y = top_ + view_.height - px(20);
    const TextStyle style = font(14);
    const std::string text = formatNumber(length) + " " + unit_.name;
    const double box = std::max(width, canvas_.textWidth(text, style)) + px(20);
    canvas_.rectangle(x - px(10), y - px(30), box, px(42), rgb(0xFFFFFF, 0.82), px(5));
    canvas_.line({{x, y - px(5)}, {x, y}, {x + width, y}, {x + width, y - px(5)}}, {kInk, px(2.2)});
    canvas_.text({x, y - px(11)}, text, style);
    const double top = y - px(30) - top_;
    for (double row = top; row < top + px(42); row += 4.0) {
      busy_.push_back(
          {onSheet({x - px(10) - left_, row}), onSheet({x - px(10) + box - left_, row})});
    }
  }

  [[nodiscard]] std::string axisName(const Vec3& direction, int axis) const {
    static constexpr const char* kWords[] = {"right", "front", "up"};
    if (axis < 0) return "along " + formatDirection(direction) + " [" + unit_.name + "]";
    std::string text = std::string(1, "xyz"[axis]) + " [" + unit_.name + "]";
    if (options_.anatomical) text += ", to the " + std::string(kWords[axis]);
    if (options_.anatomical && axis == 2) text = "z [" + unit_.name + "], up";
    return text;
  }

  void axes() {
    const TextStyle name = font(15);
    TextStyle upright = name;
    upright.upright = true;
    upright.align = Align::kCenter;
    TextStyle centered = name;
    centered.align = Align::kCenter;
    const double bottom = top_ + view_.height;
    ticks(
        plane_.right, plane_.right_axis, view_.left, view_.width,
        [&](double at, const std::string& text) {
          canvas_.line({{left_ + at, bottom}, {left_ + at, bottom + px(6)}}, {kFaintInk, px(1.2)});
          TextStyle style = font(13, kFaintInk);
          style.align = Align::kCenter;
          canvas_.text({left_ + at, bottom + px(22)}, text, style);
        });
    canvas_.text({left_ + 0.5 * view_.width, bottom + px(46)},
                 axisName(plane_.right, plane_.right_axis), centered);
    const double low = view_.top - view_.height * view_.step;
    ticks(plane_.up, plane_.up_axis, low, view_.height, [&](double at, const std::string& text) {
      canvas_.line({{left_ - px(6), bottom - at}, {left_, bottom - at}}, {kFaintInk, px(1.2)});
      TextStyle style = font(13, kFaintInk);
      style.align = Align::kRight;
      canvas_.text({left_ - px(10), bottom - at + px(5)}, text, style);
    });
    canvas_.text({left_ - px(56), top_ + 0.5 * view_.height}, axisName(plane_.up, plane_.up_axis),
                 upright);
  }

  /// Calls `mark(pixels from the low end, text)` at round coordinates.
  template <class Mark>
  void ticks(const Vec3& direction, int axis, double low, int pixels, Mark mark) const {
    // Off the world's axes coordinates count from the plane's own point.
    const double origin = axis < 0 ? 0.0 : plane_.point[axis];
    const double sign = axis < 0 ? 1.0 : direction[axis];
    const double a = (origin + sign * low) / unit_.metres;
    const double b = (origin + sign * (low + pixels * view_.step)) / unit_.metres;
    const double every = niceBelow(std::abs(b - a) / 5.0);
    for (double value = std::ceil(std::min(a, b) / every) * every; value <= std::max(a, b);
         value += every) {
      const double clean = std::abs(value) < 1e-9 * every ? 0.0 : value;
      mark((value - a) / (b - a) * pixels, formatNumber(clean));
    }
  }

  void labels() {
    LabelPlacer placer(section_);
    for (const auto& line : busy_) {
      std::vector<Pixel> local;
      for (const Pixel& p : line) local.push_back({p.x - left_, p.y - top_});
      placer.markBusy(local);
    }
    const auto regions = scene_.regions();
    std::vector<RegionId> cramped;
    for (std::size_t i = regions.size(); i-- > 0;) {
      const auto region = static_cast<RegionId>(i);
      if (!placer.innermost(region)) continue;
      TextStyle style = font(region == kOutside ? 14 : 17, region == kOutside ? kFaintInk : kInk);
      style.italic = region == kOutside;
      style.align = Align::kCenter;
      style.halo = px(3);
      const auto at =
          placer.placeInside(region, canvas_.textWidth(regions[i].name, style), style.size);
      if (at) {
        canvas_.text(onSheet({at->x, at->y + 0.36 * style.size}), regions[i].name, style);
      } else if (region != kOutside) {
        cramped.push_back(region);
      }
    }
    for (const RegionId region : cramped) {
      callout(placer, *placer.innermost(region), regions[region].name, kInk);
    }
    ports(placer);
  }

  /// Every port in view is named once: where the hand passed nearest, else on its longest line.
  void ports(LabelPlacer& placer) {
    for (std::size_t i = 0; i < scene_.ports().size(); ++i) {
      const Port& port = scene_.ports()[i];
      const auto anchor = portAnchor(static_cast<PortId>(i));
      if (!anchor) continue;
      std::string text = port.name;
      if (port.opens_at > 0.0) text += " (" + formatNumber(port.opens_at) + " N)";
      callout(placer, *anchor, text, kPortInk);
    }
  }

  [[nodiscard]] std::optional<Pixel> portAnchor(PortId port) const {
    std::optional<Pixel> anchor;
    std::size_t longest = 0;
    double nearest = kInfinity;
    for (const Boundary& line : section_.boundaries) {
      if (!line.isPort() || line.port != port) continue;
      if (options_.track.points.empty() && line.points.size() > longest) {
        longest = line.points.size();
        anchor = line.points[longest / 3];
      }
      const std::size_t step = std::max<std::size_t>(1, options_.track.points.size() / 500);
      for (std::size_t i = 0; i < options_.track.points.size(); i += step) {
        const Pixel hand = view_.pixel(options_.track.points[i].proxy);
        for (const Pixel& p : line.points) {
          const double distance = std::hypot(p.x - hand.x, p.y - hand.y);
          if (distance >= nearest) continue;
          nearest = distance;
          anchor = p;
        }
      }
    }
    return anchor;
  }

  void callout(LabelPlacer& placer, const Pixel& anchor, const std::string& text,
               const Color& color) {
    TextStyle style = font(15, color);
    style.align = Align::kCenter;
    style.halo = px(3);
    const double width = canvas_.textWidth(text, style);
    const auto at = placer.placeNear(anchor, width, style.size);
    if (!at) return;
    const Pixel from = onSheet(anchor);
    const Pixel middle = onSheet(*at);
    const Pixel end{
        std::clamp(from.x, middle.x - 0.5 * width - px(3), middle.x + 0.5 * width + px(3)),
        std::clamp(from.y, middle.y - 0.5 * style.size - px(3),
                   middle.y + 0.5 * style.size + px(3))};
    canvas_.line({from, end}, {rgb(0xFFFFFF, 0.8), px(3.2)});
    canvas_.line({from, end}, {color, px(1.3)});
    canvas_.disk(from, px(3), color);
    canvas_.text({middle.x, middle.y + 0.36 * style.size}, text, style);
  }

  /// The view in space; returns where it ends.
  double inset(const Box3& box) {
    const double x = options_.width - side_;
    const double y = top_;
    const int width = static_cast<int>(side_ - px(24));
    const int height = static_cast<int>(px(370));
    std::vector<Vec3> path;
    const std::size_t stride = std::max<std::size_t>(1, options_.track.points.size() / 2000);
    for (std::size_t i = 0; i < options_.track.points.size(); i += stride) {
      path.push_back(options_.track.points[i].proxy);
    }
    const Camera camera = cameraFor(scene_, plane_, box, path, width, height);
    const Raster raster = drawCutaway(scene_, plane_, box, camera, paint_, console_.progress());
    canvas_.image(raster, x, y);
    canvas_.clip(x, y, width, height);
    const auto at = [&](const Vec3& p) {
      const Pixel q = camera.pixel(p);
      return Pixel{q.x + x, q.y + y};
    };
    std::vector<Pixel> line;
    for (const Vec3& p : path) line.push_back(at(p));
    canvas_.line(line, {rgb(0xFFFFFF, 0.8), px(4.5)});
    canvas_.line(line, {kProxyInk, px(2.2)});
    if (zoomed_) {
      canvas_.line({at(view_.world(0, 0)), at(view_.world(view_.width, 0)),
                    at(view_.world(view_.width, view_.height)), at(view_.world(0, view_.height))},
                   {kFaintInk, px(1.5)}, true);
    }
    canvas_.unclip();
    return y + height;
  }

  void legend(double y) {
    const double x = options_.width - side_ + px(4);
    const double limit = options_.height - px(20);
    const double row = px(25);
    y += px(26);
    const auto entry = [&](const std::string& name, const std::string& detail, const auto& swatch) {
      if (y > limit) return;
      swatch(y - px(5));
      const TextStyle bold = font(15);
      canvas_.text({x + px(46), y}, name, bold);
      if (!detail.empty()) {
        canvas_.text({x + px(46) + canvas_.textWidth(name, bold) + px(9), y}, detail,
                     font(13, kFaintInk));
      }
      y += row;
    };
    std::vector<bool> seen(scene_.regions().size(), false);
    for (const std::uint64_t cell : section_.cells) seen[cell & 0xFFFFU] = true;
    for (std::size_t i = 1; i < scene_.regions().size(); ++i) {
      const Region& region = scene_.regions()[i];
      if (!seen[i]) continue;
      entry(region.name, feelOf(region), [&](double at) {
        canvas_.rectangle(x, at - px(8), px(34), px(17), regionColor(static_cast<RegionId>(i)),
                          px(3));
        canvas_.frame(x, at - px(8), px(34), px(17), {rgb(0x9A9AA2), px(0.8)});
      });
    }
    y += px(8);
    const auto stroke = [&](const Stroke& s) {
      return [&, s](double at) { canvas_.line({{x, at}, {x + px(34), at}}, s); };
    };
    bool wall = false, absent = false, port = false, pressed = false;
    for (const Boundary& line : section_.boundaries) {
      wall |= line.kind == Boundary::Kind::kWall || line.kind == Boundary::Kind::kSheet;
      absent |= line.kind == Boundary::Kind::kAbsent;
      port |= line.kind == Boundary::Kind::kPort;
      pressed |= line.kind == Boundary::Kind::kPressed;
    }
    if (wall) entry("wall", "", stroke({kWallInk, px(2.2)}));
    if (absent) entry("no wall", "free to cross", stroke({kAbsentInk, px(1.5), {px(6), px(5)}}));
    if (port) entry("port", "an opening in a wall", stroke({kPortInk, px(4)}));
    if (pressed) {
      entry("port", "opens when it is pressed", [&](double at) {
        canvas_.line({{x, at}, {x + px(34), at}}, {kWallInk, px(2.2)});
        canvas_.line({{x, at}, {x + px(34), at}}, {kPortInk, px(4), {px(5), px(7)}});
      });
    }
    if (options_.track.points.empty()) return;
    entry("hand", "where the device was", stroke({kHipInk, px(1.7), {px(7), px(4)}}));
    entry("proxy", "the tip, held by the walls", stroke({kProxyInk, px(3)}));
    if (peak_ > 0.0) {
      entry("force on the hand", "longest " + formatNumber(peak_, 3) + " N", [&](double at) {
        canvas_.arrow({x, at}, {x + px(34), at}, {kForceInk, px(2)}, px(9));
      });
    }
  }

  [[nodiscard]] std::string feelOf(const Region& region) const {
    std::string text;
    if (region.wall_absent) text = "no wall";
    if (region.wall >= 0) {
      text = "wall " +
             formatNumber(scene_.materials()[static_cast<std::size_t>(region.wall)].stiffness) +
             " N/m";
    }
    if (region.content >= 0) {
      const Material& m = scene_.materials()[static_cast<std::size_t>(region.content)];
      if (m.viscosity > 0.0) text += ", drag " + formatNumber(m.viscosity) + " N.s/m";
    }
    return text;
  }

  const Scene& scene_;
  const PictureOptions& options_;
  Console& console_;
  LengthUnit unit_;
  double scale_;
  Canvas canvas_;
  Paint paint_;
  CutPlane plane_;
  View view_;
  Section section_;
  double side_ = 0.0, left_ = 0.0, top_ = 0.0;
  double peak_ = 0.0;  ///< [N]
  mutable bool zoomed_ = false;
  std::vector<std::vector<Pixel>> busy_;  ///< lines that labels stay off
};

}  // namespace

std::shared_ptr<const vdb::Image> pictureImage(const LoadedScene& scene,
                                               const std::string& wanted) {
  std::string file = wanted;
  for (const SceneImage& image : scene.images()) {
    if (wanted.empty() ? !image.has_names : image.name == wanted) {
      file = image.file;
      break;
    }
  }
  if (file.empty()) return nullptr;
  return std::make_shared<const vdb::Image>(vdb::readNifti(file));
}

CutPlane drawPicture(const Scene& scene, const PictureOptions& options, const std::string& file,
                     Console& console) {
  return PictureMaker(scene, options, console).draw(file);
}

}  // namespace palpate::tools
