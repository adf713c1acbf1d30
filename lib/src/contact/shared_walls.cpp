#include "palpate/contact/shared_walls.h"

#include <algorithm>

#include "soft_wall.h"

namespace palpate {

Vec3 SharedWall::rise(double depth) const noexcept {
  Vec3 out(0.0);
  if (height_rise != Vec3(0.0)) out += law.energyPerHeight(depth) * height_rise;
  if (stiffness_rise != Vec3(0.0)) out += law.energyPerStiffness(depth) * stiffness_rise;
  if (stiffening_rise != Vec3(0.0)) out += law.energyPerStiffening(depth) * stiffening_rise;
  return out;
}

void SharedWalls::add(const SharedWall& felt, double share, const Vec3& by_place,
                      const Vec3& by_press) noexcept {
  std::size_t at = count_;
  if (count_ == kMost) {
    auto* const least = std::min_element(
        part_.begin(), part_.end(), [](const Part& a, const Part& b) { return a.share < b.share; });
    if (!(least->share < share)) return;
    at = static_cast<std::size_t>(least - part_.begin());
  } else {
    ++count_;
  }
  part_[at] = {felt, share, by_place, by_press};
}

bool SharedWalls::isStraight() const noexcept {
  return std::all_of(part_.begin(), part_.begin() + static_cast<std::ptrdiff_t>(count_),
                     [](const Part& each) { return each.felt.law.isStraight(); });
}

bool SharedWalls::isEven() const noexcept {
  return count_ == 1 && part_[0].felt.isEven() && part_[0].by_place == Vec3(0.0) &&
         part_[0].by_press == Vec3(0.0);
}

template <typename OfPart>
auto SharedWalls::sum(const OfPart& of) const noexcept {
  decltype(of(part_[0])) out(0.0);
  for (std::size_t i = 0; i < count_; ++i) out += of(part_[i]);
  return out;
}

double SharedWalls::force(double depth) const noexcept {
  return sum([&](const Part& part) { return part.share * part.felt.law.force(depth); });
}

double SharedWalls::tangent(double depth) const noexcept {
  return sum([&](const Part& part) { return part.share * part.felt.law.tangent(depth); });
}

double SharedWalls::energy(double depth) const noexcept {
  return sum([&](const Part& part) { return part.share * part.felt.law.energy(depth); });
}

Vec3 SharedWalls::rise(double depth) const noexcept {
  return sum([&](const Part& part) {
    return part.share * part.felt.rise(depth) + part.byShare(part.by_place, depth);
  });
}

Vec3 SharedWalls::byPress(double depth) const noexcept {
  return sum([&](const Part& part) {
    return part.share * part.felt.byPress(depth) + part.byShare(part.by_press, depth);
  });
}

SoftWall softWall(const SharedWalls& walls, double stop, double give) noexcept {
  return softWallOf(walls, stop, give);
}

}  // namespace palpate
