#pragma once
/// The traces of punctures: the holes made, and the ports that must rest before force opens them
/// again.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "palpate/interior/port.h"

namespace palpate {

/// The place where a wall was opened by force, and the force that it takes to go through there
/// again.
struct Hole {
  PortId port = 0;
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world]
  double radius = 0.0;        ///< [m] Port::hole_radius
  double reopens_at = 0.0;    ///< [N] Port::reopens_at there
};

/// A bounded memory: a value type of fixed size, so that a copy can be restored. When there is no
/// room for another hole, it replaces the oldest one, whose wall closes. When more than kMaxResting
/// ports rest, the one that began first is armed again at once. Real-time safe.
class Punctures {
 public:
  static constexpr std::size_t kMaxHoles = 32;
  static constexpr std::size_t kMaxResting = 64;

  /// `port` was opened by force at `point` [m]: leaves a hole, if the port makes holes and has none
  /// there, and begins its rest, if it has a re-arm distance.
  void puncture(PortId id, const Port& port, const Vec3& point) noexcept;
  /// The proxy is at `p` [m]: ends the rest of the ports from whose opening points it is far enough
  /// away.
  void visit(const Vec3& p) noexcept;
  void clear() noexcept { *this = {}; }

  /// `port`, opened by force at `point` [m], rests until the proxy is `rearm` [m] away from there;
  /// it does not rest if that is 0 or less.
  void rest(PortId id, const Vec3& point, double rearm) noexcept;
  /// Whether these can be the punctures of a scene with that many ports.
  [[nodiscard]] bool isOf(std::size_t ports) const noexcept;

  [[nodiscard]] std::span<const Hole> holes() const noexcept {
    return {holes_.data(), hole_count_};
  }
  struct Resting {
    PortId port = 0;
    Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] where the port was opened
    double rearm = 0.0;         ///< [m] Port::rearm
  };
  /// The ports that rest, beginning with the one that has rested longest.
  [[nodiscard]] std::span<const Resting> resting() const noexcept {
    return {resting_.data(), resting_count_};
  }
  /// Whether any hole reaches `p` [m].
  [[nodiscard]] bool anyAt(const Vec3& p) const noexcept;
  /// The hole of `port` that contains `p` [m]; null if there is none.
  [[nodiscard]] const Hole* holeAt(PortId port, const Vec3& p) const noexcept;
  /// [m] While it rests, a port opens only to a hand that is this far beyond its wall; 0 if it does
  /// not rest.
  [[nodiscard]] double restOf(PortId port) const noexcept;

 private:
  std::array<Hole, kMaxHoles> holes_{};
  std::array<Resting, kMaxResting> resting_{};
  std::uint8_t hole_count_ = 0;
  std::uint8_t next_hole_ = 0;  ///< when full: index of the oldest
  std::uint8_t resting_count_ = 0;
};

}  // namespace palpate
