// PaperRenderer's ports: which ones are passed, and which faces they leave open.

#include <algorithm>

#include "palpate/interior/partition.h"
#include "palpate/interior/port_machine.h"
#include "paper_renderer.h"

namespace palpate {
namespace {

constexpr int kHalvings = 40;  // bisections of a tick's way, to find where a face is crossed

}  // namespace

/// Tries the ports of the present state, and after each passage those of the next state: so the
/// paper's conditions "can be tested iteratively".
void PaperRenderer::advance(const Vec3& hip, TickResult& out) noexcept {
  const Partition& partition = scene_->partition();
  partition.signsAt(hip, now_);
  cell_.assign(state_.place.sides);
  entry_count_ = 0;
  bool goes_on = now_ != state_.place.sides;
  for (std::size_t tries = 0; goes_on && tries < TickResult::kMaxEvents; ++tries) {
    goes_on = partition.regionOf(cell_) == state_.place.region;
    if (!goes_on) break;
    const auto ports = scene_->passages().portsOf(state_.place.region);
    goes_on =
        std::any_of(ports.begin(), ports.end(), [&](PortId id) { return tryPort(id, hip, out); }) ||
        tryAbsentWalls(hip);
  }
  state_.place.sides.assign(now_);
}

bool PaperRenderer::turn(std::span<const LeafId> leaves) noexcept {
  turned_.assign(cell_);
  bool is_changed = false;
  for (const LeafId leaf : leaves) {
    if (cell_.inside(leaf) == now_.inside(leaf)) continue;
    turned_.flip(leaf);
    turned_leaf_ = leaf;
    is_changed = true;
  }
  return is_changed;
}

/// Crosses the faces of `to` or of the present region, whichever is the inner one of the two. If a
/// face of the other lies at the same place, one tick crosses both at once.
bool PaperRenderer::turnTo(RegionId to, const Vec3& hip) noexcept {
  const Partition& partition = scene_->partition();
  const RegionId inner = std::max(state_.place.region, to);
  const RegionId outer = std::min(state_.place.region, to);
  if (!turn(partition.leavesOfRegion(inner))) return false;
  if (partition.regionOf(turned_) == to) return true;
  if (outer == kOutside) return false;
  const Vec3 at = crossingPoint(turned_leaf_, hip);
  const double together = layers_[inner - 1].beneath;
  for (const LeafId leaf : partition.leavesOfRegion(outer)) {
    if (turned_.inside(leaf) == now_.inside(leaf)) continue;
    if (glm::distance(crossingPoint(leaf, hip), at) <= together) turned_.flip(leaf);
  }
  return partition.regionOf(turned_) == to;
}

bool PaperRenderer::tryPort(PortId id, const Vec3& hip, TickResult& out) noexcept {
  const Port& port = scene_->ports()[id];
  const Partition& partition = scene_->partition();
  if (!scene_->passages().isDue(port, state_.place.passed)) return false;
  for (const std::vector<RegionId>* side : {&port.to, &port.from}) {
    for (const RegionId to : *side) {
      if (to == state_.place.region || !port.leads(state_.place.region, to)) continue;
      if (port.on.empty()) {
        if (!turnTo(to, hip)) continue;
      } else {
        if (!turn(port.on) || partition.regionOf(turned_) != to) continue;
        const RegionId inner = std::max(state_.place.region, to);
        // The HIP must not have crossed the walls beside the face, before or in this tick.
        scratch_.assign(now_);
        if (inner == state_.place.region) {
          for (const LeafId leaf : port.on) scratch_.set(leaf, cell_.inside(leaf));
        }
        if (!partition.layerHolds(inner, scratch_)) continue;
      }
      const Vec3 point = crossingPoint(turned_leaf_, hip);
      if (port.mask >= 0) {
        partition.signsAt(point, scratch_);
        if (!partition.maskHolds(static_cast<std::size_t>(port.mask), scratch_)) continue;
      }
      scene_->passages().pass(state_.place.passed, id, state_.place.region, to,
                              scene_->keepsMemory());
      const Vec3 back = unitOr(state_.hip - hip, Vec3(0.0));
      crossings_[out.event_count] = {
          .port = id, .from = state_.place.region, .to = to, .point = point, .normal = back};
      out.events[out.event_count++] = id;
      enter({.from = state_.place.region, .to = to, .port = id, .point = point, .normal = back});
      return true;
    }
  }
  return false;
}

bool PaperRenderer::tryAbsentWalls(const Vec3& hip) noexcept {
  // NOLINTNEXTLINE(readability-use-anyofallof): it does more than look.
  for (const RegionId to : free_ways_of_[state_.place.region]) {
    if (!turnTo(to, hip)) continue;
    scene_->passages().arrive(state_.place.passed, state_.place.region, to, scene_->keepsMemory());
    enter({.from = state_.place.region,
           .to = to,
           .point = crossingPoint(turned_leaf_, hip),
           .normal = unitOr(state_.hip - hip, Vec3(0.0))});
    return true;
  }
  return false;
}

/// The point where this tick's way crosses the face `leaf`.
Vec3 PaperRenderer::crossingPoint(LeafId leaf, const Vec3& hip) const noexcept {
  const Field& face = *scene_->partition().leaves()[leaf].field;
  const bool began_inside = cell_.inside(leaf);
  Vec3 before = state_.hip;
  Vec3 behind = hip;
  for (int k = 0; k < kHalvings; ++k) {
    const Vec3 middle = 0.5 * (before + behind);
    ((face.value(middle) < 0.0) == began_inside ? before : behind) = middle;
  }
  return behind;
}

void PaperRenderer::enter(const RegionEntry& entry) noexcept {
  cell_.assign(turned_);
  state_.place.region = entry.to;
  state_.paper.holds = false;  // the previous contact may have been with another surface
  if (entry_count_ < entries_.size()) entries_[entry_count_++] = entry;
  openFaces();
}

/// A face is open if a port on it lets the probe through in the present state, out of the layer or
/// into it.
void PaperRenderer::openFaces() noexcept {
  for (std::size_t i = 0; i < layers_.size(); ++i) {
    const auto self = static_cast<RegionId>(i + 1);
    PaperWall& wall = layers_[i].wall;
    for (std::size_t f = 0; f < wall.faces().size(); ++f) {
      const std::vector<PortId>& ports = wall.faces()[f].ports;
      const bool is_open = std::any_of(ports.begin(), ports.end(), [&](PortId id) {
        const Port& port = scene_->ports()[id];
        const auto leads_out = [&](const std::vector<RegionId>& side) {
          return std::any_of(side.begin(), side.end(),
                             [&](RegionId to) { return to != self && port.leads(self, to); });
        };
        const bool leads = state_.place.region != self ? port.leads(state_.place.region, self)
                                                       : leads_out(port.from) || leads_out(port.to);
        return leads && scene_->passages().isDue(port, state_.place.passed);
      });
      wall.setOpen(f, is_open);
    }
  }
}

}  // namespace palpate
