// CSG split into leaves and recombined as regions: the region that the loop computes for a point
// must agree with the fields' own values there.

#include "palpate/interior/partition.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

FieldPtr ball(double x, double radius = 0.03) { return sphere(Vec3(x, 0, 0), radius); }

RegionId regionAt(const Partition& partition, const Vec3& p) {
  Signs signs(partition.leaves().size());
  partition.signsAt(p, signs);
  return partition.regionOf(signs);
}

TEST(Signs, HoldOneBitEachBeyondAWord) {
  Signs signs(130);
  for (const LeafId leaf : std::vector<LeafId>{0, 63, 64, 127, 128, 129}) {
    signs.set(leaf, true);
    EXPECT_TRUE(signs.inside(leaf));
    EXPECT_FALSE(signs.inside(static_cast<LeafId>(leaf == 0 ? 1 : leaf - 2)));
    Signs other = signs;
    other.flip(leaf);
    EXPECT_FALSE(other.inside(leaf));
    EXPECT_NE(other, signs);
    other.flip(leaf);
    EXPECT_EQ(other, signs);
    signs.set(leaf, false);
  }
  EXPECT_EQ(signs, Signs(130));
}

TEST(Partition, NoLayersIsAllOutside) {
  const Partition partition{std::span<const FieldPtr>()};
  EXPECT_EQ(partition.regionCount(), 1U);
  EXPECT_TRUE(partition.leaves().empty());
  EXPECT_EQ(regionAt(partition, Vec3(1.0)), kOutside);
}

TEST(Partition, TakesCsgApartAndSharesLeaves) {
  const FieldPtr a = ball(0.0);
  const FieldPtr b = ball(0.02);
  const FieldPtr c = halfSpace(Vec3(0.0), Vec3(0, 0, 1));
  // a and b occur in both layers, once below a complement: each is one leaf.
  const FieldPtr lower = intersect({unite({a, b}), c});
  const std::vector<FieldPtr> layers{lower, subtract({a, b})};
  const Partition partition(layers);
  ASSERT_EQ(partition.leaves().size(), 3U);
  EXPECT_EQ(partition.regionCount(), 3U);
  const auto ids = [&](const FieldPtr& part) { return partition.leavesOf(part.get()); };
  EXPECT_EQ(ids(a), std::vector<LeafId>{0});
  EXPECT_EQ(ids(b), std::vector<LeafId>{1});
  EXPECT_EQ(ids(c), std::vector<LeafId>{2});
  EXPECT_EQ(ids(lower), (std::vector<LeafId>{0, 1, 2}));
  EXPECT_TRUE(ids(ball(0.0)).empty()) << "an equal field is not the same field";
  const auto second = partition.leavesOfRegion(2);
  EXPECT_EQ(std::vector<LeafId>(second.begin(), second.end()), (std::vector<LeafId>{0, 1}));
  EXPECT_TRUE(partition.leavesOfRegion(kOutside).empty());
}

TEST(Partition, GivesTransformsToTheLeaves) {
  const FieldPtr part = unite({ellipsoid(Vec3(0.0), Vec3(0.01, 0.02, 0.03)), ball(0.02)});
  const Pose turn{rotationAbout(Vec3(1, 2, 3), 0.7), Vec3(0.01, -0.02, 0.03)};
  const Pose shift{Mat3(1.0), Vec3(0.05, 0, 0)};
  const FieldPtr once = place(part, turn);
  const FieldPtr twice = place(complement(place(part, turn)), shift);
  const std::vector<FieldPtr> layers{once, twice};
  const Partition partition(layers);
  // The same two shapes at two places are four leaves; `part` stands for all of them.
  ASSERT_EQ(partition.leaves().size(), 4U);
  EXPECT_EQ(partition.leavesOf(part.get()).size(), 4U);
  EXPECT_EQ(partition.leavesOf(once.get()).size(), 2U);
  Random random(1);
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = random.in({Vec3(-0.1), Vec3(0.1)});
    const RegionId expected = twice->value(p) < 0.0 ? 2 : once->value(p) < 0.0 ? 1 : 0;
    // The same motion was rounded in two ways: points on the wall itself have no certain side.
    if (std::min(std::fabs(twice->value(p)), std::fabs(once->value(p))) < 1e-14) continue;
    ASSERT_EQ(regionAt(partition, p), expected);
  }
}

TEST(Partition, ATransformUndoneIsTheLeafItself) {
  const FieldPtr a = ball(0.0);
  const Pose there{Mat3(1.0), Vec3(0.25, 0, 0)};
  const Pose back{Mat3(1.0), Vec3(-0.25, 0, 0)};
  const std::vector<FieldPtr> layers{a, place(place(a, there), back)};
  const Partition partition(layers);
  ASSERT_EQ(partition.leaves().size(), 1U);
  EXPECT_EQ(partition.leaves()[0].field, a);
}

TEST(Partition, LaterLayersWinAndMasksHoldNoRegion) {
  const FieldPtr first = ball(0.0);
  const std::vector<FieldPtr> layers{first, ball(0.02)};
  const std::vector<FieldPtr> masks{halfSpace(Vec3(0.0), Vec3(0, 0, 1)), first};
  const Partition partition(layers, masks);
  EXPECT_EQ(partition.leaves().size(), 3U) << "a mask shares leaves with the layers";
  EXPECT_EQ(regionAt(partition, Vec3(0.0)), 2);
  EXPECT_EQ(regionAt(partition, Vec3(-0.02, 0, 0)), 1);
  EXPECT_EQ(regionAt(partition, Vec3(0.06, 0, -0.06)), kOutside);
  Signs signs(partition.leaves().size());
  partition.signsAt(Vec3(0.0, 0, -0.01), signs);
  EXPECT_TRUE(partition.maskHolds(0, signs));
  EXPECT_TRUE(partition.maskHolds(1, signs));
  EXPECT_TRUE(partition.layerHolds(1, signs)) << "layer 1 holds it, though layer 2 owns it";
  EXPECT_TRUE(partition.layerHolds(kOutside, signs));
  partition.signsAt(Vec3(0.04, 0, 0.01), signs);
  EXPECT_FALSE(partition.maskHolds(0, signs));
  EXPECT_FALSE(partition.maskHolds(1, signs));
  EXPECT_FALSE(partition.layerHolds(1, signs));
}

TEST(Partition, TheSurfaceItselfIsOutside) {
  const std::vector<FieldPtr> layers{halfSpace(Vec3(0.0), Vec3(0, 0, 1))};
  EXPECT_EQ(regionAt(Partition(layers), Vec3(0.3, 0.2, 0.0)), kOutside);
}

/// A random tree over a few shared shapes, whose own value is the oracle.
class Trees {
 public:
  explicit Trees(std::uint64_t seed) : random_(seed) {
    for (int i = 0; i < 6; ++i) {
      const Vec3 c = random_.in({Vec3(-0.03), Vec3(0.03)});
      if (i % 3 == 0) shapes_.push_back(sphere(c, random_.uniform(0.01, 0.04)));
      if (i % 3 == 1) shapes_.push_back(box(c, random_.in({Vec3(0.01), Vec3(0.06)})));
      if (i % 3 == 2) shapes_.push_back(halfSpace(c, random_.direction()));
    }
  }

  FieldPtr tree(int depth) {
    const int kind = pick(depth <= 0 ? 1 : 6);
    if (kind == 0) return shapes_[static_cast<std::size_t>(pick(6))];
    if (kind == 1) return complement(tree(depth - 1));
    if (kind == 2) {
      const Vec3 by = random_.in({Vec3(-0.02), Vec3(0.02)});
      return place(tree(depth - 1),
                   Pose{rotationAbout(random_.direction(), random_.uniform(-3, 3)), by});
    }
    std::vector<FieldPtr> parts;
    for (int i = 1 + pick(4); i > 0; --i) parts.push_back(tree(depth - 1));
    if (kind == 3) return unite(parts);
    return kind == 4 ? intersect(parts) : subtract(parts);
  }
  Vec3 point() { return random_.in({Vec3(-0.06), Vec3(0.06)}); }

 private:
  int pick(int n) { return std::min(n - 1, static_cast<int>(random_.uniform(0, n))); }

  Random random_;
  std::vector<FieldPtr> shapes_;
};

TEST(Partition, RandomTreesAgreeWithTheFieldsThemselves) {
  int points = 0;
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    Trees trees(seed);
    std::vector<FieldPtr> layers;
    for (int i = 0; i < 4; ++i) layers.push_back(trees.tree(4));
    const std::vector<FieldPtr> masks{trees.tree(3)};
    const Partition partition(layers, masks);
    Signs signs(partition.leaves().size());
    for (int i = 0; i < 200; ++i) {
      const Vec3 p = trees.point();
      RegionId expected = kOutside;
      bool sure = std::fabs(masks[0]->value(p)) > 1e-12;
      for (std::size_t k = 0; k < layers.size(); ++k) {
        const double value = layers[k]->value(p);
        sure = sure && std::fabs(value) > 1e-12;
        if (value < 0.0) expected = static_cast<RegionId>(k + 1);
      }
      if (!sure) continue;
      ++points;
      partition.signsAt(p, signs);
      ASSERT_EQ(partition.regionOf(signs), expected) << "seed " << seed;
      ASSERT_EQ(partition.maskHolds(0, signs), masks[0]->value(p) < 0.0) << "seed " << seed;
      for (std::size_t k = 0; k < layers.size(); ++k) {
        ASSERT_EQ(partition.layerHolds(static_cast<RegionId>(k + 1), signs),
                  layers[k]->value(p) < 0.0);
      }
    }
  }
  EXPECT_GT(points, 11000) << "most points must count";
}

TEST(Partition, WideTreesAreNoProblemAndDeepOnesAreRefusedOrRight) {
  std::vector<FieldPtr> many;
  for (int i = 0; i < 300; ++i) many.push_back(ball(0.001 * i, 0.01));
  const std::vector<FieldPtr> wide{unite(many)};
  EXPECT_EQ(regionAt(Partition(wide), Vec3(0.3, 0, 0)), 1);
  EXPECT_EQ(regionAt(Partition(wide), Vec3(0.32, 0, 0)), 0);

  // Nested in the last operand, the stack grows with every level; the point is only in the deepest
  // one.
  const auto nested = [](int levels) {
    FieldPtr field = ball(1.0, 0.01);
    for (int i = 0; i < levels; ++i) field = unite({ball(0.0, 0.01), field});
    return std::vector<FieldPtr>{field};
  };
  EXPECT_EQ(regionAt(Partition(nested(62)), Vec3(1.0, 0, 0)), 1);
  EXPECT_EQ(regionAt(Partition(nested(62)), Vec3(0.5, 0, 0)), 0);
  EXPECT_THROW(Partition{nested(63)}, Error);

  // Nested in the first operand, it does not grow, however deep.
  FieldPtr first = ball(1.0, 0.01);
  for (int i = 0; i < 200; ++i) first = unite({first, ball(0.0, 0.01)});
  const Partition left_deep{std::vector<FieldPtr>{first}};
  EXPECT_EQ(regionAt(left_deep, Vec3(1.0, 0, 0)), 1);
  EXPECT_EQ(regionAt(left_deep, Vec3(0.5, 0, 0)), 0);
}

}  // namespace
}  // namespace palpate::test
