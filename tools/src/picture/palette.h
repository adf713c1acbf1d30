#pragma once
/// The colors of pictures.

#include "palpate/interior/partition.h"
#include "picture/canvas.h"

namespace palpate::tools {

inline constexpr Color kPaper = rgb(0xFCFBF8);
inline constexpr Color kInk = rgb(0x26262B);
inline constexpr Color kFaintInk = rgb(0x6E6E76);
inline constexpr Color kWallInk = rgb(0x2B2B33);
inline constexpr Color kAbsentInk = rgb(0x8A8A94);
inline constexpr Color kPortInk = rgb(0x0B8A72);
inline constexpr Color kHipInk = rgb(0xC96A12);
inline constexpr Color kProxyInk = rgb(0x1F4FB0);
inline constexpr Color kForceInk = rgb(0xC3213B);

/// Muted colors that differ in hue; they repeat after twelve.
[[nodiscard]] Color regionColor(RegionId region);

[[nodiscard]] Color mixed(const Color& a, const Color& b, double share_of_b);
[[nodiscard]] Color scaled(const Color& c, double brightness);

}  // namespace palpate::tools
