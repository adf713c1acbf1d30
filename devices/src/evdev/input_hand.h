#pragma once
// Integrates a position from an input device's events. Real time: nothing here allocates, locks,
// throws or blocks.

#include <array>
#include <bitset>
#include <cstdint>

#include "evdev/input_map.h"

namespace palpate::devices::evdev {

/// A value type that does not read a clock: it is given all times [ns], which are monotonic.
class InputHand {
 public:
  /// Axes beyond kMostAxes are ignored.
  InputHand(const InputMap& map, const EvdevSettings& settings, std::int64_t now);

  /// Takes an event with the time `at`. Events take effect with the SYN_REPORT that ends them.
  /// Returns true if the kernel has dropped events: the caller then has to query the present state
  /// and pass it to setAxis() and setKeys().
  [[nodiscard]] bool take(std::uint16_t type, std::uint16_t code, std::int32_t value,
                          std::int64_t at) noexcept;
  void setAxis(std::uint16_t code, std::int32_t value) noexcept;  ///< an absolute axis
  void setKeys(const std::bitset<KEY_CNT>& keys) noexcept;

  /// Moves on with the present velocities up to time `to`; an earlier time than the current one has
  /// no effect.
  void advance(std::int64_t to) noexcept;

  [[nodiscard]] const Vec3& position() const noexcept { return position_; }        ///< [m]
  [[nodiscard]] const Mat3& orientation() const noexcept { return orientation_; }  ///< a rotation
  [[nodiscard]] std::uint32_t buttons() const noexcept { return now_.buttons; }

  /// [ns] for which a relative axis keeps its deflection without a new report. It is assumed that
  /// such devices repeat it every 8 to 16 ms while they are deflected.
  static constexpr std::int64_t kHold = 50'000'000;

 private:
  struct Inputs {
    std::array<double, kMostAxes> deflection{};  // [-] -1 to 1
    std::uint32_t buttons = 0;
  };

  void takeAxis(std::uint16_t type, std::uint16_t code, std::int32_t value) noexcept;
  void takeKey(Inputs& inputs, std::uint16_t code, bool is_pressed) noexcept;
  void finish(std::int64_t at) noexcept;
  void forget() noexcept;
  [[nodiscard]] double deflectionOf(std::size_t axis, double value) const noexcept;
  [[nodiscard]] Vec3 sum(AxisUse use) const noexcept;
  [[nodiscard]] std::int64_t spanOf(AxisUse use, std::int64_t to) const noexcept;
  void place(const Vec3& position) noexcept;

  std::array<AxisMap, kMostAxes> axes_{};
  std::size_t count_ = 0;
  std::array<std::uint16_t, 32> buttons_{};
  std::size_t button_count_ = 0;
  EvdevSettings settings_;
  std::int64_t time_;  // [ns]
  Inputs now_;
  Inputs next_;                 // now_ updated by the events since the last SYN_REPORT
  Vec3 way_{0.0, 0.0, 0.0};     // [m] displacement by these events
  std::array<bool, 2> told_{};  // whether these events reported kSpeed, kTurn of relative axes
  std::array<std::int64_t, 2> told_at_{};  // [ns] time of the last such report
  bool is_relative_ = false;               // its deflections come from relative axes
  bool is_dropping_ = false;
  Vec3 position_{0.0, 0.0, 0.0};
  Mat3 orientation_{1.0};
};

}  // namespace palpate::devices::evdev
