#pragma once
/// What punctures leave behind: the holes made, and the ports that must rest before they open by
/// force again.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "palpate/interior/port.h"

namespace palpate {

/// Where a wall was opened by force, and what it takes to go through there again.
struct Hole {
  PortId port = 0;
  Vec3 point{0.0, 0.0, 0.0};  ///< [m, world]
  double radius = 0.0;        ///< [m] Port::hole_radius
  double reopens_at = 0.0;    ///< [N] Port::reopens_at there
};

/// A bounded memory: a value of fixed size, to be copied to rewind. The hole made after the last
/// that there is room for takes the place of the oldest, whose wall closes. Of ports that rest
/// beyond kMaxResting the one that began first is armed again at once. Real-time safe.
class Punctures {
 public:
  static constexpr std::size_t kMaxHoles = 32;
  static constexpr std::size_t kMaxResting = 64;

  /// `port` was opened by force at `point` [m]: leaves a hole, if the port makes such and none of
  /// its holes is there, and begins its rest, if it has a re-arm distance.
  void puncture(PortId id, const Port& port, const Vec3& point) noexcept;
  /// The proxy is at `p` [m]: ends the rest of the ports that it is far enough from.
  void visit(const Vec3& p) noexcept;
  void clear() noexcept { *this = {}; }

  /// `port`, opened by force at `point` [m], rests until the proxy is `rearm` [m] from there; not
  /// if that is 0 or less.
  void rest(PortId id, const Vec3& point, double rearm) noexcept;
  /// Whether these can be punctures in a scene of so many ports.
  [[nodiscard]] bool isOf(std::size_t ports) const noexcept;

  [[nodiscard]] std::span<const Hole> holes() const noexcept {
    return {holes_.data(), hole_count_};
  }
  struct Resting {
    PortId port = 0;
    Vec3 point{0.0, 0.0, 0.0};  ///< [m, world] where it was opened
    double rearm = 0.0;         ///< [m] Port::rearm
  };
  /// The ports that rest, the one that began first in front.
  [[nodiscard]] std::span<const Resting> resting() const noexcept {
    return {resting_.data(), resting_count_};
  }
  /// Whether any hole reaches `p` [m].
  [[nodiscard]] bool anyAt(const Vec3& p) const noexcept;
  /// The hole of `port` that `p` [m] lies in; null if there is none.
  [[nodiscard]] const Hole* holeAt(PortId port, const Vec3& p) const noexcept;
  /// [m] While it rests, a port opens only to a hand that is this far beyond its wall; 0 if it does
  /// not rest.
  [[nodiscard]] double restOf(PortId port) const noexcept;

 private:
  std::array<Hole, kMaxHoles> holes_{};
  std::array<Resting, kMaxResting> resting_{};
  std::uint8_t hole_count_ = 0;
  std::uint8_t next_hole_ = 0;  ///< when full: the oldest
  std::uint8_t resting_count_ = 0;
};

}  // namespace palpate
