#include "palpate/interior/punctures.h"

#include <algorithm>

namespace palpate {
namespace {

bool isWithin(const Vec3& a, const Vec3& b, double distance) noexcept {
  const Vec3 way = a - b;
  return glm::dot(way, way) <= distance * distance;
}

}  // namespace

void Punctures::puncture(PortId id, const Port& port, const Vec3& point) noexcept {
  if (port.hole_radius > 0.0 && holeAt(id, point) == nullptr) {
    const Hole hole{id, point, port.hole_radius, port.reopens_at.at(point)};
    if (hole_count_ < kMaxHoles) {
      holes_[hole_count_++] = hole;
    } else {
      holes_[next_hole_] = hole;
      next_hole_ = static_cast<std::uint8_t>((next_hole_ + 1) % kMaxHoles);
    }
  }
  rest(id, point, port.rearm);
}

void Punctures::rest(PortId id, const Vec3& point, double rearm) noexcept {
  if (!(rearm > 0.0)) return;
  Resting* const end = resting_.data() + resting_count_;
  Resting* at = std::find_if(resting_.data(), end, [&](const Resting& r) { return r.port == id; });
  if (at == end && resting_count_ == kMaxResting) {
    std::move(resting_.data() + 1, end, resting_.data());
    at = end - 1;
  } else if (at == end) {
    ++resting_count_;
  }
  *at = {id, point, rearm};
}

void Punctures::visit(const Vec3& p) noexcept {
  if (resting_count_ == 0) return;
  Resting* const end = resting_.data() + resting_count_;
  const Resting* kept = std::remove_if(resting_.data(), end, [&](const Resting& resting) {
    return !isWithin(p, resting.point, resting.rearm);
  });
  resting_count_ = static_cast<std::uint8_t>(kept - resting_.data());
}

bool Punctures::isOf(std::size_t ports) const noexcept {
  if (hole_count_ > kMaxHoles || next_hole_ >= kMaxHoles || resting_count_ > kMaxResting) {
    return false;
  }
  const auto is_port = [&](const auto& entry) {
    return entry.port < ports && isFinite(entry.point);
  };
  return std::all_of(holes_.begin(), holes_.begin() + hole_count_, is_port) &&
         std::all_of(resting_.begin(), resting_.begin() + resting_count_, is_port);
}

bool Punctures::anyAt(const Vec3& p) const noexcept {
  return std::any_of(holes_.begin(), holes_.begin() + hole_count_,
                     [&](const Hole& hole) { return isWithin(p, hole.point, hole.radius); });
}

const Hole* Punctures::holeAt(PortId port, const Vec3& p) const noexcept {
  for (const Hole& hole : holes()) {
    if (hole.port == port && isWithin(p, hole.point, hole.radius)) return &hole;
  }
  return nullptr;
}

double Punctures::restOf(PortId port) const noexcept {
  for (std::size_t i = 0; i < resting_count_; ++i) {
    if (resting_[i].port == port) return resting_[i].rearm;
  }
  return 0.0;
}

}  // namespace palpate
