#pragma once
/// How stiff a stack of layers feels under a probe that presses on a patch of a given radius.

#include <array>
#include <cstddef>
#include <span>

namespace palpate {

/// A layer of a stack, the topmost first.
struct StackLayer {
  double stiffness = 0.0;  ///< [N/m] of a half-space of it alone under the patch; more than 0
  double thickness = 0.0;  ///< [m] the last one's does not count: it goes on for ever
};

inline constexpr std::size_t kMostStackLayers = 6;

struct StackStiffness {
  double stiffness = 0.0;  ///< [N/m]
  std::array<double, kMostStackLayers>
      by_thickness{};  ///< [N/m^2] its derivative by each thickness; 0 for the last layer
  std::array<double, kMostStackLayers> by_stiffness{};  ///< [-] and by each stiffness
};

/// The stiffness of `layers` (1 to kMostStackLayers) under a patch of `radius` [m]: incompressible
/// elastic layers, bonded to one another, level and endless to all sides, pressed with what a rigid
/// flat punch does on a half-space of the top layer, p = F / (2 pi a sqrt(a^2 - r^2)); the depth is
/// the mean over that pressure. So it is exact for a half-space (2 a E / (1 - nu^2)), and never
/// more than a rigid punch would feel, usually by less than 2 %. It lies between the least and the
/// most of the layers. Real-time safe; four layers take about 1 us, with all derivatives.
///
/// Source: the equations of elasticity under the Hankel transform (Sneddon, Fourier Transforms,
/// 1951, chapter 10); the stack is folded from below up by the reflections at its interfaces, and
/// the derivatives follow the same way back. The integral over the waves is a sum of 16, within
/// 3e-3 of it.
[[nodiscard]] StackStiffness stackStiffness(std::span<const StackLayer> layers,
                                            double radius) noexcept;

}  // namespace palpate
