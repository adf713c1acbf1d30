#pragma once
// What each axis and button of an input device is for.

#include <linux/input.h>

#include <array>
#include <bitset>
#include <cstdint>
#include <optional>
#include <vector>

#include "palpate/devices/evdev.h"

namespace palpate::devices::evdev {

/// What the kernel says that a device has.
struct Capabilities {
  std::bitset<KEY_CNT> keys;
  std::bitset<REL_CNT> relative;
  std::bitset<ABS_CNT> absolute;
  std::array<input_absinfo, ABS_CNT> ranges{};  ///< of the absolute axes that it has
};

enum class AxisUse : std::uint8_t {
  kSpeed,  ///< deflection: velocity
  kTurn,   ///< deflection: angular velocity
  kMove,   ///< counts: a way
};

struct AxisMap {
  std::uint16_t type = EV_ABS;  ///< EV_REL or EV_ABS
  std::uint16_t code = 0;
  AxisUse use = AxisUse::kSpeed;
  int axis = 0;  ///< 0 to 2, of the frame
  double sign = 1.0;
  double rest = 0.0;      ///< [counts] where it is not deflected
  double reach = 0.0;     ///< [counts] from there to full deflection; 0 or less: it says nothing
  double flat = 0.0;      ///< [counts] about the rest that mean nothing, by the kernel
  bool is_wheel = false;  ///< kMove: counts are notches
};

/// At most so many axes have a use.
constexpr std::size_t kMostAxes = 8;

struct InputMap {
  InputKind kind = InputKind::kMouse;
  std::vector<AxisMap> axes;
  std::vector<std::uint16_t> buttons;  ///< codes, rising; the first 32
};

/// None if it is not a SpaceMouse, gamepad or mouse.
[[nodiscard]] std::optional<InputMap> mapOf(const Capabilities& has);

}  // namespace palpate::devices::evdev
