#pragma once
/// The memory of ports passed.

#include <array>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace palpate {

/// How often each relevant port was passed, and which way last. A value type of fixed size, so that
/// a copy can be restored; it never fills up and never forgets by itself. Relevant are the ports
/// that some `after` names; Passages gives each of them a slot. Real-time safe.
class PassedPorts {
 public:
  /// The most ports that the `after` of all ports together can name; a scene with more is refused
  /// when it is compiled.
  static constexpr std::size_t kCapacity = 128;

  /// [times] that the port was passed, minus the times it was passed back; 0 or more.
  [[nodiscard]] std::int64_t times(std::size_t slot) const noexcept {
    return net_[slot] < 0 ? -net_[slot] : net_[slot];
  }
  /// The direction of the passings that count: 1 in, -1 out, 0 if there are none.
  [[nodiscard]] int turn(std::size_t slot) const noexcept {
    return net_[slot] > 0 ? 1 : net_[slot] < 0 ? -1 : 0;
  }
  /// Records a passing of the port, inward or not. A passing in the direction opposite to those
  /// that count takes one of them back; with `keep` none is ever taken back, and passings in both
  /// directions count.
  void pass(std::size_t slot, bool inward, bool keep) noexcept {
    net_[slot] += inward || keep ? 1 : -1;
  }
  /// Takes one passing back, if those that count were made in this direction.
  void takeBack(std::size_t slot, bool inward) noexcept {
    if (turn(slot) == (inward ? 1 : -1)) net_[slot] -= inward ? 1 : -1;
  }
  /// Copies the count and direction of the port `from` in `other`.
  void take(std::size_t slot, const PassedPorts& other, std::size_t from) noexcept {
    net_[slot] = other.net_[from];
  }
  void clear() noexcept { net_ = {}; }

  friend bool operator==(const PassedPorts&, const PassedPorts&) = default;

 private:
  std::array<std::int64_t, kCapacity> net_{};  ///< by slot: passed inward minus outward
};

static_assert(std::is_trivially_copyable_v<PassedPorts>);

}  // namespace palpate
