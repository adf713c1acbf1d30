#pragma once
/// The port machine: decides what a facet between two cells is for a proxy in one of them, and how
/// passing it changes the state.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/interior/passed_ports.h"
#include "palpate/interior/port.h"
#include "palpate/interior/punctures.h"

namespace palpate {

/// What separates two regions, seen from the first: a wall or nothing.
struct Wall {
  bool absent = false;
  int material = -1;  ///< index into the scene's materials
};

/// An open surface: part of a leaf's zero set that is a wall although the same region lies on both
/// sides.
struct Sheet {
  std::string name;
  std::vector<LeafId> leaves;  ///< of the field whose zero set contains it
  int solid = -1;              ///< mask of that field: the sheet lies where the mask's sign changes
  int mask = -1;               ///< only within this mask of the partition; -1: everywhere
  int material = -1;           ///< index into the scene's materials
};

/// The meaning of a facet for a proxy on its near side.
struct Facet {
  enum class Kind : std::uint8_t {
    kInternal,  ///< the same region on both sides, and no sheet: nothing stops the proxy
    kAbsent,    ///< another region, no wall: crossed freely
    kOpen,      ///< a port that lets the proxy through now
    kClosed,    ///< a wall
  };
  Kind kind = Kind::kInternal;
  RegionId beyond = kOutside;  ///< the region on the far side
  PortId port = 0;             ///< kOpen: the port; kClosed and opens: the port that would open
  int material = -1;           ///< kClosed: material of the wall, as felt from the near side
  bool inward = false;  ///< with a port: the direction in which it is passed, as PassedPorts counts
  bool opens = false;   ///< kClosed: a port opens it when it is pressed with the force opens_at
  bool varies = false;  ///< opens_at and port may be different elsewhere on the same facet
  double opens_at = 0.0;  ///< [N] elastic normal force that opens it
  bool in_hole = false;   ///< the port's force is that of a hole made before

  [[nodiscard]] bool isClosed() const noexcept { return kind == Kind::kClosed; }
};

/// Walls and ports of a scene, laid out for the loop. Immutable; const members are real-time safe.
class Passages {
 public:
  Passages() = default;
  /// `walls[from * regions + to]`; `ports` in the author's order, which decides if several are
  /// open. @throws Error (kInput) if `after` names more ports than PassedPorts has room for.
  Passages(std::size_t regions, std::vector<Wall> walls, std::vector<Port> ports,
           std::vector<Sheet> sheets = {});

  [[nodiscard]] std::span<const Port> ports() const noexcept { return ports_; }
  [[nodiscard]] std::span<const Sheet> sheets() const noexcept { return sheets_; }
  [[nodiscard]] const Wall& wall(RegionId from, RegionId to) const noexcept {
    return walls_[from * regions_ + to];
  }
  /// The ports that lead out of `region`. A tick tests only these, and the ports of sheets.
  [[nodiscard]] std::span<const PortId> portsOf(RegionId region) const noexcept {
    return ports_of_[region];
  }

  /// The facet at `at` [m] that is crossed when the leaves `crossed` (one, or several that coincide
  /// there) change sign from `here`, a cell of region `from`, to `there`, a cell of region
  /// `beyond`. A hole in `holes` may lower the force needed to pass; null: there are none.
  [[nodiscard]] Facet facet(const Partition& partition, RegionId from, RegionId beyond,
                            const Signs& here, const Signs& there, std::span<const LeafId> crossed,
                            const PassedPorts& passed, const Vec3& at,
                            const Punctures* holes = nullptr) const noexcept;

  /// The same where only the far cell is known: the near cell differs from it in the leaves
  /// `crossed`, and the region beyond is looked up. Copies signs: for set-up and pictures.
  [[nodiscard]] Facet facet(const Partition& partition, RegionId from, const Signs& there,
                            std::span<const LeafId> crossed, const PassedPorts& passed,
                            const Vec3& at) const;

  /// True if everything that `after` demands of `port` was passed.
  [[nodiscard]] bool isDue(const Port& port, const PassedPorts& passed) const noexcept;

  /// Records that `port` was passed from region `from` to `to` (the same region for a port of a
  /// sheet), inward or not. Reaching outside clears all, unless `keep`.
  void pass(PassedPorts& passed, PortId port, bool inward, RegionId from, RegionId to,
            bool keep) const noexcept;
  /// The same for a port of a wall: the regions determine the direction.
  void pass(PassedPorts& passed, PortId port, RegionId from, RegionId to,
            bool keep) const noexcept {
    pass(passed, port, ports_[port].countsInward(from, to), from, to, keep);
  }
  /// Records that the proxy came from region `from` to `to` where there is no wall. That never
  /// counts as passing a port, but it takes back one passing of each port that was passed from `to`
  /// to `from`, and reaching outside clears all; with `keep` it does neither.
  void arrive(PassedPorts& passed, RegionId from, RegionId to, bool keep) const noexcept;

 private:
  /// The direction in which a port would be passed: as it decides the force, and as PassedPorts
  /// counts it.
  struct Turn {
    bool is_way_in;
    bool counts_inward;
  };
  /// Tests whether the mask and the `after` of `port`, which leads through the facet, are
  /// satisfied; if so, updates the facet accordingly. True if the port stands open: then no other
  /// port can change the result.
  bool consider(const Partition& partition, PortId id, Turn turn, const Signs& there,
                const PassedPorts& passed, const Vec3& at, const Punctures* holes,
                Facet& facet) const noexcept;
  void lookThroughSheets(const Partition& partition, const Signs& here, const Signs& there,
                         std::span<const LeafId> crossed, const PassedPorts& passed, const Vec3& at,
                         const Punctures* holes, Facet& facet) const noexcept;
  void giveSlots();

  std::size_t regions_ = 0;
  std::vector<Wall> walls_;
  std::vector<Port> ports_;
  std::vector<Sheet> sheets_;
  std::vector<std::vector<PortId>> ports_of_;
  /// By region: where its ports lead, in the order of regions, then in the author's.
  struct Way {
    RegionId to = kOutside;
    PortId port = 0;
  };
  std::vector<std::vector<Way>> ways_of_;
  std::vector<std::vector<PortId>> ports_of_sheet_;
  std::vector<PortId> counted_;  ///< port of each slot of PassedPorts
};

}  // namespace palpate
