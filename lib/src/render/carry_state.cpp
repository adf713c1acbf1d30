#include <algorithm>
#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

#include "palpate/core/text.h"
#include "palpate/interior/partition.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/render/tick_state.h"
#include "state_check.h"

namespace palpate {
namespace {

/// The index in `all` of the element called `name`.
template <typename Named>
std::optional<std::size_t> placeOf(std::span<const Named> all, std::string_view name) {
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Named& one) { return one.name == name; });
  if (at == all.end()) return std::nullopt;
  return static_cast<std::size_t>(at - all.begin());
}

/// The port in `to` with the name that port `id` has in `from`; `lost` lists the ones that `to`
/// does not have.
std::optional<PortId> portThere(PortId id, const Scene& from, const Scene& to,
                                std::vector<std::string>& lost) {
  const std::string& name = from.ports()[id].name;
  if (const auto there = placeOf(to.ports(), name)) return static_cast<PortId>(*there);
  const std::string what = "port " + inQuotes(name);
  if (std::find(lost.begin(), lost.end(), what) == lost.end()) lost.push_back(what);
  return std::nullopt;
}

/// -1 if there is none, or if `to` does not have it.
int materialThere(int id, const Scene& from, const Scene& to) {
  if (id < 0) return -1;
  const auto there = placeOf(to.materials(), from.materials()[static_cast<std::size_t>(id)].name);
  return there ? static_cast<int>(*there) : -1;
}

PassedPorts carried(const PassedPorts& passed, const Scene& from, const Scene& to,
                    std::vector<std::string>& lost) {
  PassedPorts out;
  for (std::size_t id = 0; id < from.ports().size(); ++id) {
    const int slot = from.ports()[id].slot;
    if (slot < 0 || passed.turn(static_cast<std::size_t>(slot)) == 0) continue;
    const auto there = portThere(static_cast<PortId>(id), from, to, lost);
    // A port that no `after` names any more is not needed.
    if (!there || to.ports()[*there].slot < 0) continue;
    out.take(static_cast<std::size_t>(to.ports()[*there].slot), passed,
             static_cast<std::size_t>(slot));
  }
  return out;
}

Punctures carried(const Punctures& punctures, const Scene& from, const Scene& to,
                  std::vector<std::string>& lost) {
  Punctures out;
  for (const Hole& hole : punctures.holes()) {
    if (const auto there = portThere(hole.port, from, to, lost)) {
      Port port = to.ports()[*there];
      port.rearm = 0.0;  // the list of resting ports, below, is carried separately
      out.puncture(*there, port, hole.point);
    }
  }
  for (const Punctures::Resting& resting : punctures.resting()) {
    if (const auto there = portThere(resting.port, from, to, lost)) {
      out.rest(*there, resting.point, to.ports()[*there].rearm);
    }
  }
  return out;
}

/// The leaf of `to` that corresponds to `leaf` of `from`, judged at `p` [m]; -1: there is none.
/// Leaves have no names, but one that was not edited has the same value and gradient there, and the
/// same box.
int leafThere(LeafId leaf, const Vec3& p, const Scene& from, const Scene& to) {
  const Leaf& old = from.partition().leaves()[leaf];
  const FieldSample was = old.field->sample(p);
  const Box3 box = old.field->bounds();
  const auto is_same = [&](const Leaf& one) {
    const FieldSample is = one.field->sample(p);
    const Box3 bounds = one.field->bounds();
    return was.in_band == is.in_band && was.value == is.value && was.gradient == is.gradient &&
           box.lo == bounds.lo && box.hi == bounds.hi;
  };
  const auto leaves = to.partition().leaves();
  // If several look the same there, take the one that kept its number.
  if (leaf < leaves.size() && is_same(leaves[leaf])) return leaf;
  const auto at = std::find_if(leaves.begin(), leaves.end(), is_same);
  return at == leaves.end() ? -1 : static_cast<int>(at - leaves.begin());
}

}  // namespace

CarriedState carryState(const RendererState& sealed, RendererKind kind, const Scene& from,
                        const Scene& to) {
  const TickState state = TickState::of(sealed);
  CarriedState out;
  TickState after;
  after.kind = kind;
  if (!isStateOf(state, kind, from)) {
    out.lost.emplace_back("all of it: the state is of another kind of renderer or another scene");
    after.guard = state.guard;
    after.guard.reset();
    after.last.region = to.startRegion();
    out.state = after.sealed();
    return out;
  }
  const std::string& name = from.regions()[state.place.region].name;
  const auto region = placeOf(to.regions(), name);
  const PassedPorts passed = carried(state.place.passed, from, to, out.lost);
  const Punctures punctures = carried(state.place.punctures, from, to, out.lost);
  const bool is_there =
      region && (kind == RendererKind::kPaper || to.regionAt(state.place.point) == *region);
  out.goes_on = state.has_begun && is_there;
  after.guard = state.guard;
  after.source.work = state.source.work;
  if (!out.goes_on) {
    if (!region) out.lost.push_back("region " + inQuotes(name));
    if (state.has_begun && region && !is_there)
      out.lost.push_back("the probe's place in region " + inQuotes(name));
    after.guard.reset();
    after.last.region = to.startRegion();
    out.state = after.sealed();
    return out;
  }
  const auto there = static_cast<RegionId>(*region);
  after.has_begun = true;
  after.hip = state.hip;
  after.last = state.last;
  after.last.region = there;
  after.last.event_count = 0;
  PlaceState& place = after.place;
  place.point = state.place.point;
  place.region = there;
  place.sides = Signs(to.partition().leaves().size());
  to.partition().signsAt(place.point, place.sides);
  place.passed = passed;
  place.punctures = punctures;
  after.friction = state.friction;
  after.fade.region = there;
  if (state.place.mouth >= 0) {
    place.mouth = leafThere(static_cast<LeafId>(state.place.mouth), place.point, from, to);
    if (place.mouth >= 0) {
      after.fade.share = state.fade.share;
    } else if (to.regions()[there].content >= 0) {
      out.lost.push_back("the opening into region " + inQuotes(name));
    }
  }
  after.pressed = materialThere(state.pressed, from, to);
  const RelaxationState& relaxed = state.relaxation;
  const auto pressed_from = placeOf(to.regions(), from.regions()[relaxed.region].name);
  const int wall = materialThere(relaxed.material, from, to);
  if (pressed_from && wall >= 0) {
    after.relaxation = relaxed;
    after.relaxation.region = static_cast<RegionId>(*pressed_from);
    after.relaxation.material = wall;
  }
  out.state = after.sealed();
  return out;
}

}  // namespace palpate
