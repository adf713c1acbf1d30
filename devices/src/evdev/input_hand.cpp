#include "evdev/input_hand.h"

#include <algorithm>
#include <cmath>

namespace palpate::devices::evdev {
namespace {

/// The group of a deflection's use: kSpeed or kTurn.
std::size_t groupOf(AxisUse use) noexcept { return use == AxisUse::kTurn ? 1 : 0; }

/// The rotation about the vector `turn` by its length [rad], by Rodrigues' formula.
Mat3 rotationBy(const Vec3& turn) noexcept {
  const double angle = glm::length(turn);
  if (!(angle > 0.0)) return Mat3(1.0);
  const Vec3 u = turn / angle;
  const Mat3 cross(Vec3(0.0, u.z, -u.y), Vec3(-u.z, 0.0, u.x), Vec3(u.y, -u.x, 0.0));
  return Mat3(1.0) + std::sin(angle) * cross + (1.0 - std::cos(angle)) * (cross * cross);
}

/// Removes the rounding errors that a rotation collects over many turns.
Mat3 orthonormal(const Mat3& m) noexcept {
  const Vec3 x = glm::normalize(m[0]);
  const Vec3 y = glm::normalize(m[1] - glm::dot(m[1], x) * x);
  return {x, y, glm::cross(x, y)};
}

}  // namespace

InputHand::InputHand(const InputMap& map, const EvdevSettings& settings, std::int64_t now)
    : count_(std::min(map.axes.size(), axes_.size())),
      button_count_(std::min(map.buttons.size(), buttons_.size())),
      settings_(settings),
      time_(now),
      position_(settings.workspace.center()) {
  std::copy_n(map.axes.begin(), count_, axes_.begin());
  std::copy_n(map.buttons.begin(), button_count_, buttons_.begin());
  is_relative_ = map.kind == InputKind::kSpaceMouse && count_ > 0 && axes_[0].type == EV_REL;
}

double InputHand::deflectionOf(std::size_t axis, double value) const noexcept {
  const AxisMap& map = axes_[axis];
  if (!(map.reach > 0.0)) return 0.0;
  const double dead = std::max(settings_.dead_zone, map.flat / map.reach);
  const double share = (value - map.rest) / map.reach;
  const double beyond = std::abs(share) - dead;
  if (!(beyond > 0.0 && dead < 1.0)) return 0.0;
  return std::copysign(std::min(1.0, beyond / (1.0 - dead)), share);
}

void InputHand::takeAxis(std::uint16_t type, std::uint16_t code, std::int32_t value) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    const AxisMap& map = axes_[i];
    if (map.type != type || map.code != code) continue;
    if (map.use == AxisUse::kMove) {
      const double step = map.is_wheel ? settings_.meters_per_notch : settings_.meters_per_count;
      way_[map.axis] += map.sign * step * value;
      return;
    }
    const std::size_t group = groupOf(map.use);
    if (type == EV_REL && !told_[group]) {
      // The kernel leaves out zeros from the axes in a report.
      told_[group] = true;
      for (std::size_t k = 0; k < count_; ++k) {
        if (groupOf(axes_[k].use) == group) next_.deflection[k] = 0.0;
      }
    }
    next_.deflection[i] = deflectionOf(i, value);
    return;
  }
}

void InputHand::takeKey(Inputs& inputs, std::uint16_t code, bool is_pressed) noexcept {
  for (std::size_t i = 0; i < button_count_; ++i) {
    if (buttons_[i] != code) continue;
    const std::uint32_t bit = std::uint32_t{1} << i;
    inputs.buttons = is_pressed ? inputs.buttons | bit : inputs.buttons & ~bit;
  }
}

void InputHand::forget() noexcept {
  next_ = now_;
  way_ = Vec3(0.0);
  told_ = {};
}

void InputHand::finish(std::int64_t at) noexcept {
  advance(at);
  for (std::size_t group = 0; group < told_.size(); ++group) {
    if (told_[group]) told_at_[group] = time_;
  }
  now_ = next_;
  place(position_ + way_);
  forget();
}

bool InputHand::take(std::uint16_t type, std::uint16_t code, std::int32_t value,
                     std::int64_t at) noexcept {
  if (type == EV_SYN && code == SYN_DROPPED) {
    is_dropping_ = true;
    return false;
  }
  if (type == EV_SYN && code == SYN_REPORT) {
    if (!is_dropping_) {
      finish(at);
      return false;
    }
    // From the first dropped event to here the events are lost. Relative axes report again if they
    // are still deflected.
    is_dropping_ = false;
    advance(at);
    if (is_relative_) now_.deflection = {};
    forget();
    return true;
  }
  if (is_dropping_) return false;
  if (type == EV_REL || type == EV_ABS) takeAxis(type, code, value);
  if (type == EV_KEY) takeKey(next_, code, value != 0);
  return false;
}

void InputHand::setAxis(std::uint16_t code, std::int32_t value) noexcept {
  for (std::size_t i = 0; i < count_; ++i) {
    if (axes_[i].type == EV_ABS && axes_[i].code == code) {
      now_.deflection[i] = deflectionOf(i, value);
    }
  }
  forget();
}

void InputHand::setKeys(const std::bitset<KEY_CNT>& keys) noexcept {
  for (std::size_t i = 0; i < button_count_; ++i) takeKey(now_, buttons_[i], keys[buttons_[i]]);
  forget();
}

Vec3 InputHand::sum(AxisUse use) const noexcept {
  Vec3 out(0.0);
  for (std::size_t i = 0; i < count_; ++i) {
    if (axes_[i].use == use) out[axes_[i].axis] += axes_[i].sign * now_.deflection[i];
  }
  return glm::clamp(out, Vec3(-1.0), Vec3(1.0));
}

std::int64_t InputHand::spanOf(AxisUse use, std::int64_t to) const noexcept {
  const std::int64_t end = is_relative_ ? std::min(to, told_at_[groupOf(use)] + kHold) : to;
  return std::max<std::int64_t>(0, end - time_);
}

void InputHand::advance(std::int64_t to) noexcept {
  if (to <= time_) return;
  const auto seconds = [&](AxisUse use) { return 1e-9 * static_cast<double>(spanOf(use, to)); };
  place(position_ + settings_.max_speed * seconds(AxisUse::kSpeed) * sum(AxisUse::kSpeed));
  const Vec3 turn = settings_.max_turn * seconds(AxisUse::kTurn) * sum(AxisUse::kTurn);
  if (turn != Vec3(0.0)) orientation_ = orthonormal(rotationBy(turn) * orientation_);
  time_ = to;
}

void InputHand::place(const Vec3& position) noexcept {
  position_ = glm::clamp(position, settings_.workspace.lo, settings_.workspace.hi);
}

}  // namespace palpate::devices::evdev
