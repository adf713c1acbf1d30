#pragma once
/// SafetyState: what a device may do at the moment, as a table of states and events; and the
/// counters that go with it.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

#include "palpate/export.h"

namespace palpate::devices {

/// A state of the servo loop with its device; it decides which force may be written.
enum class SafetyState : std::uint8_t {
  kClosed,        ///< nothing is written
  kOpen,          ///< no reply yet: zero force
  kUncalibrated,  ///< replies, but its origin is not known: zero force
  kIdle,          ///< ready: zero force until the next tick asks for one
  kRamping,       ///< the force grows from zero to the requested one
  kActive,        ///< the requested force, within the limits
  kFault,         ///< latched: zero force until it is closed and opened again
};
/// Number of values of SafetyState.
inline constexpr std::size_t kSafetyStates = 7;

/// An event that may change the state.
enum class SafetyEvent : std::uint8_t {
  kOpened,   ///< open() has succeeded
  kReply,    ///< a valid reply came
  kHomed,    ///< a valid reply came, and the device knows its origin
  kAsked,    ///< a tick requests a force
  kRamped,   ///< the ramp is over
  kBroken,   ///< silence, a hang, or a value that is not finite, but too short for a fault
  kFailed,   ///< a fault: see SafetyFault
  kClosing,  ///< close()
};
/// Number of values of SafetyEvent.
inline constexpr std::size_t kSafetyEvents = 8;

/// The reason for kFault.
enum class SafetyFault : std::uint8_t {
  kNone,
  kSilence,     ///< no valid reply for too long
  kJump,        ///< readings that the hand cannot have made, several in a row
  kNotFinite,   ///< readings or forces that are not numbers, several in a row
  kSpeed,       ///< the hand was faster than is safe
  kHomingLost,  ///< the device forgot its origin
  kHung,        ///< the loop hung for too long
  kDevice,      ///< the device reported a fault, a timeout, or that it is gone
};

/// The counts of a loop since its device was opened.
struct SafetyCounts {
  std::uint64_t jumps = 0;      ///< readings dropped
  std::uint64_t zeroed = 0;     ///< forces that were not finite, or answered a reading that was not
  std::uint64_t shortened = 0;  ///< forces shortened to the device's maximum
  std::uint64_t warm = 0;       ///< forces reduced because of the motors' heat
  std::uint64_t hangs = 0;      ///< times the loop hung for SafetyLimits::hang
  double heat = 0.0;  ///< [-] the highest; 1: what the continuous force makes in the long run
};

/// One change of state.
struct SafetyRule {
  SafetyState from;   ///< state before the event
  SafetyEvent event;  ///< event that happens
  SafetyState to;     ///< state after it
};

/// All changes of state. Any other event leaves the state as it is.
inline constexpr std::array<SafetyRule, 25> kSafetyRules = {{
    {SafetyState::kClosed, SafetyEvent::kOpened, SafetyState::kOpen},
    {SafetyState::kOpen, SafetyEvent::kReply, SafetyState::kUncalibrated},
    {SafetyState::kOpen, SafetyEvent::kHomed, SafetyState::kIdle},
    {SafetyState::kOpen, SafetyEvent::kFailed, SafetyState::kFault},
    {SafetyState::kOpen, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kUncalibrated, SafetyEvent::kHomed, SafetyState::kIdle},
    {SafetyState::kUncalibrated, SafetyEvent::kBroken, SafetyState::kOpen},
    {SafetyState::kUncalibrated, SafetyEvent::kFailed, SafetyState::kFault},
    {SafetyState::kUncalibrated, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kIdle, SafetyEvent::kAsked, SafetyState::kRamping},
    {SafetyState::kIdle, SafetyEvent::kReply, SafetyState::kFault},
    {SafetyState::kIdle, SafetyEvent::kFailed, SafetyState::kFault},
    {SafetyState::kIdle, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kRamping, SafetyEvent::kRamped, SafetyState::kActive},
    {SafetyState::kRamping, SafetyEvent::kBroken, SafetyState::kIdle},
    {SafetyState::kRamping, SafetyEvent::kReply, SafetyState::kFault},
    {SafetyState::kRamping, SafetyEvent::kFailed, SafetyState::kFault},
    {SafetyState::kRamping, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kActive, SafetyEvent::kBroken, SafetyState::kIdle},
    {SafetyState::kActive, SafetyEvent::kReply, SafetyState::kFault},
    {SafetyState::kActive, SafetyEvent::kFailed, SafetyState::kFault},
    {SafetyState::kActive, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kFault, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kClosed, SafetyEvent::kClosing, SafetyState::kClosed},
    {SafetyState::kFault, SafetyEvent::kFailed, SafetyState::kFault},
}};

/// The state after an event. A pure function.
[[nodiscard]] constexpr SafetyState after(SafetyState state, SafetyEvent event) noexcept {
  for (const SafetyRule& rule : kSafetyRules) {
    if (rule.from == state && rule.event == event) return rule.to;
  }
  return state;
}

/// Whether a force other than zero may be written.
[[nodiscard]] constexpr bool permitsForce(SafetyState state) noexcept {
  return state == SafetyState::kRamping || state == SafetyState::kActive;
}

/// The name of a state in tables and reports: "uncalibrated".
[[nodiscard]] PALPATE_EXPORT std::string_view nameOf(SafetyState state) noexcept;
/// The name of an event: "reply, not homed".
[[nodiscard]] PALPATE_EXPORT std::string_view nameOf(SafetyEvent event) noexcept;
/// A description for messages: "the hand was faster than is safe".
[[nodiscard]] PALPATE_EXPORT std::string_view textOf(SafetyFault fault) noexcept;

}  // namespace palpate::devices
