#include <string>
#include <vector>

#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

std::string feelOf(const Sheet& s, const Region& region) {
  std::string text;
  if (region.wall_absent) text = "no wall";
  if (region.wall >= 0) {
    text = "wall " +
           formatParameter(s.scene.materials()[static_cast<std::size_t>(region.wall)].stiffness) +
           " N/m";
  }
  const auto index = static_cast<std::size_t>(&region - s.scene.regions().data());
  if (index < s.opacity.size() && s.opacity[index] < 1.0) {
    text += (text.empty() ? "" : ", ") + formatNumber(100.0 * s.opacity[index], 3) + " % opaque";
  }
  if (region.content >= 0) {
    const Material& m = s.scene.materials()[static_cast<std::size_t>(region.content)];
    if (m.viscosity != 0.0) text += ", drag " + formatParameter(m.viscosity) + " N.s/m";
  }
  return text;
}

/// `text`, or its longest beginning that is no wider than `room`.
std::string shortened(Sheet& s, std::string text, const TextStyle& style, double room) {
  if (s.canvas.textWidth(text, style) <= room) return text;
  const auto is_middle = [](char byte) {
    return (static_cast<unsigned char>(byte) & 0xC0U) == 0x80U;
  };
  while (!text.empty() && s.canvas.textWidth(text + "...", style) > room) {
    while (!text.empty() && is_middle(text.back()))
      text.pop_back();  // removes all bytes of one character
    if (!text.empty()) text.pop_back();
  }
  return text + "...";
}

}  // namespace

double drawLegend(Sheet& s, double y) {
  const double x = s.options.width - s.side + s.px(4);
  const double limit = s.options.height - s.px(20);
  const double row = s.px(25);
  y += s.px(26);
  const auto entry = [&](const std::string& name, const std::string& detail, const auto& swatch) {
    if (y > limit) return;
    swatch(y - s.px(5));
    const TextStyle bold = s.font(15);
    const double room = s.options.width - s.px(10) - (x + s.px(46));
    const std::string fitting = shortened(s, name, bold, room);
    s.canvas.text({x + s.px(46), y}, fitting, bold);
    const double begin = s.canvas.textWidth(fitting, bold) + s.px(9);
    for (const double size : {13.0, 10.5}) {
      const TextStyle faint = s.font(size, kFaintInk);
      if (detail.empty() || begin + s.canvas.textWidth(detail, faint) > room) continue;
      s.canvas.text({x + s.px(46) + begin, y}, detail, faint);
      break;
    }
    y += row;
  };
  std::vector<bool> seen(s.scene.regions().size(), false);
  for (const std::uint64_t cell : s.section.cells) seen[cell & 0xFFFFU] = true;
  for (std::size_t i = 1; i < s.scene.regions().size(); ++i) {
    const Region& region = s.scene.regions()[i];
    if (!seen[i]) continue;
    entry(region.name, feelOf(s, region), [&](double at) {
      s.canvas.rectangle(x, at - s.px(8), s.px(34), s.px(17), s.paint.of(static_cast<RegionId>(i)),
                         s.px(3));
      s.canvas.frame(x, at - s.px(8), s.px(34), s.px(17), {rgb(0x9A9AA2), s.px(0.8)});
    });
  }
  y += s.px(8);
  const auto stroke = [&](const Stroke& style) {
    return [&, style](double at) { s.canvas.line({{x, at}, {x + s.px(34), at}}, style); };
  };
  bool wall = false, absent = false, port = false, pressed = false;
  for (const Boundary& line : s.section.boundaries) {
    wall |= line.kind == Boundary::Kind::kWall || line.kind == Boundary::Kind::kSheet;
    absent |= line.kind == Boundary::Kind::kAbsent;
    port |= line.kind == Boundary::Kind::kPort;
    pressed |= line.kind == Boundary::Kind::kPressed;
  }
  if (wall) entry("wall", "", stroke({kWallInk, s.px(2.2)}));
  if (absent)
    entry("no wall", "free to cross", stroke({kAbsentInk, s.px(1.5), {s.px(6), s.px(5)}}));
  if (port) entry("port", "an opening in a wall", stroke({kPortInk, s.px(4)}));
  if (pressed) {
    entry("port", "opens when it is pressed", [&](double at) {
      s.canvas.line({{x, at}, {x + s.px(34), at}}, {kWallInk, s.px(2.2)});
      s.canvas.line({{x, at}, {x + s.px(34), at}}, {kPortInk, s.px(4), {s.px(5), s.px(7)}});
    });
  }
  if (s.lines) {
    entry("equal distance",
          "from a surface, every " + formatNumber(s.lines->spacing() / s.unit.meters) + " " +
              s.unit.name,
          stroke({mixed(rgb(0xFFFFFF), kInk, 0.5), s.px(1.3)}));
  }
  double most = 0.0;
  for (const RestForce& f : s.felt) most = std::max(most, glm::length(f.force));
  if (most > 0.0) {
    entry("force on a hand at rest", "longest " + formatNumber(most, 3) + " N", [&](double at) {
      s.canvas.disk({x, at}, s.px(2.2), kForceInk);
      s.canvas.arrow({x, at}, {x + s.px(34), at}, {kForceInk, s.px(1.4)}, s.px(8));
    });
  }
  if (s.options.track.points.empty()) return y;
  entry("hand", "where the device was", stroke({kHipInk, s.px(1.7), {s.px(7), s.px(4)}}));
  entry("proxy", "the tip, held by the walls", stroke({kProxyInk, s.px(3)}));
  if (s.peak > 0.0) {
    entry("force on the hand", "longest " + formatNumber(s.peak, 3) + " N", [&](double at) {
      s.canvas.arrow({x, at}, {x + s.px(34), at}, {kForceInk, s.px(2)}, s.px(9));
    });
  }
  return y;
}

}  // namespace palpate::tools
