#pragma once
/// Finds the regions at many points of a straight line.

#include <cstdint>
#include <unordered_map>
#include <vector>

#include "palpate/interior/partition.h"

namespace palpate {

/// Gives the same region as regionOf() for the signs at a point, but evaluates few fields: a leaf
/// only within its bounds, and there only where its Lipschitz bound allows that its sign has
/// changed; a leaf between two others only where both of them are inside, because only there it has
/// a meaning.
class RegionLine {
 public:
  explicit RegionLine(const Partition& partition)
      : partition_(partition), signs_(partition.leaves().size()) {}

  /// Starts a new line.
  void begin(const Vec3& from, const Vec3& to);

  /// The region at `p`, a point of the line. The points may come in any order.
  [[nodiscard]] RegionId at(const Vec3& p);

 private:
  /// A leaf whose bounds the line crosses. Lengths [m] count from where the line begins.
  struct Candidate {
    LeafId leaf = 0;
    const Field* field = nullptr;
    Box3 bounds;
    double enters = 0.0, leaves = 0.0;  ///< [m] where the line enters and leaves its bounds
    double per_slope = 0.0;             ///< 1 / Lipschitz bound; 0 if that does not hold here
    double fixed_from = kInfinity, fixed_to = -kInfinity;  ///< [m] no change of sign in between
    bool inside = false;                                   ///< whether the leaf is inside there
  };

  struct Hash {
    std::size_t operator()(const std::vector<LeafId>& leaves) const noexcept {
      std::uint64_t hash = 0xCBF29CE484222325U;
      for (const LeafId leaf : leaves) hash = (hash ^ leaf) * 0x100000001B3U;
      return hash;
    }
  };

  /// Finds the leaves that lie between others, or those that do not.
  void find(bool between, std::vector<Candidate>& found) const;
  /// Sets the sign of a candidate, and limits the part of the line on which no sign changes.
  void look(Candidate& candidate, const Vec3& p, double place);
  void ask(Candidate& candidate, const Vec3& p, double place) const;
  void set(LeafId leaf, bool inside);
  [[nodiscard]] RegionId regionHere();

  const Partition& partition_;
  Vec3 from_{0.0};
  Vec3 to_{0.0};
  Vec3 along_{0.0};
  double length_ = 0.0;
  std::vector<Candidate> candidates_;
  std::vector<Candidate> walls_;  ///< leaves that lie between two others
  bool walls_are_found_ = false;  ///< on most lines they are never needed
  bool walls_are_set_ = false;    ///< some of them may be inside
  Signs signs_;
  double fixed_from_ = kInfinity, fixed_to_ = -kInfinity;  ///< no sign changes in between
  bool is_changed_ = true;                                 ///< signs_, since `region_` was found
  RegionId region_ = kOutside;
  /// Regions by the leaves that are inside: there are few such cells, and each is met often.
  std::unordered_map<std::vector<LeafId>, RegionId, Hash> cells_;
  std::vector<LeafId> inside_;
};

}  // namespace palpate
