#include "palpate/devices/virtual_coupling.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "palpate/core/error.h"

namespace palpate::devices {
namespace {

bool isZero(const Vec3& v) noexcept { return v.x == 0.0 && v.y == 0.0 && v.z == 0.0; }

}  // namespace

VirtualCoupling::VirtualCoupling(const CouplingSettings& settings)
    : settings_(settings), slope_(settings.stiffness), give_(1.0 / settings.stiffness) {
  if (!(settings.stiffness > 0.0) || !std::isfinite(settings.stiffness)) {
    throw Error(ErrorKind::kUsage,
                {"coupling.stiffness", "the stiffness of a coupling must be above 0 N/m, not " +
                                           std::to_string(settings.stiffness)});
  }
  if (!(settings.damping >= 0.0) || !std::isfinite(settings.damping)) {
    throw Error(ErrorKind::kUsage,
                {"coupling.damping", "the damping of a coupling must be 0 N s/m or more, not " +
                                         std::to_string(settings.damping)});
  }
}

ToolMotion VirtualCoupling::reach(const Vec3& hand, double dt) noexcept {
  if (!has_begun_) {
    hand_ = hand;
    tool_ = hand;
    asked_ = {hand, Vec3(0.0)};
    answer_ = {};
    has_begun_ = true;
  }
  if (dt > 0.0) {
    per_time_ = 1.0 / dt;
    const double inverse = 1.0 / (settings_.stiffness * dt + settings_.damping);
    slope_ = settings_.stiffness + settings_.damping * per_time_;
    give_ = dt * inverse;
    share_ = settings_.damping * inverse;
  }
  free_ = hand + share_ * (tool_ - hand_);
  hand_ = hand;

  // Solves with the answer of the last tick: its springs continue linearly, its dampers act on the
  // present motion.
  const double drag = answer_.drag * per_time_;
  const double across = answer_.sideways;
  Vec3 x = free_ + give_ * answer_.force;
  if (across + drag > 0.0) {
    x = (slope_ * free_ + answer_.force + across * asked_.position + drag * tool_) *
        (1.0 / (slope_ + across + drag));
  }
  if (!isZero(answer_.normal)) {
    const Vec3& n = answer_.normal;
    const double along = answer_.stiffness;
    const double damper = answer_.damping * per_time_ + drag;
    const double inverse = 1.0 / (slope_ + along + damper);
    const double spring = glm::dot(n, answer_.force) + along * glm::dot(n, asked_.position);
    const double away = glm::dot(n, free_);
    const double there = (slope_ * away + spring + damper * glm::dot(n, tool_)) * inverse;
    // When the hand moves away, a wall does not hold the tool back.
    const bool lets_go = spring < along * there;
    x += ((lets_go ? away : there) - glm::dot(n, x)) * n;
  }
  asked_ = {x, per_time_ * (x - tool_)};
  return asked_;
}

Vec3 VirtualCoupling::push(const ToolForce& answer) noexcept {
  const double drag = answer.drag * per_time_;
  const double across = answer.sideways + drag;
  const double give = across > 0.0 ? 1.0 / (slope_ + across) : give_;
  const Vec3 asked = asked_.position - free_;
  Vec3 way = asked + give * (answer.force - slope_ * asked);
  answer_ = answer;
  if (!isZero(answer.normal)) {
    const Vec3& n = answer.normal;
    const double inverse = 1.0 / (slope_ + answer.stiffness + answer.damping * per_time_ + drag);
    const double there = glm::dot(n, asked);
    const double left = glm::dot(n, answer.force) - slope_ * there;
    way += (std::max(0.0, there + inverse * left) - (there + give * left)) * n;
    answer_.force += (answer.damping * glm::dot(n, asked_.velocity)) * n;
  }
  // The springs' own force is kept for the next tick; the drag is added for this answer only.
  answer_.force += answer.drag * asked_.velocity;
  tool_ = free_ + way;
  return slope_ * way;
}

}  // namespace palpate::devices
