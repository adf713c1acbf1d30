#include "palpate/devices/virtual_coupling.h"

#include <algorithm>
#include <cmath>
#include <string>

#include "palpate/core/error.h"

namespace palpate::devices {

VirtualCoupling::VirtualCoupling(const CouplingSettings& settings) : settings_(settings) {
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
  if (dt > 0.0) per_time_ = 1.0 / dt;
  const double damper = settings_.damping * per_time_;
  slope_ = settings_.stiffness + damper;
  free_ = hand + damper / slope_ * (tool_ - hand_);
  hand_ = hand;

  // Solves with the answer of the last tick: its springs go on as they were there, its dampers act on what moves now.
  const Vec3& n = answer_.normal;
  const double drag = answer_.drag * per_time_;
  const double across = answer_.sideways;
  Vec3 x = (slope_ * free_ + answer_.force + across * asked_.position + drag * tool_) /
           (slope_ + across + drag);
  const double along = answer_.stiffness;
  const double wall = answer_.damping * per_time_;
  const double spring = glm::dot(n, answer_.force + along * asked_.position);
  const double there = (slope_ * glm::dot(n, free_) + spring + (wall + drag) * glm::dot(n, tool_)) /
                       (slope_ + along + wall + drag);
  // The hand lets go: a wall does not hold the tool back.
  const bool lets_go = spring - along * there < 0.0;
  x += ((lets_go ? glm::dot(n, free_) : there) - glm::dot(n, x)) * n;
  asked_ = {x, per_time_ * (x - tool_)};
  return asked_;
}

Vec3 VirtualCoupling::push(const ToolForce& answer) noexcept {
  const Vec3& n = answer.normal;
  const double drag = answer.drag * per_time_;
  const Vec3 left = answer.force - slope_ * (asked_.position - free_);
  Vec3 step = left / (slope_ + answer.sideways + drag);
  const double normal =
      glm::dot(n, left) / (slope_ + answer.stiffness + answer.damping * per_time_ + drag);
  step += (normal - glm::dot(n, step)) * n;
  Vec3 x = asked_.position + step;
  x -= std::min(0.0, glm::dot(n, x - free_)) * n;
  tool_ = x;
  answer_ = answer;
  // What is kept is the springs' own force.
  answer_.force +=
      answer.drag * asked_.velocity + answer.damping * glm::dot(n, asked_.velocity) * n;
  return slope_ * (x - free_);
}

}  // namespace palpate::devices
