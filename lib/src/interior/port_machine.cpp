#include "palpate/interior/port_machine.h"

#include <algorithm>

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
      ports_of_(regions) {
  for (std::size_t region = 0; region < regions; ++region) {
    for (std::size_t port = 0; port < ports_.size(); ++port) {
      for (std::size_t other = 0; other < regions; ++other) {
        if (other != region &&
            ports_[port].leads(static_cast<RegionId>(region), static_cast<RegionId>(other))) {
          ports_of_[region].push_back(static_cast<PortId>(port));
          break;
        }
      }
    }
  }
}

Facet Passages::facet(const Partition& partition, RegionId from, RegionId beyond, const Signs& here,
                      const Signs& there, std::span<const LeafId> crossed,
                      const PassedPorts& passed) const noexcept {
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
  for (const PortId id : ports_of_[from]) {
    const Port& port = ports_[id];
    if (!port.leads(from, facet.beyond)) continue;
    if (!port.on.empty() && !meets(port.on, crossed)) continue;
    // The mask's own leaves are not among those crossed, so the far cell tells its state as well.
    if (port.mask >= 0 && !partition.maskHolds(static_cast<std::size_t>(port.mask), there))
      continue;
    if (!std::all_of(port.after.begin(), port.after.end(),
                     [&](PortId before) { return passed.contains(before); })) {
      continue;
    }
    const double force = port.leadsInward(from, facet.beyond) ? port.opens_at : port.back;
    if (force <= 0.0) {
      facet.kind = Facet::Kind::kOpen;
      facet.port = id;
      facet.opens_at = 0.0;
      return facet;
    }
    if (facet.opens_at == 0.0 || force < facet.opens_at) {
      facet.opens_at = force;
      facet.port = id;
    }
  }
  return facet;
}

Facet Passages::facet(const Partition& partition, RegionId from, const Signs& there,
                      std::span<const LeafId> crossed, const PassedPorts& passed) const {
  Signs here = there;
  for (const LeafId leaf : crossed) here.flip(leaf);
  return facet(partition, from, partition.regionOf(there), here, there, crossed, passed);
}

}  // namespace palpate
