#pragma once
// Maps each axis and button of an input device to its use.

#include <linux/input.h>

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/devices/evdev.h"

namespace palpate::devices::evdev {

/// The capabilities that the kernel reports for a device.
struct Capabilities {
  std::bitset<KEY_CNT> keys;
  std::bitset<REL_CNT> relative;
  std::bitset<ABS_CNT> absolute;
  std::array<input_absinfo, ABS_CNT> ranges{};  ///< of the absolute axes that it has
};

enum class AxisUse : std::uint8_t {
  kSpeed,  ///< a deflection sets a velocity
  kTurn,   ///< a deflection sets an angular velocity
  kMove,   ///< counts are a distance
};

struct AxisMap {
  std::uint16_t type = EV_ABS;  ///< EV_REL or EV_ABS
  std::uint16_t code = 0;
  AxisUse use = AxisUse::kSpeed;
  int axis = 0;  ///< 0 to 2, axis of the frame
  double sign = 1.0;
  double rest = 0.0;      ///< [counts] value without deflection
  double reach = 0.0;     ///< [counts] from there to full deflection; 0 or less: not known
  double flat = 0.0;      ///< [counts] zone around `rest` without effect, stated by the kernel
  bool is_wheel = false;  ///< kMove: counts are notches
};

/// The most axes that are used.
constexpr std::size_t kMostAxes = 8;

struct InputMap {
  InputKind kind = InputKind::kMouse;
  std::vector<AxisMap> axes;
  std::vector<std::uint16_t> buttons;  ///< codes, ascending; the first 32
};

/// No value if it is not a SpaceMouse, gamepad or mouse.
[[nodiscard]] std::optional<InputMap> mapOf(const Capabilities& has);

}  // namespace palpate::devices::evdev
