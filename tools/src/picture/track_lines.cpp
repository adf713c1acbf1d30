#include <algorithm>
#include <cmath>

#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kMostForces = 60;

/// Distance of `p` from the segment between `a` and `b`.
double distanceTo(const Pixel& a, const Pixel& b, const Pixel& p) {
  const double dx = b.x - a.x;
  const double dy = b.y - a.y;
  const double squared = dx * dx + dy * dy;
  const double share =
      squared > 0.0 ? std::clamp(((p.x - a.x) * dx + (p.y - a.y) * dy) / squared, 0.0, 1.0) : 0.0;
  return std::hypot(a.x + share * dx - p.x, a.y + share * dy - p.y);
}

void forces(Sheet& s) {
  const auto& points = s.options.track.points;
  for (const auto& p : points) s.peak = std::max(s.peak, glm::length(p.force));
  if (!(s.peak > 0.0)) return;
  const double longest = 0.13 * s.view.height;
  std::vector<std::pair<Pixel, Pixel>> drawn;
  const auto draw = [&](const Track::Point& p) {
    const double length = longest * glm::length(p.force) / s.peak;
    if (length < s.px(12) || drawn.size() >= kMostForces) return;
    const Pixel tail = s.onSheet(s.view.pixel(p.proxy));
    const Pixel tip{tail.x + longest / s.peak * glm::dot(p.force, s.plane.right),
                    tail.y - longest / s.peak * glm::dot(p.force, s.plane.up)};
    // If arrows would cover one another, only the first is drawn.
    const bool taken = std::any_of(drawn.begin(), drawn.end(), [&](const auto& other) {
      return distanceTo(other.first, other.second, tail) < s.px(13) ||
             distanceTo(tail, tip, other.first) < s.px(13);
    });
    if (taken) return;
    drawn.emplace_back(tail, tip);
    s.canvas.arrow(tail, tip, {kForceInk, s.px(2)}, s.px(9));
    s.busy.push_back({tail, tip});
  };
  const auto strongest = std::max_element(
      points.begin(), points.end(),
      [](const auto& a, const auto& b) { return glm::length(a.force) < glm::length(b.force); });
  draw(*strongest);
  const std::size_t step = std::max<std::size_t>(1, points.size() / 400);
  for (std::size_t i = 0; i < points.size(); i += step) draw(points[i]);
}

}  // namespace

void drawTrack(Sheet& s) {
  const auto& points = s.options.track.points;
  if (points.empty()) return;
  std::vector<Pixel> hip;
  std::vector<Pixel> proxy;
  // Points that move the line by less than a third of a pixel are left out.
  const auto extend = [&](std::vector<Pixel>& line, const Vec3& p) {
    const Pixel at = s.onSheet(s.view.pixel(p));
    if (line.empty() || std::hypot(at.x - line.back().x, at.y - line.back().y) > 0.33)
      line.push_back(at);
  };
  for (const auto& p : points) {
    extend(hip, p.hip);
    extend(proxy, p.proxy);
  }
  // The proxy is drawn on top: the hand's line is visible where a wall keeps the two apart.
  s.canvas.line(hip, {rgb(0xFFFFFF, 0.6), s.px(3.4)});
  s.canvas.line(hip, {kHipInk, s.px(1.7), {s.px(7), s.px(4)}});
  s.canvas.line(proxy, {rgb(0xFFFFFF, 0.75), s.px(6)});
  s.canvas.line(proxy, {kProxyInk, s.px(3)});
  forces(s);
  s.canvas.disk(hip.front(), s.px(6), rgb(0xFFFFFF));
  s.canvas.disk(hip.front(), s.px(4.5), kHipInk);
  s.busy.push_back(hip);
  s.busy.push_back(proxy);
}

}  // namespace palpate::tools
