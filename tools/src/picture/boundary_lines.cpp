#include <algorithm>
#include <cmath>

#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

/// A small arrow through a one-way port, off its middle, where paths of hands are drawn.
void oneWay(Sheet& s, const Boundary& line) {
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
    const int x = std::clamp(static_cast<int>(at.x + way * across.x), 0, s.view.width - 1);
    const int y = std::clamp(static_cast<int>(at.y + way * across.y), 0, s.view.height - 1);
    return s.section.at(x, y);
  };
  if (region(4.0) != target) across = {-across.x, -across.y};
  const Pixel m = s.onSheet(at);
  s.canvas.arrow({m.x - across.x * s.px(16), m.y - across.y * s.px(16)},
                 {m.x + across.x * s.px(18), m.y + across.y * s.px(18)}, {kPortInk, s.px(2.5)},
                 s.px(12));
}

void boundary(Sheet& s, const Boundary& line) {
  std::vector<Pixel> points;
  points.reserve(line.points.size());
  for (const Pixel& p : line.points) points.push_back(s.onSheet(p));
  switch (line.kind) {
    case Boundary::Kind::kNothing:
      return;
    case Boundary::Kind::kSheet:
    case Boundary::Kind::kWall:
      s.canvas.line(points, {kWallInk, s.px(2.2)});
      break;
    case Boundary::Kind::kAbsent:
      s.canvas.line(points, {kAbsentInk, s.px(1.5), {s.px(6), s.px(5)}});
      break;
    case Boundary::Kind::kPort:
      s.canvas.line(points, {rgb(0xFFFFFF, 0.85), s.px(7)});
      s.canvas.line(points, {kPortInk, s.px(4)});
      break;
    case Boundary::Kind::kPressed:
      s.canvas.line(points, {kWallInk, s.px(2.2)});
      s.canvas.line(points, {kPortInk, s.px(4), {s.px(5), s.px(7)}});
      break;
  }
  if (line.isPort() && line.from_a != line.from_b) oneWay(s, line);
}

}  // namespace

void drawBoundaries(Sheet& s) {
  for (const Boundary& line : s.section.boundaries) boundary(s, line);
}

}  // namespace palpate::tools
