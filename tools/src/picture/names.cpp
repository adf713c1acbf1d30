#include <algorithm>
#include <cmath>
#include <optional>

#include "picture/label_placer.h"
#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

std::optional<Pixel> portAnchor(const Sheet& s, PortId port) {
  std::optional<Pixel> anchor;
  std::size_t longest = 0;
  double nearest = kInfinity;
  for (const Boundary& line : s.section.boundaries) {
    if (!line.isPort() || line.port != port) continue;
    if (s.options.track.points.empty() && line.points.size() > longest) {
      longest = line.points.size();
      anchor = line.points[longest / 3];
    }
    const std::size_t step = std::max<std::size_t>(1, s.options.track.points.size() / 500);
    for (std::size_t i = 0; i < s.options.track.points.size(); i += step) {
      const Pixel hand = s.view.pixel(s.options.track.points[i].proxy);
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

void callout(Sheet& s, LabelPlacer& placer, const Pixel& anchor, const std::string& text,
             const Color& color) {
  TextStyle style = s.font(15, color);
  style.align = Align::kCenter;
  style.halo = s.px(3);
  const double width = s.canvas.textWidth(text, style);
  const auto at = placer.placeNear(anchor, width, style.size);
  if (!at) return;
  const Pixel from = s.onSheet(anchor);
  const Pixel middle = s.onSheet(*at);
  const Pixel end{
      std::clamp(from.x, middle.x - 0.5 * width - s.px(3), middle.x + 0.5 * width + s.px(3)),
      std::clamp(from.y, middle.y - 0.5 * style.size - s.px(3),
                 middle.y + 0.5 * style.size + s.px(3))};
  s.canvas.line({from, end}, {rgb(0xFFFFFF, 0.8), s.px(3.2)});
  s.canvas.line({from, end}, {color, s.px(1.3)});
  s.canvas.disk(from, s.px(3), color);
  s.canvas.text({middle.x, middle.y + 0.36 * style.size}, text, style);
}

/// Names each visible port once: at the place nearest to the hand's path, else on its longest line.
void ports(Sheet& s, LabelPlacer& placer) {
  for (std::size_t i = 0; i < s.scene.ports().size(); ++i) {
    const Port& port = s.scene.ports()[i];
    const auto anchor = portAnchor(s, static_cast<PortId>(i));
    if (!anchor) continue;
    std::string text = port.name;
    if (port.opens_at != 0.0) text += " (" + formatParameter(port.opens_at) + " N)";
    callout(s, placer, *anchor, text, kPortInk);
  }
}

}  // namespace

void drawNames(Sheet& s) {
  LabelPlacer placer(s.section);
  for (const auto& line : s.busy) {
    std::vector<Pixel> local;
    local.reserve(line.size());
    for (const Pixel& p : line) local.push_back({p.x - s.left, p.y - s.top});
    placer.markBusy(local);
  }
  const auto regions = s.scene.regions();
  std::vector<RegionId> cramped;
  for (std::size_t i = regions.size(); i-- > 0;) {
    const auto region = static_cast<RegionId>(i);
    if (!placer.innermost(region)) continue;
    TextStyle style = s.font(region == kOutside ? 14 : 17, region == kOutside ? kFaintInk : kInk);
    style.italic = region == kOutside;
    style.align = Align::kCenter;
    style.halo = s.px(3);
    const auto at =
        placer.placeInside(region, s.canvas.textWidth(regions[i].name, style), style.size);
    if (at) {
      s.canvas.text(s.onSheet({at->x, at->y + 0.36 * style.size}), regions[i].name, style);
    } else if (region != kOutside) {
      cramped.push_back(region);
    }
  }
  for (const RegionId region : cramped) {
    callout(s, placer, *placer.innermost(region), regions[region].name, kInk);
  }
  ports(s, placer);
}

}  // namespace palpate::tools
