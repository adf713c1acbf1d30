// Which regions can ever be entered: the search over states and transitions, against a long random
// walk and against cases whose answer is known.

#include "scene/reach.h"

#include <gtest/gtest.h>

#include <random>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

std::string answersOf(const std::vector<Reach>& all) {
  std::string text;
  for (const Reach one : all) text += one == Reach::kYes ? 'y' : one == Reach::kNo ? 'n' : '?';
  return text;
}

/// outside, a and b in a row, and c beside a. Ways: in (outside, a); ab, one way; ba, one way back;
/// ac.
ReachTable rooms() {
  ReachTable table;
  table.regions = 4;
  table.ways = {{0, 1, 0, true},  {1, 0, 0, false}, {1, 2, 1, true},
                {2, 1, 2, false}, {1, 3, 3, true},  {3, 1, 3, false}};
  table.after.resize(4);
  return table;
}

TEST(Reach, APortThatLeadsBackCanComeBeforeAnother) {
  ReachTable table = rooms();
  table.after[3] = {2};
  EXPECT_EQ(answersOf(reach(table).regions), "yyyy");
  table.after[3] = {{2, 3}};
  EXPECT_EQ(answersOf(reach(table).regions), "yyyy") << "three rounds of a and b";
  table.ways.erase(table.ways.begin() + 3);  // no way back from b
  EXPECT_EQ(answersOf(reach(table).regions), "yyyn");
  EXPECT_EQ(answersOf(reach(table).ports), "yynn");
}

TEST(Reach, WhatIsTakenBackOnTheWayDoesNotCount) {
  // The only way out of b leads back through the port that c requires.
  ReachTable table = rooms();
  table.ways = {
      {0, 1, 0, true}, {1, 0, 0, false}, {1, 2, 1, true}, {2, 1, 1, false}, {1, 3, 3, true}};
  table.after[3] = {1};
  EXPECT_EQ(answersOf(reach(table).regions), "yyyn") << "the fixpoint alone says yes";
  table.keeps_memory = true;
  EXPECT_EQ(answersOf(reach(table).regions), "yyyy");
}

TEST(Reach, TwoThatExcludeEachOtherAreNotBothPassed) {
  // Ways lead from a through x to b, or through y to c, both one-way; d opens from b and c, after x
  // and y.
  ReachTable table;
  table.regions = 5;
  table.ways = {
      {0, 1, 0, true}, {1, 2, 1, true}, {1, 3, 2, true}, {2, 4, 3, true}, {3, 4, 3, true}};
  table.after.resize(4);
  table.after[3] = {1, 2};
  for (const bool keep : {false, true}) {
    table.keeps_memory = keep;
    EXPECT_EQ(answersOf(reach(table).regions), "yyyyn") << keep;
  }
}

TEST(Reach, OutsideClearsWhatWasPassed) {
  // A room behind each of two doors from outside; the second door requires the first.
  ReachTable table;
  table.regions = 3;
  table.ways = {{0, 1, 0, true}, {1, 0, 0, false}, {0, 2, 1, true}, {2, 0, 1, false}};
  table.after.resize(2);
  table.after[1] = {0};
  EXPECT_EQ(answersOf(reach(table).regions), "yyn");
  table.keeps_memory = true;
  EXPECT_EQ(answersOf(reach(table).regions), "yyy");
}

TEST(Reach, AnAbsentWallBackTakesAPassingBack) {
  // A way leads from a to b by a port, and back where there is no wall: the room that requires the
  // port opens only from a.
  ReachTable table = rooms();
  table.ways = {{0, 1, 0, true}, {1, 2, 1, true}, {2, 1, -1, false}, {1, 3, 3, true}};
  table.after[3] = {1};
  EXPECT_EQ(answersOf(reach(table).regions), "yyyn");
  table.ways.push_back({2, 3, 3, true});
  EXPECT_EQ(answersOf(reach(table).regions), "yyyy");
}

TEST(Reach, ADoubtfulWayIsUndecidedAndSoIsWhatNeedsIt) {
  ReachTable table = rooms();
  table.ways[2].is_doubtful = true;  // ab
  table.after[3] = {2};
  EXPECT_EQ(answersOf(reach(table).regions), "yy??");
  EXPECT_EQ(answersOf(reach(table).ports), "y???");
}

TEST(Reach, ManyRoomsWithAMemoryThatKeepsAreNotManyStates) {
  // Sixty rooms around a hall, each door requiring the one before: 2^60 sets of doors passed.
  ReachTable table;
  table.keeps_memory = true;
  table.regions = 61;
  table.after.resize(60);
  for (int i = 0; i < 60; ++i) {
    const auto room = static_cast<RegionId>(i + 1);
    table.ways.push_back({0, room, i, true});
    table.ways.push_back({room, 0, i, false});
    if (i > 0) table.after[static_cast<std::size_t>(i)] = {{static_cast<PortId>(i - 1), 2}};
  }
  EXPECT_EQ(answersOf(reach(table).regions), std::string(61, 'y'));
}

/// The regions that a random walk by the rules enters.
std::vector<bool> walked(const ReachTable& table, int steps, std::uint64_t seed) {
  std::vector<bool> met(table.regions, false);
  std::mt19937_64 random(seed);
  std::vector<int> net(table.after.size(), 0);
  RegionId here = table.start;
  for (int i = 0; i < steps; ++i) {
    met[here] = true;
    std::vector<ReachWay> open;
    for (const ReachWay& way : table.ways) {
      if (way.from != here) continue;
      bool is_due = true;
      for (const PassedBefore& before : way.port < 0
                                            ? std::vector<PassedBefore>{}
                                            : table.after[static_cast<std::size_t>(way.port)]) {
        is_due &= std::abs(net[before.port]) >= before.times;
      }
      if (is_due) open.push_back(way);
    }
    // Now and then start again: the walk may be trapped.
    if (open.empty() || random() % 200 == 0) {
      here = table.start;
      std::fill(net.begin(), net.end(), 0);
      continue;
    }
    const ReachWay way = open[random() % open.size()];
    if (way.to == kOutside && way.from != kOutside && !table.keeps_memory) {
      std::fill(net.begin(), net.end(), 0);
    } else if (way.port >= 0) {
      net[static_cast<std::size_t>(way.port)] += way.inward || table.keeps_memory ? 1 : -1;
    }
    here = way.to;
  }
  return met;
}

TEST(Reach, NeverSaysNoOfWhatAWalkGetsIntoAndDecidesNearlyAlways) {
  std::mt19937_64 random(7);
  const auto pick = [&](int below) {
    return static_cast<int>(random() % static_cast<unsigned>(below));
  };
  int undecided = 0;
  int refuted = 0;
  int confirmed = 0;
  constexpr int kTables = 150;
  for (int trial = 0; trial < kTables; ++trial) {
    ReachTable table;
    table.regions = static_cast<std::size_t>(3 + pick(4));
    table.keeps_memory = pick(4) == 0;
    const int ports = 2 + pick(5);
    for (int port = 0; port < ports; ++port) {
      const int a = pick(static_cast<int>(table.regions));
      const int b = pick(static_cast<int>(table.regions));
      const int direction = pick(3);
      const auto lower = static_cast<RegionId>(std::min(a, b));
      const auto upper = static_cast<RegionId>(std::max(a, b));
      if (direction != 2) table.ways.push_back({lower, upper, port, true});
      if (direction != 1) table.ways.push_back({upper, lower, port, false});
      table.after.emplace_back();
      for (int before = 0; before < port; ++before) {
        if (pick(3) == 0) table.after.back().emplace_back(static_cast<PortId>(before), 1 + pick(2));
      }
    }
    const Reached said = reach(table);
    const std::vector<bool> met = walked(table, 40'000, static_cast<std::uint64_t>(trial));
    for (std::size_t i = 0; i < table.regions; ++i) {
      if (met[i]) {
        ASSERT_NE(said.regions[i], Reach::kNo) << "table " << trial << ", region " << i;
      }
      undecided += said.regions[i] == Reach::kUndecided ? 1 : 0;
      refuted += said.regions[i] == Reach::kNo ? 1 : 0;
      // In tables this small, a walk of this many steps enters every region reported as reachable.
      if (said.regions[i] == Reach::kYes) {
        ASSERT_TRUE(met[i]) << "table " << trial << ", region " << i;
        ++confirmed;
      }
    }
  }
  EXPECT_GT(confirmed, 100);
  EXPECT_GT(refuted, 100);
  EXPECT_LE(undecided, 5) << "of some 800";
}

std::string reachOf(const std::string& yaml) {
  std::vector<Reach> all;
  const auto scene = sceneOf(yaml);
  for (const Region& region : scene->regions()) all.push_back(region.reach);
  return answersOf(all);
}

constexpr const char* kShells = R"(
palpate: 1
length: mm
fields:
  gate: {sphere: {center: [0, 0, 40], radius: 5}}
  far: {sphere: {center: [0, 0, 90], radius: 5}}
layers:
  - {name: shell, inside: {sphere: {center: [0, 0, 0], radius: 40}}}
  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 20}}}
ports:
)";

TEST(ReachOfScenes, APortWhoseExtentIsNotAtItsWallIsNoCertainWay) {
  const std::string shells = kShells;
  EXPECT_EQ(reachOf(shells + "  - {name: a, between: [outside, shell], where: gate}\n"), "yyn");
  EXPECT_EQ(reachOf(shells + "  - {name: a, between: [outside, shell], where: far}\n"), "y?n")
      << "nothing of the wall was seen there, which proves nothing";
}

TEST(ReachOfScenes, AfterAPortBackAndAfterSeveralTimes) {
  const std::string ports = std::string(kShells) +
                            "  - {name: in, between: [outside, shell]}\n"
                            "  - {name: down, between: [shell, core], direction: in}\n"
                            "  - {name: up, between: [shell, core], direction: out}\n";
  const std::string vault = R"(
layers:
  - {name: shell, inside: {sphere: {center: [0, 0, 0], radius: 40}}}
  - {name: core, inside: {sphere: {center: [0, 0, 0], radius: 20}}}
  - {name: vault, inside: {sphere: {center: [30, 0, 0], radius: 5}}}
ports:
)";
  std::string text = ports;
  text.replace(text.find("layers:"), text.find("ports:\n") + 7 - text.find("layers:"),
               vault.substr(1));
  EXPECT_EQ(reachOf(text + "  - {name: v, between: [shell, vault], after: [up]}\n"), "yyyy");
  EXPECT_EQ(
      reachOf(text + "  - {name: v, between: [shell, vault], after: [{port: up, times: 3}]}\n"),
      "yyyy");
}

}  // namespace
}  // namespace palpate::test
