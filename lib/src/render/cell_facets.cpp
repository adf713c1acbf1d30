// CellWalker's facets: the walls around its cell, and how one is crossed.

#include <algorithm>
#include <cmath>
#include <functional>

#include "cell_walker.h"
#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"

namespace palpate {
void CellWalker::gather(LeafId leaf) noexcept {
  crossing_[0] = leaf;
  crossing_count_ = 1;
  if (leaves_.size() == 1) return;
  refresh(0.0);
  bool measured = false;
  Vec3 normal(0.0);
  for (std::size_t k = 0; k < hot_count_ && crossing_count_ < crossing_.size(); ++k) {
    const LeafId other = hot_[k];
    if (other == leaf || isIdle(other)) continue;
    const double near = touch(other) + touch(leaf);
    if (due_[other] - travel_ > near) continue;
    if (std::fabs(measure(other)) > near * leaves_[other].lipschitz) continue;
    if (!measured) {
      normal = side(leaf) * unitOr(leaves_[leaf].field->sample(here_.point).gradient, Vec3(0.0));
      measured = true;
    }
    const Vec3 theirs =
        side(other) * unitOr(leaves_[other].field->sample(here_.point).gradient, Vec3(0.0));
    // The walker crosses against `normal`: it changes the side of the other leaf too if that faces
    // the same way.
    if (glm::dot(normal, theirs) > 1.0 - limits::kParallel) crossing_[crossing_count_++] = other;
  }
}

void CellWalker::flip(LeafId leaf, Signs& signs) const noexcept {
  signs.flip(leaf);
  for (const LeafId wall : scene_.partition().between(leaf)) {
    const bool first = signs.inside(leaves_[wall].ends[0]);
    if (first != signs.inside(leaves_[wall].ends[1])) signs.set(wall, first);
  }
}

Facet CellWalker::facetAt(LeafId leaf) noexcept {
  Known& known = known_[leaf];
  if (known.state == state_ && known.stay == stay_) return known.facet;
  gather(leaf);
  const bool in_hole = here_.punctures.anyAt(here_.point);
  if (crossing_count_ == 1 && !in_hole && known.state == state_ && !known.facet.varies) {
    known.stay = stay_;
    return known.facet;
  }
  beyond_.assign(here_.sides);
  for (std::size_t i = 0; i < crossing_count_; ++i) flip(crossing_[i], beyond_);
  Facet facet =
      scene_.passages().facet(scene_.partition(), here_.region, regionBeyond(), here_.sides,
                              beyond_, std::span(crossing_.data(), crossing_count_), here_.passed,
                              here_.point, in_hole ? &here_.punctures : nullptr);
  if (leaves_[leaf].is_between && facet.beyond == kOutside && here_.region != kOutside) {
    // Where the walls between three labels meet, rounding produces a cell that belongs to none of
    // the labels. No such cell exists, so the facet is closed.
    facet.kind = Facet::Kind::kClosed;
    facet.material = std::max(facet.material, 0);
    facet.opens = false;
  }
  if (is_sealed_ && facet.beyond != here_.region) {
    facet.kind = Facet::Kind::kClosed;
    facet.material = std::max(facet.material, 0);
    facet.opens = false;
  }
  if (crossing_count_ == 1 && !in_hole) known = {facet, state_, stay_};
  return facet;
}

Facet CellWalker::facetAside(std::span<const LeafId> turned, std::span<const LeafId> surface,
                             const Vec3& place) noexcept {
  if (turned.size() + surface.size() > crossing_.size()) return {};
  const Partition& partition = scene_.partition();
  const Passages& passages = scene_.passages();
  crossing_count_ = 0;
  beyond_.assign(here_.sides);
  for (const LeafId leaf : turned) {
    flip(leaf, beyond_);
    crossing_[crossing_count_++] = leaf;
  }
  RegionId near = here_.region;
  if (!turned.empty()) {
    near = regionBeyond();
    if (near != here_.region &&
        passages
            .facet(partition, here_.region, near, here_.sides, beyond_, turned, here_.passed, place)
            .isClosed()) {
      return {};
    }
  }
  aside_.assign(beyond_);
  for (const LeafId leaf : surface) {
    flip(leaf, beyond_);
    crossing_[crossing_count_++] = leaf;
  }
  return passages.facet(partition, near, regionBeyond(), aside_, beyond_, surface, here_.passed,
                        place);
}

bool CellWalker::isSameAcross(LeafId a, LeafId b) noexcept {
  KnownPair& known = known_pair_;
  if (known.state != state_ || known.a != a || known.b != b) {
    crossing_[0] = a;
    crossing_[1] = b;
    crossing_count_ = 2;
    beyond_.assign(here_.sides);
    flip(a, beyond_);
    flip(b, beyond_);
    known = {a, b, state_, regionBeyond() == here_.region};
  }
  return known.is_same;
}

RegionId CellWalker::regionBeyond() const noexcept {
  const Partition& partition = scene_.partition();
  const auto uses_crossed = [&](RegionId region) {
    for (std::size_t i = 0; i < crossing_count_; ++i) {
      const auto regions = partition.regionsOf(crossing_[i]);
      if (std::find(regions.begin(), regions.end(), region) != regions.end()) return true;
    }
    return false;
  };
  RegionId best = kOutside;
  for (const RegionId region : holding_) {
    if (!uses_crossed(region)) {
      best = region;  // the innermost of the layers that do not use a crossed leaf
      break;
    }
  }
  for (std::size_t i = 0; i < crossing_count_; ++i) {
    for (const RegionId region : partition.regionsOf(crossing_[i])) {
      if (region > best && partition.layerHolds(region, beyond_)) best = region;
    }
  }
  return best;
}

void CellWalker::updateHolding() noexcept {
  const Partition& partition = scene_.partition();
  for (std::size_t i = 0; i < crossing_count_; ++i) {
    for (const RegionId region : partition.regionsOf(crossing_[i])) {
      const auto at = std::lower_bound(holding_.begin(), holding_.end(), region, std::greater<>());
      const bool was = at != holding_.end() && *at == region;
      const bool is = partition.layerHolds(region, here_.sides);
      if (is && !was) holding_.insert(at, region);  // room for all regions was reserved
      if (was && !is) holding_.erase(at);
    }
  }
}

void CellWalker::cross(LeafId leaf, const Facet& facet, double force) noexcept {
  gather(leaf);
  const double came_from = side(leaf);
  for (std::size_t i = 0; i < crossing_count_; ++i) flip(crossing_[i], here_.sides);
  updateHolding();
  --crossings_left_;
  ++state_;
  const bool by_port = facet.kind == Facet::Kind::kOpen || facet.opens;
  if (facet.beyond == here_.region && !by_port) return;
  const Vec3 normal =
      unitOr(came_from * leaves_[leaf].field->sample(here_.point).gradient, Vec3(0.0));
  const bool keep = scene_.keepsMemory();
  const Passages& passages = scene_.passages();
  if (by_port) {
    passages.pass(here_.passed, facet.port, facet.inward, here_.region, facet.beyond, keep);
    if (facet.opens) here_.punctures.puncture(facet.port, scene_.ports()[facet.port], here_.point);
    if (event_count_ < events_.size()) {
      using How = PortCrossing::How;
      const How forced = facet.opens ? How::kPuncture : How::kOpen;
      crossings_[event_count_] = {
          facet.port,  here_.region, facet.beyond, facet.in_hole ? How::kHole : forced,
          here_.point, normal,       force};
      events_[event_count_++] = facet.port;
    }
  } else {
    passages.arrive(here_.passed, here_.region, facet.beyond, keep);
  }
  if (facet.beyond == here_.region) return;  // a port of a sheet
  if (entry_count_ < entries_.size()) {
    entries_[entry_count_++] = {
        .from = here_.region,
        .to = facet.beyond,
        .port = by_port ? static_cast<int>(facet.port) : -1,
        .point = here_.point,
        .normal = normal,
        .force = force,
        .hole_radius = by_port ? scene_.ports()[facet.port].hole_radius : 0.0};
  }
  here_.region = facet.beyond;
  here_.mouth = leaf;
}

}  // namespace palpate
