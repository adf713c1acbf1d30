#pragma once
/// The port machine: what a facet between two cells is for the proxy that stands in one of them, and
/// what passing it does to the state (DESIGN.md section 2, "Wall", "Port", "State").

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/interior/port.h"
#include "palpate/interior/punctures.h"

namespace palpate {

/// What stands between two regions, seen from the first.
struct Wall {
  bool absent = false;
  int material = -1;  ///< index into the scene's materials
};

/// An open surface: part of a leaf's zero set that is a wall though the same region lies on both sides.
struct Sheet {
  std::string name;
  std::vector<LeafId> leaves;  ///< of the field whose zero set it is part of
  int solid = -1;              ///< mask of that field: the sheet is where its sign changes
  int mask = -1;               ///< only within this mask of the partition; -1: everywhere
  int material = -1;           ///< index into the scene's materials
};

/// The ports passed on the way to where the proxy is. A value of fixed size: copy it to rewind.
class PassedPorts {
 public:
  static constexpr std::size_t kCapacity = 64;

  [[nodiscard]] bool contains(PortId port) const noexcept;
  [[nodiscard]] std::size_t size() const noexcept { return size_; }
  [[nodiscard]] PortId operator[](std::size_t i) const noexcept { return stack_[i].port; }

  /// Records the crossing of `port` from region `from` to `to`. Coming back to the region that the last
  /// passage left takes that passage off again; reaching outside clears all; with `keep`
  /// neither happens, and a port once passed stays passed. When full, the oldest is forgotten.
  void pass(PortId port, RegionId from, RegionId to, bool keep) noexcept;
  /// Records that `to` was reached without a port (an absent wall). Back in a region that a passage left, that
  /// passage and all after it are taken off; reaching outside clears all; with `keep` neither happens.
  void arrive(RegionId to, bool keep) noexcept;
  void clear() noexcept { size_ = 0; }

  friend bool operator==(const PassedPorts& a, const PassedPorts& b) noexcept;

 private:
  struct Entry {
    PortId port = 0;
    RegionId from = kOutside;
  };
  std::array<Entry, kCapacity> stack_{};
  std::size_t size_ = 0;
};

/// What a facet is for the proxy on its near side.
struct Facet {
  enum class Kind : std::uint8_t {
    kInternal,  ///< the same region on both sides: nothing is there
    kAbsent,    ///< another region, no wall: crossed freely
    kOpen,      ///< a port that lets the proxy through now
    kClosed,    ///< a wall
  };
  Kind kind = Kind::kInternal;
  RegionId beyond = kOutside;  ///< the region on the far side
  PortId port = 0;             ///< kOpen: the port; kClosed and opens: the port that would open
  int material = -1;           ///< kClosed: of the wall, as felt from the near side
  bool opens = false;          ///< kClosed: a port opens it when it is pressed with opens_at
  bool varies = false;         ///< elsewhere on the same facet opens_at and port may be others
  double opens_at = 0.0;       ///< [N] elastic normal force that opens it
  bool in_hole = false;        ///< the port's force is that of a hole made before

  [[nodiscard]] bool isClosed() const noexcept { return kind == Kind::kClosed; }
};

/// Walls and ports of a scene, laid out for the loop. Immutable; const members are real-time safe.
class Passages {
 public:
  Passages() = default;
  /// `walls[from * regions + to]`; `ports` in the author's order, which decides where several are open.
  Passages(std::size_t regions, std::vector<Wall> walls, std::vector<Port> ports,
           std::vector<Sheet> sheets = {});

  [[nodiscard]] std::span<const Port> ports() const noexcept { return ports_; }
  [[nodiscard]] std::span<const Sheet> sheets() const noexcept { return sheets_; }
  [[nodiscard]] const Wall& wall(RegionId from, RegionId to) const noexcept {
    return walls_[from * regions_ + to];
  }
  /// The ports that lead out of `region`: all that a tick tests.
  [[nodiscard]] std::span<const PortId> portsOf(RegionId region) const noexcept {
    return ports_of_[region];
  }

  /// The facet at `at` [m] that is crossed when the leaves `crossed` (one, or several that coincide there)
  /// change sign from `here`, a cell of region `from`, to `there`, a cell of region `beyond`. `holes` may make
  /// it easier to pass; null: there are none.
  [[nodiscard]] Facet facet(const Partition& partition, RegionId from, RegionId beyond,
                            const Signs& here, const Signs& there, std::span<const LeafId> crossed,
                            const PassedPorts& passed, const Vec3& at,
                            const Punctures* holes = nullptr) const noexcept;

  /// The same where only the far cell is known: the near one differs from it in the leaves `crossed`, and
  /// the region beyond is looked up. Copies signs: for set-up and pictures.
  [[nodiscard]] Facet facet(const Partition& partition, RegionId from, const Signs& there,
                            std::span<const LeafId> crossed, const PassedPorts& passed,
                            const Vec3& at) const;

 private:
  std::size_t regions_ = 0;
  std::vector<Wall> walls_;
  std::vector<Port> ports_;
  std::vector<Sheet> sheets_;
  std::vector<std::vector<PortId>> ports_of_;
  /// By region: what its ports lead to, in the order of regions, then in the author's.
  struct Way {
    RegionId to = kOutside;
    PortId port = 0;
  };
  std::vector<std::vector<Way>> ways_of_;
};

}  // namespace palpate
