#include "evdev/input_map.h"

#include <algorithm>

namespace palpate::devices::evdev {
namespace {

/// [counts] A SpaceMouse's full deflection where the kernel reports relative axes, which have no
/// range.
constexpr double kSpaceMouseReach = 350.0;

/// One of an input device's axes, and the axis of the frame that it moves along or turns about.
struct Row {
  std::uint16_t code;
  AxisUse use;
  int axis;
  double sign;
  bool is_trigger = false;  // rests at its lowest value
};

/// X points to the right, Y towards the hand, Z down; the rotations are about the same axes. REL_X
/// to REL_RZ have the same numbers.
constexpr std::array<Row, 6> kSpaceMouse = {{{ABS_X, AxisUse::kSpeed, 0, 1.0},
                                             {ABS_Y, AxisUse::kSpeed, 2, 1.0},
                                             {ABS_Z, AxisUse::kSpeed, 1, -1.0},
                                             {ABS_RX, AxisUse::kTurn, 0, 1.0},
                                             {ABS_RY, AxisUse::kTurn, 2, 1.0},
                                             {ABS_RZ, AxisUse::kTurn, 1, -1.0}}};
static_assert(REL_X == ABS_X && REL_RX == ABS_RX && REL_RZ == ABS_RZ);

/// As in the kernel's gamepad specification: sticks to the right and towards the hand are positive.
constexpr std::array<Row, 6> kGamepad = {{{ABS_X, AxisUse::kSpeed, 0, 1.0},
                                          {ABS_Y, AxisUse::kSpeed, 2, 1.0},
                                          {ABS_RY, AxisUse::kSpeed, 1, -1.0},
                                          {ABS_RX, AxisUse::kTurn, 1, -1.0},
                                          {ABS_RZ, AxisUse::kSpeed, 1, 1.0, true},
                                          {ABS_Z, AxisUse::kSpeed, 1, -1.0, true}}};
/// Gamepads without ABS_RX and ABS_RY have their right stick at ABS_Z and ABS_RZ.
constexpr std::array<Row, 6> kOlderGamepad = {{{ABS_X, AxisUse::kSpeed, 0, 1.0},
                                               {ABS_Y, AxisUse::kSpeed, 2, 1.0},
                                               {ABS_RZ, AxisUse::kSpeed, 1, -1.0},
                                               {ABS_Z, AxisUse::kTurn, 1, -1.0},
                                               {ABS_GAS, AxisUse::kSpeed, 1, 1.0, true},
                                               {ABS_BRAKE, AxisUse::kSpeed, 1, -1.0, true}}};

AxisMap absolute(const Row& row, const Capabilities& has) {
  const input_absinfo& range = has.ranges[row.code];
  const double least = range.minimum;
  const double most = range.maximum;
  return {.type = EV_ABS,
          .code = row.code,
          .use = row.use,
          .axis = row.axis,
          .sign = row.sign,
          .rest = row.is_trigger ? least : 0.5 * (least + most),
          .reach = row.is_trigger ? most - least : 0.5 * (most - least),
          .flat = static_cast<double>(range.flat)};
}

std::vector<AxisMap> absolutes(const std::array<Row, 6>& rows, const Capabilities& has) {
  std::vector<AxisMap> out;
  for (const Row& row : rows) {
    if (has.absolute[row.code]) out.push_back(absolute(row, has));
  }
  return out;
}

std::vector<AxisMap> relatives() {
  std::vector<AxisMap> out;
  for (const Row& row : kSpaceMouse) {
    out.push_back({.type = EV_REL,
                   .code = row.code,
                   .use = row.use,
                   .axis = row.axis,
                   .sign = row.sign,
                   .reach = kSpaceMouseReach});
  }
  return out;
}

/// Positive counts: to the right, towards the hand, and the wheel up.
std::vector<AxisMap> mouseAxes() {
  std::vector<AxisMap> out(3);
  constexpr std::array<std::uint16_t, 3> kCodes = {REL_X, REL_WHEEL, REL_Y};
  for (std::size_t i = 0; i < out.size(); ++i) {
    out[i] = {.type = EV_REL,
              .code = kCodes[i],
              .use = AxisUse::kMove,
              .axis = static_cast<int>(i),
              .is_wheel = kCodes[i] == REL_WHEEL};
  }
  return out;
}

template <std::size_t kSize>
bool hasAll(const std::bitset<kSize>& axes) {
  return std::all_of(kSpaceMouse.begin(), kSpaceMouse.end(),
                     [&](const Row& row) { return axes[row.code]; });
}

std::vector<std::uint16_t> buttonsOf(const Capabilities& has) {
  constexpr std::size_t kMost = 32;
  std::vector<std::uint16_t> out;
  // The kernel's codes for buttons of miscellaneous devices, mice, joysticks and gamepads, but not
  // of a pen's tools.
  for (std::uint16_t code = BTN_MISC; code < BTN_DIGI && out.size() < kMost; ++code) {
    if (has.keys[code]) out.push_back(code);
  }
  return out;
}

}  // namespace

std::optional<InputMap> mapOf(const Capabilities& has) {
  InputMap map;
  map.buttons = buttonsOf(has);
  const bool is_pad = has.keys[BTN_GAMEPAD] || has.keys[BTN_JOYSTICK];
  if (hasAll(has.relative)) {
    map.kind = InputKind::kSpaceMouse;
    map.axes = relatives();
  } else if (hasAll(has.absolute) && has.keys[BTN_0] && !is_pad) {
    // A button distinguishes it from the acceleration sensors of a gamepad, which have six axes as
    // well.
    map.kind = InputKind::kSpaceMouse;
    map.axes = absolutes(kSpaceMouse, has);
  } else if (is_pad && has.absolute[ABS_X] && has.absolute[ABS_Y]) {
    map.kind = InputKind::kGamepad;
    const bool is_usual = has.absolute[ABS_RX] && has.absolute[ABS_RY];
    map.axes = absolutes(is_usual ? kGamepad : kOlderGamepad, has);
  } else if (has.keys[BTN_LEFT] && has.relative[REL_X] && has.relative[REL_Y]) {
    map.kind = InputKind::kMouse;
    map.axes = mouseAxes();
  } else {
    return std::nullopt;
  }
  return map;
}

}  // namespace palpate::devices::evdev
