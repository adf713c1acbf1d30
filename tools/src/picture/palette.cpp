#include "picture/palette.h"

#include <algorithm>
#include <array>

namespace palpate::tools {

Color regionColor(RegionId region) {
  static constexpr std::array<std::uint32_t, 12> kColors = {0xE8CBA6, 0xE0A79F, 0x9FBBD6, 0xA9CBA2,
                                                            0xC3B1DA, 0xE3CF80, 0x8CC6C2, 0xDFAFCB,
                                                            0xC9B99A, 0xB4BFCC, 0xD9B38C, 0xBFD08F};
  if (region == kOutside) return kPaper;
  const Color color = rgb(kColors[(region - 1U) % kColors.size()]);
  // With more regions than colors: the second twelve are darker, the third lighter, and so on in
  // turn.
  const std::size_t round = (region - 1U) / kColors.size() % 3U;
  return round == 0 ? color : round == 1 ? scaled(color, 0.8) : mixed(color, rgb(0xFFFFFF), 0.55);
}

Color mixed(const Color& a, const Color& b, double share_of_b) {
  const double s = std::clamp(share_of_b, 0.0, 1.0);
  return {a.r + (b.r - a.r) * s, a.g + (b.g - a.g) * s, a.b + (b.b - a.b) * s, 1.0};
}

Color scaled(const Color& c, double brightness) {
  return {std::min(1.0, c.r * brightness), std::min(1.0, c.g * brightness),
          std::min(1.0, c.b * brightness), c.a};
}

}  // namespace palpate::tools
