// The meaning of a facet for the proxy: walls, ports, and the memory of ports passed.

#include <gtest/gtest.h>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

using Kind = Facet::Kind;

using Ids = std::vector<PortId>;

Port portOf(Ids from, Ids to) {
  Port out;
  out.name = "p";
  out.from = std::move(from);
  out.to = std::move(to);
  return out;
}

/// Chambers 1, 2, 3 form a ring behind a door from outside: port 0 is the door, ports 1, 2, 3 lead
/// on (1 to 2, 2 to 3, 3 to 1), port 4 leads back from 2 to 1. All are counted.
class Ring : public ::testing::Test {
 protected:
  Ring() {
    std::vector<Port> ports{portOf({0}, {1}), portOf({1}, {2}), portOf({2}, {3}), portOf({3}, {1}),
                            portOf({2}, {1})};
    ports[4].direction = PortDirection::kIn;
    Port last = portOf({3}, {0});
    for (PortId id = 0; id < 5; ++id) last.after.emplace_back(id);
    ports.push_back(last);
    passages_ = Passages(4, std::vector<Wall>(16), std::move(ports));
  }

  void pass(PortId port, RegionId from, RegionId to) {
    passages_.pass(passed_, port, from, to, keep_);
  }
  void arrive(RegionId from, RegionId to) { passages_.arrive(passed_, from, to, keep_); }
  [[nodiscard]] std::vector<std::int64_t> counts() const {
    std::vector<std::int64_t> out;
    for (PortId id = 0; id < 5; ++id) {
      out.push_back(passed_.times(static_cast<std::size_t>(passages_.ports()[id].slot)));
    }
    return out;
  }
  using Counts = std::vector<std::int64_t>;

  Passages passages_;
  PassedPorts passed_;
  bool keep_ = false;
};

TEST_F(Ring, CrossingBackTakesTheCrossingBackAndOutsideClearsAll) {
  pass(0, 0, 1);
  pass(1, 1, 2);
  EXPECT_EQ(counts(), (Counts{1, 1, 0, 0, 0}));
  pass(1, 2, 1);
  EXPECT_EQ(counts(), (Counts{1, 0, 0, 0, 0}));
  pass(1, 1, 2);
  pass(0, 1, 0);
  EXPECT_EQ(counts(), (Counts{0, 0, 0, 0, 0}));
  EXPECT_TRUE(passed_ == PassedPorts());
}

TEST_F(Ring, ManyLapsForgetNothing) {
  pass(0, 0, 1);
  for (int lap = 0; lap < 1000; ++lap) {
    pass(1, 1, 2);
    pass(2, 2, 3);
    pass(3, 3, 1);
  }
  EXPECT_EQ(counts(), (Counts{1, 1000, 1000, 1000, 0}));
  for (int lap = 0; lap < 1000; ++lap) {
    pass(3, 1, 3);
    pass(2, 3, 2);
    pass(1, 2, 1);
  }
  EXPECT_EQ(counts(), (Counts{1, 0, 0, 0, 0})) << "unwound";
}

TEST_F(Ring, APortThatLeadsBackIsPassedAsAnyOther) {
  pass(0, 0, 1);
  pass(1, 1, 2);
  pass(4, 2, 1);
  EXPECT_EQ(counts(), (Counts{1, 1, 0, 0, 1})) << "another port takes nothing back";
  pass(1, 1, 2);
  pass(4, 2, 1);
  EXPECT_EQ(counts(), (Counts{1, 2, 0, 0, 2}));
}

TEST_F(Ring, PassedTheOtherWayFirstCountsThatWay) {
  pass(3, 1, 3);
  pass(3, 1, 3);
  EXPECT_EQ(counts(), (Counts{0, 0, 0, 2, 0}));
  pass(3, 3, 1);
  EXPECT_EQ(counts(), (Counts{0, 0, 0, 1, 0}));
}

TEST_F(Ring, AnAbsentWallBackTakesThePassageOff) {
  // 1 and 2 are connected by port 1 in one half and by an absent wall in the other.
  pass(0, 0, 1);
  pass(1, 1, 2);
  pass(2, 2, 3);
  arrive(3, 1);
  EXPECT_EQ(counts(), (Counts{1, 1, 1, 0, 0})) << "round by where none was passed is not back";
  pass(2, 3, 2);
  arrive(2, 1);
  EXPECT_EQ(counts(), (Counts{1, 0, 0, 0, 0}));
  arrive(2, 1);
  EXPECT_EQ(counts(), (Counts{1, 0, 0, 0, 0})) << "none is left to take back";
  arrive(1, kOutside);
  EXPECT_EQ(counts(), (Counts{0, 0, 0, 0, 0})) << "outside clears all, by whatever way";
}

TEST_F(Ring, KeepCountsEveryPassingAndTakesNoneBack) {
  keep_ = true;
  for (int round = 0; round < 100; ++round) {
    pass(0, 0, 1);
    pass(1, 1, 2);
    pass(1, 2, 1);
    arrive(2, 1);
    pass(0, 1, 0);
    arrive(1, kOutside);
  }
  EXPECT_EQ(counts(), (Counts{200, 200, 0, 0, 0}));
}

TEST_F(Ring, AfterHoldsFromTheNumberAskedForOn) {
  Port often = portOf({1}, {2});
  often.after = {{1, 3}};
  for (int lap = 0; lap < 5; ++lap) {
    EXPECT_EQ(passages_.isDue(often, passed_), lap >= 3) << lap;
    pass(1, 1, 2);
    pass(2, 2, 3);
    pass(3, 3, 1);
  }
  EXPECT_TRUE(passages_.isDue(portOf({1}, {2}), passed_));
  EXPECT_FALSE(passages_.isDue(passages_.ports()[5], passed_)) << "4 was not passed";
}

TEST(PassedPorts, APortThatJoinsARegionToItselfByGlobsIsComeBackThrough) {
  // between: ["*", "*"]: both directions count as in, and still the second one takes the first
  // back.
  std::vector<Port> ports{portOf({0, 1, 2}, {0, 1, 2}), portOf({1}, {2})};
  ports[1].after = {0};
  const Passages passages(3, std::vector<Wall>(9), ports);
  PassedPorts passed;
  passages.pass(passed, 0, 1, 2, false);
  EXPECT_TRUE(passages.isDue(passages.ports()[1], passed));
  passages.pass(passed, 0, 2, 1, false);
  EXPECT_FALSE(passages.isDue(passages.ports()[1], passed));
}

TEST(PassedPorts, MoreThanThereIsRoomForAreRefused) {
  for (const std::size_t more : {std::size_t{0}, std::size_t{1}}) {
    std::vector<Port> ports;
    Port last = portOf({0}, {1});
    for (std::size_t i = 0; i < PassedPorts::kCapacity + more; ++i) {
      ports.push_back(portOf({0}, {1}));
      last.after.emplace_back(static_cast<PortId>(i));
    }
    ports.push_back(last);
    if (more == 0) {
      EXPECT_NO_THROW(Passages(2, std::vector<Wall>(4), ports));
    } else {
      EXPECT_THROW(Passages(2, std::vector<Wall>(4), ports), Error);
    }
  }
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

/// Two nested balls and a mask: leaf 0 belongs to region 1, leaf 1 to region 2, leaf 2 is the mask
/// (x < 0).
class Facets : public ::testing::Test {
 protected:
  Facets()
      : layers_{sphere(Vec3(0.0), 0.2), sphere(Vec3(0.0), 0.1)},
        masks_{halfSpace(Vec3(0.0), Vec3(1, 0, 0))},
        partition_(layers_, masks_) {}

  /// The facet seen from `here`, when the leaves `crossed` change sides.
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

  static Port port(Ids from, Ids to) { return portOf(std::move(from), std::move(to)); }

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
  const Port before = port({1}, {2});
  PassedPorts passed;
  EXPECT_EQ(look(outside_, {0}, {later, before, before}, passed).kind, Kind::kClosed);
  passages_.pass(passed, 2, 1, 2, true);
  EXPECT_EQ(look(outside_, {0}, {later, before, before}, passed).kind, Kind::kClosed)
      << "one of two";
  passages_.pass(passed, 1, 1, 2, true);
  EXPECT_EQ(look(outside_, {0}, {later, before, before}, passed).kind, Kind::kOpen);
}

TEST_F(Facets, OpeningForces) {
  Port skin = port({0}, {1});
  skin.opens_at = 3.0;
  skin.back = 1.0;
  Facet facet = look(outside_, {0}, {skin});
  EXPECT_EQ(facet.kind, Kind::kClosed);
  EXPECT_EQ(facet.opens_at, 3.0);
  EXPECT_FALSE(facet.varies) << "it is the same all over the facet";
  EXPECT_EQ(look(shell_, {0}, {skin}).opens_at, 1.0);
  skin.back = 0.0;
  EXPECT_EQ(look(shell_, {0}, {skin}).kind, Kind::kOpen);
  skin.direction = PortDirection::kIn;
  EXPECT_EQ(look(shell_, {0}, {skin}).opens_at, 0.0) << "and closed: no force opens it";
  EXPECT_EQ(look(shell_, {0}, {skin}).kind, Kind::kClosed);
}

TEST_F(Facets, AnOpeningForceThatVariesSaysSo) {
  Port skin = port({0}, {1});
  skin.opens_at = testing::linearMap(3.0, Vec3(0, 0, 10.0), {1.0, 5.0});
  EXPECT_TRUE(look(outside_, {0}, {skin}).varies);
  EXPECT_DOUBLE_EQ(look(outside_ + Vec3(0, 0, 0.1), {0}, {skin}).opens_at, 4.0);
  // The force varies whatever other ports lead through the facet.
  Port hard = port({0}, {1});
  hard.opens_at = 5.0;
  EXPECT_TRUE(look(outside_, {0}, {skin, hard}).varies);
  EXPECT_TRUE(look(outside_, {0}, {hard, skin}).varies);
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
