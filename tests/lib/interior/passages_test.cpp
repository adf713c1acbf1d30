// What a facet is for the proxy: walls, ports, and the memory of ports passed.

#include <gtest/gtest.h>

#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"

namespace palpate::test {
namespace {

using Kind = Facet::Kind;

std::vector<PortId> idsOf(const PassedPorts& passed) {
  std::vector<PortId> ids;
  for (std::size_t i = 0; i < passed.size(); ++i) ids.push_back(passed[i]);
  return ids;
}
using Ids = std::vector<PortId>;

TEST(PassedPorts, PushOnTheWayInPopOnTheWayBackClearOutside) {
  PassedPorts passed;
  passed.pass(7, 0, 1, false);
  passed.pass(8, 1, 2, false);
  passed.pass(9, 2, 3, false);
  EXPECT_EQ(idsOf(passed), (Ids{7, 8, 9}));
  EXPECT_TRUE(passed.contains(8));
  EXPECT_FALSE(passed.contains(6));
  passed.pass(9, 3, 2, false);
  EXPECT_EQ(idsOf(passed), (Ids{7, 8})) << "back where the last passage came from";
  passed.pass(5, 2, 1, false);
  EXPECT_EQ(idsOf(passed), (Ids{7})) << "by another port too";
  passed.pass(8, 1, 2, false);
  passed.pass(6, 2, 0, false);
  EXPECT_EQ(passed.size(), 0U) << "outside clears all";
}

TEST(PassedPorts, AWayRoundIsNoWayBack) {
  PassedPorts passed;
  passed.pass(1, 0, 1, false);
  passed.pass(2, 1, 2, false);
  passed.pass(3, 2, 3, false);
  passed.pass(4, 3, 1, false);  // 1 was left by passage 2, which is not the last
  EXPECT_EQ(idsOf(passed), (Ids{1, 2, 3, 4}));
}

TEST(PassedPorts, AbsentWallsClearOnlyOutside) {
  PassedPorts passed;
  passed.pass(1, 0, 1, false);
  passed.arrive(2, false);
  EXPECT_EQ(passed.size(), 1U);
  passed.arrive(kOutside, true);
  EXPECT_EQ(passed.size(), 1U);
  passed.arrive(kOutside, false);
  EXPECT_EQ(passed.size(), 0U);
}

TEST(PassedPorts, KeepNeverForgetsNorRepeats) {
  PassedPorts passed;
  for (int round = 0; round < 100; ++round) {
    passed.pass(1, 0, 1, true);
    passed.pass(1, 1, 0, true);
    passed.arrive(kOutside, true);
  }
  EXPECT_EQ(idsOf(passed), (Ids{1}));
}

TEST(PassedPorts, ForgetsTheOldestWhenFull) {
  PassedPorts passed;
  const std::size_t more = PassedPorts::kCapacity + 3;
  for (std::size_t i = 0; i < more; ++i) {
    passed.pass(static_cast<PortId>(i), static_cast<RegionId>(i), static_cast<RegionId>(i + 1),
                false);
  }
  EXPECT_EQ(passed.size(), PassedPorts::kCapacity);
  EXPECT_EQ(passed[0], 3);
  EXPECT_EQ(passed[passed.size() - 1], more - 1);
}

TEST(PassedPorts, EqualByWhatIsOnTheStackOnly) {
  PassedPorts a;
  PassedPorts b;
  a.pass(4, 0, 1, false);
  a.pass(4, 1, 0, false);
  EXPECT_TRUE(a == b) << "what was popped does not count";
  a.pass(4, 0, 1, false);
  b.pass(4, 2, 1, false);
  EXPECT_FALSE(a == b);
}

TEST(Port, LeadsByItsDirection) {
  Port port;
  port.from = {0, 1};
  port.to = {2, 3};
  struct Row {
    PortDirection direction;
    bool in, out;
  };
  for (const Row& row :
       {Row{PortDirection::kBoth, true, true}, Row{PortDirection::kIn, true, false},
        Row{PortDirection::kOut, false, true}}) {
    port.direction = row.direction;
    EXPECT_EQ(port.leads(1, 2), row.in);
    EXPECT_EQ(port.leads(3, 0), row.out);
    EXPECT_FALSE(port.leads(0, 1));
    EXPECT_FALSE(port.leads(2, 3));
  }
}

/// Two nested balls and a mask: leaf 0 is region 1's, leaf 1 region 2's, leaf 2 the mask (x < 0).
class Facets : public testing::Test {
 protected:
  Facets()
      : layers_{sphere(Vec3(0.0), 0.2), sphere(Vec3(0.0), 0.1)},
        masks_{halfSpace(Vec3(0.0), Vec3(1, 0, 0))},
        partition_(layers_, masks_) {}

  /// The facet seen from `here`, when `crossed` change sides.
  Facet look(const Vec3& here, Ids crossed, std::vector<Port> ports,
             const PassedPorts& passed = {}) {
    std::vector<Wall> walls(9, Wall{false, 5});
    walls[0 * 3 + 1].material = 3;
    walls[1 * 3 + 0].material = 4;
    walls[0 * 3 + 2] = walls[2 * 3 + 0] = Wall{true, -1};
    passages_ = Passages(3, walls, std::move(ports));
    Signs signs(3);
    partition_.signsAt(here, signs);
    const RegionId region = partition_.regionOf(signs);
    for (const LeafId leaf : crossed) signs.flip(leaf);
    return passages_.facet(partition_, region, signs, crossed, passed, here);
  }

  static Port port(Ids from, Ids to) {
    Port out;
    out.name = "p";
    out.from = std::move(from);
    out.to = std::move(to);
    return out;
  }

  const Vec3 outside_{0.3, 0, 0};
  const Vec3 shell_{0.15, 0, 0};
  const Vec3 core_{0.05, 0, 0};
  std::vector<FieldPtr> layers_;
  std::vector<FieldPtr> masks_;
  Partition partition_;
  Passages passages_;
};

TEST_F(Facets, WallsAreTwoSidedAbsentOnesFreeAndMasksNothing) {
  Facet facet = look(outside_, {0}, {});
  EXPECT_EQ(facet.kind, Kind::kClosed);
  EXPECT_EQ(facet.beyond, 1);
  EXPECT_EQ(facet.material, 3);
  EXPECT_EQ(facet.opens_at, 0.0);
  facet = look(shell_, {0}, {});
  EXPECT_EQ(facet.kind, Kind::kClosed);
  EXPECT_EQ(facet.beyond, kOutside);
  EXPECT_EQ(facet.material, 4) << "the other side's material";
  facet = look(outside_, {0, 1}, {});
  EXPECT_EQ(facet.kind, Kind::kAbsent) << "both faces at once lead to region 2";
  EXPECT_EQ(facet.beyond, 2);
  EXPECT_EQ(look(outside_, {2}, {}).kind, Kind::kInternal);
  EXPECT_EQ(look(core_, {0}, {}).kind, Kind::kInternal) << "layer 1's face deep in layer 2";
}

TEST_F(Facets, PortsByDirectionFaceMaskAndOrder) {
  const Port both = port({0}, {1});
  EXPECT_EQ(look(outside_, {0}, {both}).kind, Kind::kOpen);
  EXPECT_EQ(look(shell_, {0}, {both}).kind, Kind::kOpen);
  EXPECT_EQ(look(shell_, {1}, {both}).kind, Kind::kClosed) << "leads to region 2, not asked";

  Port valve = both;
  valve.direction = PortDirection::kIn;
  EXPECT_EQ(look(outside_, {0}, {valve}).kind, Kind::kOpen);
  EXPECT_EQ(look(shell_, {0}, {valve}).kind, Kind::kClosed);
  valve.direction = PortDirection::kOut;
  EXPECT_EQ(look(outside_, {0}, {valve}).kind, Kind::kClosed);
  EXPECT_EQ(look(shell_, {0}, {valve}).kind, Kind::kOpen);

  Port faced = both;
  faced.on = {1};
  EXPECT_EQ(look(outside_, {0}, {faced}).kind, Kind::kClosed);
  faced.on = {1, 0};
  EXPECT_EQ(look(outside_, {0}, {faced}).kind, Kind::kOpen) << "any of its leaves";
  Port joint = port({0}, {2});
  joint.on = {1};
  EXPECT_EQ(look(outside_, {0, 1}, {joint}).kind, Kind::kAbsent) << "no port needed";

  Port masked = both;
  masked.mask = 0;
  EXPECT_EQ(look(outside_, {0}, {masked}).kind, Kind::kClosed) << "x > 0 is out of the mask";
  EXPECT_EQ(look(-outside_, {0}, {masked}).kind, Kind::kOpen);

  Port later = both;
  later.after = {1, 2};
  PassedPorts passed;
  EXPECT_EQ(look(outside_, {0}, {later}, passed).kind, Kind::kClosed);
  passed.pass(2, 0, 1, true);
  EXPECT_EQ(look(outside_, {0}, {later}, passed).kind, Kind::kClosed) << "one of two";
  passed.pass(1, 0, 1, true);
  EXPECT_EQ(look(outside_, {0}, {later}, passed).kind, Kind::kOpen);
}

TEST_F(Facets, OpeningForces) {
  Port skin = port({0}, {1});
  skin.opens_at = 3.0;
  skin.back = 1.0;
  Facet facet = look(outside_, {0}, {skin});
  EXPECT_EQ(facet.kind, Kind::kClosed);
  EXPECT_EQ(facet.opens_at, 3.0);
  EXPECT_EQ(look(shell_, {0}, {skin}).opens_at, 1.0);
  skin.back = 0.0;
  EXPECT_EQ(look(shell_, {0}, {skin}).kind, Kind::kOpen);
  skin.direction = PortDirection::kIn;
  EXPECT_EQ(look(shell_, {0}, {skin}).opens_at, 0.0) << "and closed: no force opens it";
  EXPECT_EQ(look(shell_, {0}, {skin}).kind, Kind::kClosed);
}

TEST_F(Facets, SeveralPortsOnOneFacet) {
  Port hard = port({0}, {1});
  hard.opens_at = 5.0;
  Port soft = hard;
  soft.opens_at = 2.0;
  Port shut = port({0}, {1});
  shut.after = {9};
  const Port open = port({0}, {1});
  Facet facet = look(outside_, {0}, {hard, shut, soft});
  EXPECT_EQ(facet.kind, Kind::kClosed);
  EXPECT_EQ(facet.port, 2) << "the one that opens first";
  EXPECT_EQ(facet.opens_at, 2.0);
  facet = look(outside_, {0}, {soft, open, hard, open});
  EXPECT_EQ(facet.kind, Kind::kOpen);
  EXPECT_EQ(facet.port, 1) << "the author's order decides among open ones";
  EXPECT_EQ(facet.opens_at, 0.0);
}

TEST_F(Facets, AGlobThatNamesBothSidesStillKnowsWhichWayIsBack) {
  Port door = port({0, 1, 2}, {1});  // between: ["*", shell]
  door.opens_at = 3.0;
  door.back = 1.0;
  EXPECT_EQ(look(outside_, {0}, {door}).opens_at, 3.0);
  EXPECT_EQ(look(shell_, {0}, {door}).opens_at, 1.0) << "out of the region it leads into";
  EXPECT_EQ(look(core_, {1}, {door}).opens_at, 3.0);
}

TEST_F(Facets, OnlyThePortsOfTheRegionAreListed) {
  Port in = port({0}, {1});
  in.direction = PortDirection::kIn;
  Port deep = port({1}, {2});
  (void)look(outside_, {0}, {in, deep});
  const auto ids = [&](RegionId region) {
    const auto span = passages_.portsOf(region);
    return Ids(span.begin(), span.end());
  };
  EXPECT_EQ(ids(0), (Ids{0}));
  EXPECT_EQ(ids(1), (Ids{1})) << "a valve does not lead back";
  EXPECT_EQ(ids(2), (Ids{1}));
}

}  // namespace
}  // namespace palpate::test
