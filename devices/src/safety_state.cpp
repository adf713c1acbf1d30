#include "palpate/devices/safety_state.h"

namespace palpate::devices {

std::string_view nameOf(SafetyState state) noexcept {
  switch (state) {
    case SafetyState::kClosed:
      return "closed";
    case SafetyState::kOpen:
      return "open";
    case SafetyState::kUncalibrated:
      return "uncalibrated";
    case SafetyState::kIdle:
      return "idle";
    case SafetyState::kRamping:
      return "ramping";
    case SafetyState::kActive:
      return "active";
    case SafetyState::kFault:
      break;
  }
  return "fault";
}

std::string_view nameOf(SafetyEvent event) noexcept {
  switch (event) {
    case SafetyEvent::kOpened:
      return "opened";
    case SafetyEvent::kReply:
      return "reply, not homed";
    case SafetyEvent::kHomed:
      return "reply, homed";
    case SafetyEvent::kAsked:
      return "force asked for";
    case SafetyEvent::kRamped:
      return "ramp over";
    case SafetyEvent::kBroken:
      return "silence, hang, not finite";
    case SafetyEvent::kFailed:
      return "failure";
    case SafetyEvent::kClosing:
      break;
  }
  return "close";
}

std::string_view textOf(SafetyFault fault) noexcept {
  switch (fault) {
    case SafetyFault::kNone:
      return "no fault";
    case SafetyFault::kSilence:
      return "the device gave no valid reply for too long";
    case SafetyFault::kJump:
      return "the device reported jumps that no hand can make";
    case SafetyFault::kNotFinite:
      return "readings or forces were not finite, one after the other";
    case SafetyFault::kSpeed:
      return "the hand was faster than is safe";
    case SafetyFault::kHomingLost:
      return "the device lost its origin";
    case SafetyFault::kHung:
      return "the servo loop stood still for too long";
    case SafetyFault::kDevice:
      break;
  }
  return "the device reported a fault";
}

}  // namespace palpate::devices
