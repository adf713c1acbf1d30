// The cells of a region near a point, against the region itself: for any combination of sides of
// the near leaves, a point with these sides is in a cell if and only if it is in the region and no
// sheet is in between.

#include "palpate/interior/near_cells.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <optional>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

class World {
 public:
  World(std::uint64_t seed, bool has_sheets) : random_(seed) {
    for (int i = 0; i < 5; ++i) {
      shapes_.push_back(sphere(random_.in({Vec3(-0.03), Vec3(0.03)}), random_.uniform(0.01, 0.04)));
    }
    for (int i = 0; i < 3; ++i) layers_.push_back(tree(2));
    std::vector<Sheet> sheets;
    if (has_sheets) {
      // A sheet without an edge, and one with an edge.
      masks_ = {tree(1), tree(1), tree(1)};
      for (const int mask : {-1, 2}) {
        Sheet sheet;
        sheet.solid = mask < 0 ? 0 : 1;
        sheet.mask = mask;
        sheets.push_back(sheet);
      }
    }
    partition_.emplace(layers_, masks_);
    for (Sheet& sheet : sheets) {
      const auto solid = static_cast<std::size_t>(sheet.solid);
      sheet.leaves = partition_->leavesOf(masks_[solid].get());
    }
    const std::size_t regions = layers_.size() + 1;
    passages_ = Passages(regions, std::vector<Wall>(regions * regions), {}, sheets);
  }

  /// Whether a point with the sides `there` is permitted to one that now has the sides `from`.
  [[nodiscard]] bool mayBe(const Signs& there, const Signs& from) const {
    if (partition_->regionOf(there) != partition_->regionOf(from)) return false;
    const auto& sheets = passages_.sheets();
    return std::all_of(sheets.begin(), sheets.end(), [&](const Sheet& sheet) {
      const auto solid = static_cast<std::size_t>(sheet.solid);
      return partition_->maskHolds(solid, there) == partition_->maskHolds(solid, from) ||
             (sheet.mask >= 0 &&
              !partition_->maskHolds(static_cast<std::size_t>(sheet.mask), there));
    });
  }

  int pick(int n) { return std::min(n - 1, static_cast<int>(random_.uniform(0, n))); }
  Vec3 point() { return random_.in({Vec3(-0.05), Vec3(0.05)}); }
  [[nodiscard]] const Partition& partition() const { return *partition_; }
  [[nodiscard]] const Passages& passages() const { return passages_; }

 private:
  FieldPtr tree(int depth) {
    const int kind = depth == 0 ? 0 : pick(4);
    if (kind == 0) return shapes_[static_cast<std::size_t>(pick(5))];
    std::vector<FieldPtr> parts;
    for (int i = 2 + pick(2); i > 0; --i) parts.push_back(tree(depth - 1));
    if (kind == 1) return unite(parts);
    return kind == 2 ? intersect(parts) : subtract(parts);
  }

  Random random_;
  std::vector<FieldPtr> shapes_;
  std::vector<FieldPtr> layers_;
  std::vector<FieldPtr> masks_;
  std::optional<Partition> partition_;
  Passages passages_;
};

bool isIn(std::span<const NearCell> cells, std::uint32_t inside) {
  return std::any_of(cells.begin(), cells.end(), [&](const NearCell& cell) {
    return (cell.inside & ~inside) == 0 && (cell.outside & inside) == 0;
  });
}

/// Examines many points of a world with one finder, as a solver does; returns the number of
/// comparisons.
int compare(World& world, bool may_be_anywhere) {
  const std::size_t leaves = world.partition().leaves().size();
  NearCells finder(world.partition(), world.passages());
  Signs here(leaves);
  int compared = 0;
  for (int i = 0; i < 100; ++i) {
    world.partition().signsAt(world.point(), here);
    std::vector<NearSide> near;
    std::uint32_t own = 0;
    for (std::size_t k = 0; k < leaves; ++k) {
      if (world.pick(3) == 0) continue;
      const auto leaf = static_cast<LeafId>(k);
      const bool other = may_be_anywhere || world.pick(2) == 0;
      if (here.inside(leaf)) own |= std::uint32_t{1} << near.size();
      near.push_back({leaf, here.inside(leaf) || other, !here.inside(leaf) || other});
    }
    const auto cells = finder.find(world.partition().regionOf(here), here, near);
    if (cells.size() == NearCells::kMaxCells) continue;  // some were left out
    EXPECT_TRUE(isIn(cells, own)) << "where the point is, is a cell";
    for (const NearCell& cell : cells) {
      for (std::size_t k = 0; k < near.size(); ++k) {
        EXPECT_TRUE(near[k].may_be_inside || ((cell.inside >> k) & 1U) == 0);
        EXPECT_TRUE(near[k].may_be_outside || ((cell.outside >> k) & 1U) == 0);
      }
      const auto contains = [&](const NearCell& each) { return each.contains(cell); };
      EXPECT_EQ(std::count_if(cells.begin(), cells.end(), contains), 1) << "none within another";
    }
    for (std::uint32_t inside = 0; inside < (std::uint32_t{1} << near.size()); ++inside) {
      Signs there = here;
      for (std::size_t k = 0; k < near.size(); ++k) {
        there.set(near[k].leaf, ((inside >> k) & 1U) != 0);
      }
      const bool expected = world.mayBe(there, here);
      if (may_be_anywhere) {
        EXPECT_EQ(isIn(cells, inside), expected);
      } else {
        EXPECT_TRUE(!isIn(cells, inside) || expected);
      }
      ++compared;
    }
  }
  return compared;
}

TEST(NearCells, AreTheRegionWhateverSidesThePointIsOn) {
  int compared = 0;
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    for (const bool has_sheets : {false, true}) {
      World world(seed, has_sheets);
      compared += compare(world, true);
      if (HasFailure()) FAIL() << "seed " << seed << (has_sheets ? ", with sheets" : "");
    }
  }
  EXPECT_GT(compared, 20000);
}

TEST(NearCells, HaveNoSideThatThePointCannotBeOn) {
  for (std::uint64_t seed = 100; seed < 120; ++seed) {
    World world(seed, true);
    EXPECT_GT(compare(world, false), 0);
    if (HasFailure()) FAIL() << "seed " << seed;
  }
}

}  // namespace
}  // namespace palpate::test
