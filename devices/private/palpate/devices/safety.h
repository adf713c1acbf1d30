#pragma once
/// Safety: decides which readings are believed, and how much of a force reaches the hand.

#include <cstdint>

#include "palpate/devices/device.h"
#include "palpate/devices/reading_watch.h"
#include "palpate/devices/safety_state.h"
#include "palpate/render/force_guard.h"

namespace palpate::devices {

/// The judgment of the device's answer in one turn of the loop.
enum class ReadingVerdict : std::uint8_t {
  kNone,     ///< nothing new, or unusable
  kSound,    ///< use it
  kDropped,  ///< a jump: treated as no answer
};

/// The force after the safety rules.
struct SafeForce {
  Vec3 force{0.0, 0.0, 0.0};  ///< [N] to be written
  double share = 1.0;         ///< [-] of the ramp
  bool is_zeroed = false;     ///< a force or a reading was not finite
  bool is_shortened = false;  ///< shortened to the device's maximum
};

/// A value type without a clock of its own; real-time safe. In each turn of a loop call read(),
/// ask() and wrote(). Times are in [ns] of one clock and never go back; if one does, no time counts
/// as passed.
class Safety {
 public:
  /// `max_force` [N] as in DeviceInfo. `watchdog` [ns]: silence after which the force is zero,
  /// unless the limits ask for a shorter one; at least two `turn`s [ns] of the loop must pass
  /// before. `recovery` [ns]: the ramp after that, unless the limits ask for a longer one.
  Safety(const SafetyLimits& limits, double max_force, std::int64_t watchdog, std::int64_t recovery,
         std::int64_t turn) noexcept;

  /// The device was opened at `now`.
  void open(std::int64_t now) noexcept;
  void close() noexcept;
  /// The loop hung for `duration`, and the force was cut meanwhile.
  void hang(std::int64_t duration) noexcept;

  [[nodiscard]] ReadingVerdict read(std::int64_t now, DeviceStatus status,
                                    const DeviceState& fresh) noexcept;
  /// True if a force may be computed: the last sound reading is recent enough and homed.
  [[nodiscard]] bool ticks() const noexcept;
  /// True if no reading came for too long.
  [[nodiscard]] bool isSilent() const noexcept { return has_reading_ && watch_.hasExpired(); }
  /// The force that may be written when `wanted` [N] is computed. `answers` is the reading that it
  /// answers.
  [[nodiscard]] SafeForce ask(const Vec3& wanted, const DeviceState& answers) noexcept;

  /// Takes the device's answer to the force.
  void wrote(DeviceStatus status) noexcept {
    if (status >= DeviceStatus::kTimeout) fail(SafetyFault::kDevice);
  }

  [[nodiscard]] SafetyState state() const noexcept { return state_; }
  [[nodiscard]] SafetyFault fault() const noexcept { return fault_; }
  [[nodiscard]] const SafetyCounts& counts() const noexcept { return counts_; }
  [[nodiscard]] double heat() const noexcept { return heat_; }  ///< [-]

 private:
  void step(SafetyEvent event) noexcept { state_ = after(state_, event); }
  void fail(SafetyFault fault) noexcept;
  void breakOff() noexcept;
  void strike(int& count, SafetyFault fault) noexcept;
  [[nodiscard]] bool jumps(const Vec3& position) const noexcept;
  void track(const Vec3& position) noexcept;
  void warm(double dt) noexcept;
  [[nodiscard]] Vec3 cooled(const Vec3& force) noexcept;

  SafetyLimits limits_;
  double max_force_;
  ReadingWatch watch_;
  ForceGuard guard_;
  SafetyState state_ = SafetyState::kClosed;
  SafetyFault fault_ = SafetyFault::kNone;
  SafetyCounts counts_;
  bool has_reading_ = false;
  std::int64_t now_ = 0;
  std::int64_t last_reply_ = 0;   ///< [ns] of the last valid reply
  std::int64_t last_asked_ = 0;   ///< [ns] of the last ask()
  std::int64_t last_place_ = -1;  ///< [ns] of the last believed position; below 0: none
  Vec3 place_{0.0, 0.0, 0.0};     ///< [m] the last believed position
  Vec3 speed_{0.0, 0.0, 0.0};     ///< [m/s] filtered
  int jump_strikes_ = 0;
  int finite_strikes_ = 0;
  bool needs_ramp_ = false;  ///< a ramp begins with the next force
  double heat_ = 0.0;
  double load_ = 0.0;  ///< [-] square of the last force over that of the continuous force
};

}  // namespace palpate::devices
