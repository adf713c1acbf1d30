#pragma once
// A hand that stays near the proxy, at 0.1 m/s and 1 kHz: it wanders, presses, and from time to
// time stands still.

#include <algorithm>
#include <functional>
#include <optional>

#include "support/field_contract.h"
#include "support/region_tree.h"

namespace palpate::test {

class RandomHand {
 public:
  static constexpr double kStep = 1e-4;   ///< [m] a tick
  static constexpr double kReach = 3e-3;  ///< [m] from the proxy
  static constexpr int kFrozenTicks = 40;

  RandomHand(std::uint64_t seed, const Vec3& start)
      : random_(seed * 2 + 1), at_(start), heading_(random_.direction()) {}

  /// The next position, given the proxy's present one; `tree` describes where the proxy may be.
  Vec3 next(const Vec3& proxy, const testing::RegionTree& tree) {
    if (--left_ <= 0) choose(tree);
    if (kind_ == Kind::kFrozen) return at_;
    if (kind_ == Kind::kPress) {
      // Presses in one direction for long: the proxy slides to a place where walls meet.
      const Vec3 way = proxy + depth_ * push_ - at_;
      heading_ = unitOr(unitOr(way, push_) + 0.02 * random_.direction(), push_);
      at_ += std::min(kStep, glm::length(way)) * heading_;
      return at_;
    }
    if (tree.value(at_) > 0.0) {
      // In free space: moves to the nearest wall, because otherwise there is nothing to judge.
      heading_ = unitOr(heading_ + 0.5 * downhill(tree), heading_);
    }
    heading_ = glm::normalize(heading_ + 0.3 * random_.direction());
    const Vec3 out = at_ - proxy;
    const double away = glm::length(out);
    if (away > 0.0 && glm::length(at_ + kStep * heading_ - proxy) > kReach) {
      // Turns along the sphere about the proxy, or back inside it.
      const Vec3 inward = -out / away;
      const Vec3 along = heading_ - std::min(glm::dot(heading_, inward), 0.0) * inward;
      heading_ = glm::normalize(along + 0.2 * inward + 0.1 * random_.direction());
    }
    at_ += kStep * heading_;
    return at_;
  }

  [[nodiscard]] const Vec3& position() const { return at_; }
  [[nodiscard]] bool isFrozen() const { return kind_ == Kind::kFrozen; }
  /// Number of ticks for which it still stands still, this one included.
  [[nodiscard]] int frozenTicksLeft() const { return isFrozen() ? left_ : 0; }

 private:
  enum class Kind { kWander, kPress, kFrozen };

  void choose(const testing::RegionTree& tree) {
    const double which = random_.uniform(0.0, 1.0);
    if (which < 0.3) {
      kind_ = Kind::kWander;
      left_ = static_cast<int>(random_.uniform(10, 60));
    } else if (which < 0.8) {
      kind_ = Kind::kPress;
      // Goes on along the pressed wall, which leads into corners; from time to time turns straight
      // into the nearest wall.
      const Vec3 ahead = random_.uniform(0.0, 1.0) < 0.7 ? heading_ : downhill(tree);
      push_ = unitOr(ahead + random_.direction(), heading_);
      depth_ = random_.uniform(0.3, 1.0) * kReach;
      left_ = static_cast<int>(random_.uniform(40, 150));
    } else {
      kind_ = Kind::kFrozen;
      left_ = kFrozenTicks;
    }
  }

  [[nodiscard]] Vec3 downhill(const testing::RegionTree& tree) const {
    constexpr double kApart = 1e-6;
    Vec3 slope(0.0);
    for (int i = 0; i < 3; ++i) {
      Vec3 a(0.0);
      a[i] = kApart;
      slope[i] = tree.value(at_ - a) - tree.value(at_ + a);
    }
    return unitOr(slope, Vec3(0.0, 0.0, -1.0));
  }

  Random random_;
  Vec3 at_;
  Vec3 heading_;
  Vec3 push_{0.0, 0.0, -1.0};
  double depth_ = kReach;  ///< [m]
  Kind kind_ = Kind::kWander;
  int left_ = 60;
};

/// A point of the start region with some free space around it; nothing if 4000 tries find none.
inline std::optional<Vec3> roomyPoint(const testing::RegionTree& tree, std::uint64_t seed,
                                      double extent = 0.025, double room = 3e-4) {
  Random random(seed * 2);
  std::optional<Vec3> best;
  double most = 0.0;
  for (int i = 0; i < 4000; ++i) {
    const Vec3 p = random.in({Vec3(-extent), Vec3(extent)});
    const double value = tree.value(p);
    if (value > most) {
      most = value;
      best = p;
    }
    if (value > room && value < 0.2 * extent) return p;
  }
  return most > 0.1 * room ? best : std::nullopt;
}

}  // namespace palpate::test
