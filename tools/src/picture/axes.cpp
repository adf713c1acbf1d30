#include <algorithm>
#include <cmath>

#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

/// The largest of 1, 2 and 5 times a power of ten that is at most `value`.
double niceBelow(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  const double share = value / power;
  return (share >= 5.0 ? 5.0 : share >= 2.0 ? 2.0 : 1.0) * power;
}

std::string axisName(const Sheet& s, const Vec3& direction, int axis) {
  static constexpr const char* kWords[] = {"right", "front", "up"};
  if (axis < 0) return "along " + formatDirection(direction) + " [" + s.unit.name + "]";
  std::string text = std::string(1, "xyz"[axis]) + " [" + s.unit.name + "]";
  if (s.options.anatomical) text += ", to the " + std::string(kWords[axis]);
  if (s.options.anatomical && axis == 2) text = "z [" + s.unit.name + "], up";
  return text;
}

/// Calls `mark(pixels from the low end, text)` at round coordinates.
template <class Mark>
void ticks(const Sheet& s, const Vec3& direction, int axis, double low, int pixels, Mark mark) {
  // On a plane that is not across a world axis, coordinates count from the plane's own point.
  const double origin = axis < 0 ? 0.0 : s.plane.point[axis];
  const double sign = axis < 0 ? 1.0 : direction[axis];
  const double a = (origin + sign * low) / s.unit.meters;
  const double b = (origin + sign * (low + pixels * s.view.step)) / s.unit.meters;
  const double every = niceBelow(std::abs(b - a) / 5.0);
  const auto first = static_cast<long>(std::ceil(std::min(a, b) / every));
  const auto last = static_cast<long>(std::floor(std::max(a, b) / every));
  for (long k = first; k <= last; ++k) {
    const double value = static_cast<double>(k) * every;
    mark((value - a) / (b - a) * pixels, formatNumber(value));
  }
}

}  // namespace

void drawScaleBar(Sheet& s) {
  const double length = niceBelow(0.22 * s.view.width * s.view.step / s.unit.meters);
  const double width = length * s.unit.meters / s.view.step;
  const double x = s.left + s.px(18);
  const double y = s.top + s.view.height - s.px(20);
  const TextStyle style = s.font(14);
  const std::string text = formatNumber(length) + " " + s.unit.name;
  const double box = std::max(width, s.canvas.textWidth(text, style)) + s.px(20);
  s.canvas.rectangle(x - s.px(10), y - s.px(30), box, s.px(42), rgb(0xFFFFFF, 0.82), s.px(5));
  s.canvas.line({{x, y - s.px(5)}, {x, y}, {x + width, y}, {x + width, y - s.px(5)}},
                {kInk, s.px(2.2)});
  s.canvas.text({x, y - s.px(11)}, text, style);
  const double top = y - s.px(30) - s.top;
  for (int i = 0; 4.0 * i < s.px(42); ++i) {
    const double row = top + 4.0 * i;
    s.busy.push_back(
        {s.onSheet({x - s.px(10) - s.left, row}), s.onSheet({x - s.px(10) + box - s.left, row})});
  }
}

void drawAxes(Sheet& s) {
  const TextStyle name = s.font(15);
  TextStyle upright = name;
  upright.upright = true;
  upright.align = Align::kCenter;
  TextStyle centered = name;
  centered.align = Align::kCenter;
  const double bottom = s.top + s.view.height;
  ticks(s, s.plane.right, s.plane.right_axis, s.view.left, s.view.width,
        [&](double at, const std::string& text) {
          s.canvas.line({{s.left + at, bottom}, {s.left + at, bottom + s.px(6)}},
                        {kFaintInk, s.px(1.2)});
          TextStyle style = s.font(13, kFaintInk);
          style.align = Align::kCenter;
          s.canvas.text({s.left + at, bottom + s.px(22)}, text, style);
        });
  s.canvas.text({s.left + 0.5 * s.view.width, bottom + s.px(46)},
                axisName(s, s.plane.right, s.plane.right_axis), centered);
  const double low = s.view.top - s.view.height * s.view.step;
  ticks(s, s.plane.up, s.plane.up_axis, low, s.view.height,
        [&](double at, const std::string& text) {
          s.canvas.line({{s.left - s.px(6), bottom - at}, {s.left, bottom - at}},
                        {kFaintInk, s.px(1.2)});
          TextStyle style = s.font(13, kFaintInk);
          style.align = Align::kRight;
          s.canvas.text({s.left - s.px(10), bottom - at + s.px(5)}, text, style);
        });
  s.canvas.text({s.left - s.px(56), s.top + 0.5 * s.view.height},
                axisName(s, s.plane.up, s.plane.up_axis), upright);
}

}  // namespace palpate::tools
