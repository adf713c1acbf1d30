#include "state_check.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "palpate/interior/partition.h"

namespace palpate {
namespace {

/// A bool may contain only the bytes 0 and 1.
bool isBool(const bool& value) noexcept {
  unsigned char byte = 0;
  std::memcpy(&byte, &value, sizeof byte);
  return byte <= 1;
}

template <typename... Bools>
bool areBools(const Bools&... values) noexcept {
  return (isBool(values) && ...);
}

template <typename... Numbers>
bool areFinite(Numbers... values) noexcept {
  return (std::isfinite(values) && ...);
}

/// The numbers of regions, materials, leaves and ports of a scene.
class Counts {
 public:
  explicit Counts(const Scene& scene) noexcept
      : regions_(scene.regions().size()),
        materials_(scene.materials().size()),
        leaves_(scene.partition().leaves().size()),
        ports_(scene.ports().size()) {}

  [[nodiscard]] bool hold(const TickResult& last) const noexcept {
    if (!isRegion(last.region) || last.event_count > TickResult::kMaxEvents) return false;
    const auto* const end = last.events.begin() + last.event_count;
    return std::all_of(last.events.begin(), end, [&](PortId port) { return port < ports_; }) &&
           isFinite(last.force) && isFinite(last.proxy) && areBools(last.contact, last.settled);
  }
  /// Before the first tick there are no sides of leaves yet.
  [[nodiscard]] bool hold(const PlaceState& place, bool has_begun) const noexcept {
    return HapticRenderer::isInReach(place.point) && isRegion(place.region) &&
           isOneOf(place.mouth, leaves_) && (!has_begun || place.sides.isOf(leaves_)) &&
           place.punctures.isOf(ports_);
  }
  [[nodiscard]] bool hold(const RelaxationState& relaxation) const noexcept {
    return isRegion(relaxation.region) && isOneOf(relaxation.material, materials_) &&
           areFinite(relaxation.branch.stretch(), relaxation.depth);
  }
  [[nodiscard]] bool hold(const FadeState& fade) const noexcept {
    return isRegion(fade.region) && fade.share >= 0.0 && fade.share <= 1.0;
  }
  [[nodiscard]] bool hold(const PaperTouch& paper) const noexcept {
    const bool is_layer = !paper.holds || paper.layer + std::size_t{1} < regions_;
    return isBool(paper.holds) && is_layer && std::fabs(paper.side) == 1.0 &&
           isFinite(paper.contact.surface_point) && isFinite(paper.contact.interaction_point);
  }
  [[nodiscard]] bool hold(const SourceState& source) const noexcept {
    const StoredState& stored = source.stored;
    return isRegion(source.lattice_region) && hold(source.felt) && hold(stored.leaves) &&
           areBools(source.in_lattice, stored.has_friction) && isFinite(source.flow_push) &&
           isFinite(stored.push) && areFinite(source.lattice_energy, stored.energy, source.work);
  }
  [[nodiscard]] bool isMaterial(int id) const noexcept { return isOneOf(id, materials_); }
  [[nodiscard]] std::size_t regions() const noexcept { return regions_; }

 private:
  [[nodiscard]] bool isRegion(std::size_t id) const noexcept { return id < regions_; }
  /// True for a valid index and for -1, which means none.
  [[nodiscard]] static bool isOneOf(int id, std::size_t count) noexcept {
    return id == -1 || (id >= 0 && static_cast<std::size_t>(id) < count);
  }
  [[nodiscard]] bool hold(const FeltLeaves& felt) const noexcept {
    if (felt.count > FeltLeaves::kMost || !isBool(felt.is_full)) return false;
    const auto* const end = felt.leaf.begin() + felt.count;
    return std::all_of(felt.leaf.begin(), end, [&](LeafId leaf) { return leaf < leaves_; });
  }

  std::size_t regions_;
  std::size_t materials_;
  std::size_t leaves_;
  std::size_t ports_;
};

}  // namespace

bool isStateOf(const TickState& state, RendererKind kind, const Scene& scene) noexcept {
  const Counts counts(scene);
  const FrictionState& friction = state.friction;
  if (!isBool(state.has_begun) || (state.has_begun && state.kind != kind)) return false;
  return HapticRenderer::isInReach(state.hip) && counts.hold(state.last) &&
         counts.hold(state.place, state.has_begun) && areBools(friction.sticks, friction.is_felt) &&
         isFinite(friction.lean) && counts.isMaterial(state.pressed) &&
         counts.hold(state.relaxation) && counts.hold(state.fade) &&
         state.needle.isOf(counts.regions()) && counts.hold(state.paper) && state.guard.isSound() &&
         counts.hold(state.source);
}

}  // namespace palpate
