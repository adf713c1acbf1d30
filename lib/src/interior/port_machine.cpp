#include "palpate/interior/port_machine.h"

#include <algorithm>
#include <string>
#include <utility>

#include "palpate/core/error.h"

namespace palpate {
namespace {

bool holds(const std::vector<RegionId>& set, RegionId region) noexcept {
  return std::find(set.begin(), set.end(), region) != set.end();
}

bool meets(const std::vector<LeafId>& leaves, std::span<const LeafId> crossed) noexcept {
  return std::any_of(crossed.begin(), crossed.end(), [&](LeafId leaf) {
    return std::find(leaves.begin(), leaves.end(), leaf) != leaves.end();
  });
}

}  // namespace

bool Port::leadsInward(RegionId a, RegionId b) const noexcept {
  return direction != PortDirection::kOut && holds(from, a) && holds(to, b);
}

bool Port::leads(RegionId a, RegionId b) const noexcept {
  return leadsInward(a, b) || (direction != PortDirection::kIn && holds(to, a) && holds(from, b));
}

Passages::Passages(std::size_t regions, std::vector<Wall> walls, std::vector<Port> ports,
                   std::vector<Sheet> sheets)
    : regions_(regions),
      walls_(std::move(walls)),
      ports_(std::move(ports)),
      sheets_(std::move(sheets)),
      ports_of_(regions),
      ways_of_(regions),
      ports_of_sheet_(sheets_.size()) {
  giveSlots();
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    const Port& way = ports_[port];
    if (way.sheet >= 0) {
      ports_of_sheet_[static_cast<std::size_t>(way.sheet)].push_back(static_cast<PortId>(port));
      continue;
    }
    const auto add = [&](const std::vector<RegionId>& from, const std::vector<RegionId>& to) {
      for (const RegionId a : from) {
        for (const RegionId b : to) {
          if (a != b && way.leads(a, b)) ways_of_[a].push_back({b, static_cast<PortId>(port)});
        }
      }
    };
    add(way.from, way.to);
    add(way.to, way.from);
  }
  for (std::size_t region = 0; region < regions; ++region) {
    std::vector<Way>& ways = ways_of_[region];
    const auto key = [](const Way& way) { return std::pair(way.to, way.port); };
    std::sort(ways.begin(), ways.end(),
              [&](const Way& a, const Way& b) { return key(a) < key(b); });
    ways.erase(std::unique(ways.begin(), ways.end(),
                           [&](const Way& a, const Way& b) { return key(a) == key(b); }),
               ways.end());
    std::vector<PortId>& own = ports_of_[region];
    for (const Way& way : ways) own.push_back(way.port);
    std::sort(own.begin(), own.end());
    own.erase(std::unique(own.begin(), own.end()), own.end());
  }
}

void Passages::giveSlots() {
  for (const Port& port : ports_) {
    for (const PassedBefore& before : port.after) {
      if (before.port >= ports_.size()) continue;  // never passed, so the port is not due
      int& slot = ports_[before.port].slot;
      if (slot >= 0) continue;
      slot = static_cast<int>(counted_.size());
      counted_.push_back(before.port);
    }
  }
  if (counted_.size() <= PassedPorts::kCapacity) return;
  throw inputError("scene.too_many_counted_ports",
                   "all `after` together name " + std::to_string(counted_.size()) +
                       " different ports; passings can be counted of at most " +
                       std::to_string(PassedPorts::kCapacity),
                   "name fewer: if port c comes after b, and b after a, then c need not name a");
}

Facet Passages::facet(const Partition& partition, RegionId from, RegionId beyond, const Signs& here,
                      const Signs& there, std::span<const LeafId> crossed,
                      const PassedPorts& passed, const Vec3& at,
                      const Punctures* holes) const noexcept {
  Facet facet;
  facet.beyond = beyond;
  if (facet.beyond == from) {
    if (!sheets_.empty()) {
      lookThroughSheets(partition, here, there, crossed, passed, at, holes, facet);
    }
    return facet;
  }
  const Wall& between = wall(from, facet.beyond);
  if (between.absent) {
    facet.kind = Facet::Kind::kAbsent;
    return facet;
  }
  facet.kind = Facet::Kind::kClosed;
  facet.material = between.material;
  const std::vector<Way>& ways = ways_of_[from];
  for (auto way = std::lower_bound(ways.begin(), ways.end(), beyond,
                                   [](const Way&a, RegionId to) { return a.to < to; });
       way != ways.end() && way->to == beyond; ++way) {
    const Port& port = ports_[way->port];
    if (!port.on.empty() && !meets(port.on, crossed)) continue;
    const Turn turn{port.leadsInward(from, beyond), port.countsInward(from, beyond)};
    if (consider(partition, way->port, turn, there, passed, at, holes, facet)) return facet;
  }
  return facet;
}

bool Passages::consider(const Partition& partition, PortId id, Turn turn, const Signs& there,
                        const PassedPorts& passed, const Vec3& at, const Punctures* holes,
                        Facet& facet) const noexcept {
  const Port& port = ports_[id];
  // The mask's own leaves are not among those crossed, so the signs of the far cell decide the mask
  // as well.
  if (port.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(port.mask), there)) {
    return false;
  }
  if (!isDue(port, passed)) return false;
  const Parameter& given = turn.is_way_in ? port.opens_at : port.back;
  double force = given.at(at);
  const Hole* hole = holes == nullptr ? nullptr : holes->holeAt(id, at);
  const bool in_hole = hole != nullptr && hole->reopens_at < force;
  if (in_hole) force = hole->reopens_at;
  // A place where a map is 0 does not border on a cell of its own: a port with a map is a wall
  // until it is touched.
  if (force <= 0.0 && (in_hole || given.isConstant())) {
    facet.kind = Facet::Kind::kOpen;
    facet.port = id;
    facet.inward = turn.counts_inward;
    facet.opens = false;
    facet.varies = false;
    facet.opens_at = 0.0;
    facet.in_hole = in_hole;
    return true;
  }
  facet.varies = facet.varies || !given.isConstant();
  if (!facet.opens || force < facet.opens_at) {
    facet.opens = true;
    facet.opens_at = force;
    facet.port = id;
    facet.inward = turn.counts_inward;
    facet.in_hole = in_hole;
  }
  return false;
}

void Passages::lookThroughSheets(const Partition& partition, const Signs& here, const Signs& there,
                                 std::span<const LeafId> crossed, const PassedPorts& passed,
                                 const Vec3& at, const Punctures* holes,
                                 Facet& facet) const noexcept {
  for (std::size_t i = 0; i < sheets_.size(); ++i) {
    const Sheet& sheet = sheets_[i];
    if (!meets(sheet.leaves, crossed)) continue;
    const auto solid = static_cast<std::size_t>(sheet.solid);
    const bool inward = partition.maskHolds(solid, there);
    if (partition.maskHolds(solid, here) == inward) continue;
    if (sheet.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(sheet.mask), there))
      continue;
    facet.kind = Facet::Kind::kClosed;
    facet.material = sheet.material;
    for (const PortId id : ports_of_sheet_[i]) {
      const PortDirection direction = ports_[id].direction;
      if (direction == (inward ? PortDirection::kOut : PortDirection::kIn)) continue;
      if (consider(partition, id, {inward, inward}, there, passed, at, holes, facet)) return;
    }
    return;
  }
}

Facet Passages::facet(const Partition& partition, RegionId from, const Signs& there,
                      std::span<const LeafId> crossed, const PassedPorts& passed,
                      const Vec3& at) const {
  Signs here = there;
  for (const LeafId leaf : crossed) here.flip(leaf);
  return facet(partition, from, partition.regionOf(there), here, there, crossed, passed, at);
}

bool Passages::isDue(const Port& port, const PassedPorts& passed) const noexcept {
  return std::all_of(port.after.begin(), port.after.end(), [&](const PassedBefore& before) {
    if (before.port >= ports_.size()) return false;
    const int slot = ports_[before.port].slot;
    return slot >= 0 && passed.times(static_cast<std::size_t>(slot)) >= before.times;
  });
}

void Passages::pass(PassedPorts& passed, PortId port, bool inward, RegionId from, RegionId to,
                    bool keep) const noexcept {
  if (!keep && to == kOutside && from != to) {
    passed.clear();
    return;
  }
  const int slot = ports_[port].slot;
  if (slot >= 0) passed.pass(static_cast<std::size_t>(slot), inward, keep);
}

void Passages::arrive(PassedPorts& passed, RegionId from, RegionId to, bool keep) const noexcept {
  if (keep) return;
  if (to == kOutside) {
    passed.clear();
    return;
  }
  for (const PortId id : counted_) {
    const Port& port = ports_[id];
    if (!port.leads(to, from)) continue;
    passed.takeBack(static_cast<std::size_t>(port.slot), port.countsInward(to, from));
  }
}

}  // namespace palpate
