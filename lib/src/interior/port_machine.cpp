#include "palpate/interior/port_machine.h"

#include <algorithm>
#include <utility>

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

bool PassedPorts::contains(PortId port) const noexcept {
  for (std::size_t i = 0; i < size_; ++i) {
    if (stack_[i].port == port) return true;
  }
  return false;
}

void PassedPorts::pass(PortId port, RegionId from, RegionId to, bool keep) noexcept {
  if (keep) {
    if (contains(port)) return;
  } else if (to == kOutside) {
    clear();
    return;
  } else if (size_ > 0 && stack_[size_ - 1].from == to) {
    --size_;
    return;
  }
  if (size_ == kCapacity) {
    std::move(stack_.begin() + 1, stack_.end(), stack_.begin());
    --size_;
  }
  stack_[size_++] = {port, from};
}

void PassedPorts::arrive(RegionId to, bool keep) noexcept {
  if (keep) return;
  if (to == kOutside) {
    clear();
    return;
  }
  // An absent wall counts for nothing: back where a passage began is back before it, and before all since.
  for (std::size_t i = size_; i > 0; --i) {
    if (stack_[i - 1].from == to) {
      size_ = i - 1;
      return;
    }
  }
}

bool operator==(const PassedPorts& a, const PassedPorts& b) noexcept {
  if (a.size_ != b.size_) return false;
  for (std::size_t i = 0; i < a.size_; ++i) {
    if (a.stack_[i].port != b.stack_[i].port || a.stack_[i].from != b.stack_[i].from) return false;
  }
  return true;
}

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
      ways_of_(regions) {
  for (std::size_t port = 0; port < ports_.size(); ++port) {
    const Port& way = ports_[port];
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

Facet Passages::facet(const Partition& partition, RegionId from, RegionId beyond, const Signs& here,
                      const Signs& there, std::span<const LeafId> crossed,
                      const PassedPorts& passed, const Vec3& at,
                      const Punctures* holes) const noexcept {
  Facet facet;
  facet.beyond = beyond;
  if (facet.beyond == from) {
    for (const Sheet& sheet : sheets_) {
      if (!meets(sheet.leaves, crossed)) continue;
      const auto solid = static_cast<std::size_t>(sheet.solid);
      if (partition.maskHolds(solid, here) == partition.maskHolds(solid, there)) continue;
      if (sheet.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(sheet.mask), there))
        continue;
      facet.kind = Facet::Kind::kClosed;
      facet.material = sheet.material;
      break;
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
    const PortId id = way->port;
    const Port& port = ports_[id];
    if (!port.on.empty() && !meets(port.on, crossed)) continue;
    // The mask's own leaves are not among those crossed, so the far cell tells its state as well.
    if (port.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(port.mask), there))
      continue;
    if (!std::all_of(port.after.begin(), port.after.end(),
                     [&](PortId before) { return passed.contains(before); })) {
      continue;
    }
    const Parameter& given = port.leadsInward(from, facet.beyond) ? port.opens_at : port.back;
    double force = given.at(at);
    const Hole* hole = holes == nullptr ? nullptr : holes->holeAt(id, at);
    const bool in_hole = hole != nullptr && hole->reopens_at < force;
    if (in_hole) force = hole->reopens_at;
    // Where a map is 0 is no border of any cell: a port that has one is a wall until it is touched.
    if (force <= 0.0 && (in_hole || given.isConstant())) {
      facet.kind = Facet::Kind::kOpen;
      facet.port = id;
      facet.opens = false;
      facet.varies = false;
      facet.opens_at = 0.0;
      facet.in_hole = in_hole;
      return facet;
    }
    facet.varies = facet.varies || !given.isConstant();
    if (!facet.opens || force < facet.opens_at) {
      facet.opens = true;
      facet.opens_at = force;
      facet.port = id;
      facet.in_hole = in_hole;
    }
  }
  return facet;
}

Facet Passages::facet(const Partition& partition, RegionId from, const Signs& there,
                      std::span<const LeafId> crossed, const PassedPorts& passed,
                      const Vec3& at) const {
  Signs here = there;
  for (const LeafId leaf : crossed) here.flip(leaf);
  return facet(partition, from, partition.regionOf(there), here, there, crossed, passed, at);
}

}  // namespace palpate
