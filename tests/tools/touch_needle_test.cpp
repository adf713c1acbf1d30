// palpate touch with needles: the summary names every layer that the tip entered, however many in
// one tick.

#include <cmath>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

class TouchNeedle : public ::testing::Test {
 protected:
  Json touch(std::vector<std::string> arguments, const char* scene = "slab.yaml") {
    arguments.insert(arguments.begin(), {"touch", scenePath(scene), "--json"});
    const CommandResult result = runPalpate(arguments, folder_.path());
    EXPECT_EQ(result.exit_code, 0) << result.err;
    return parseOnly(result);
  }

  TempFolder folder_;
};

struct Layer {
  const char* region;
  double entry, deepest;  // [m]
  double rupture;         // [N] 0: its wall was open
  double peak;            // [N] negative: not checked
};

void expectLayers(Json& json, const std::vector<Layer>& layers) {
  ASSERT_EQ(json["regions"].size(), layers.size()) << json["regions"];
  for (std::size_t i = 0; i < layers.size(); ++i) {
    SCOPED_TRACE(i);
    Json& visit = json["regions"][i];
    EXPECT_EQ(visit["region"], layers[i].region);
    EXPECT_NEAR(visit["entry_depth_m"], layers[i].entry, 1e-7);
    EXPECT_NEAR(visit["depth_m"], layers[i].deepest, 1e-7);
    if (layers[i].rupture > 0.0) {
      EXPECT_NEAR(visit["rupture_N"], layers[i].rupture, 1e-5);
    } else {
      EXPECT_TRUE(visit["rupture_N"].is_null());
    }
    if (layers[i].peak >= 0.0) {
      EXPECT_NEAR(visit["peak_force_N"], layers[i].peak, 1e-5);
    }
  }
}

// The hand goes 50 mm in a single tick through skin, fat and muscle, each of which gets its own
// rupture, depth and force in that tick.
TEST_F(TouchNeedle, AHandFarAheadLeavesNoLayerOut) {
  (void)folder_.file("p.csv", "t,x,y,z\n0,0,0,0.005\n0.001,0,0,-0.045\n0.002,0,0,-0.045\n");
  Json json = touch({"--path", "p.csv"});
  // Each wall is pressed by the distance of the hand beyond it: 45, 31 and 13 mm.
  const double skin = 250.0 * 0.045 + 4e4 * 0.045 * 0.045;
  expectLayers(json, {{"outside", 0.0, 0.0, 0.0, 0.0},
                      {"skin", 0.0, 0.002, skin, 0.5},
                      {"fat", 0.002, 0.014, 0.0, 150.0 * 0.031 + 0.15},
                      {"muscle", 0.014, 0.032, 150.0 * 0.031, 150.0 * 0.013 + 0.6},
                      {"outside", 0.032, 0.045, 150.0 * 0.013, -1.0}});
  EXPECT_EQ(json["regions"][1]["port"], "skin_puncture");
  EXPECT_EQ(json["regions"][3]["port"], "fascia_puncture");
  EXPECT_TRUE(json["regions"][0]["port"].is_null());
  EXPECT_EQ(json["events"].size(), 4U);
}

// At 50 mm/s the skin opens when the hand is 5.8 mm deep, already in the fat. Depths are those of
// the walls, not of the hand.
TEST_F(TouchNeedle, DepthsAreOfTheWallsAndTheTip) {
  Json json = touch({"--insert", "0,0,5", "0,0,-25", "--speed", "50"});
  ASSERT_EQ(json["regions"].size(), 4U) << json["regions"];
  const double entries[] = {0.0, 0.0, 0.002, 0.014};
  const double ends[] = {0.0, 0.002, 0.014, 0.025};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_NEAR(json["regions"][i]["entry_depth_m"], entries[i], 1e-7) << i;
    EXPECT_NEAR(json["regions"][i]["depth_m"], ends[i], 1e-7) << i;
  }
  // A tick is 50 um: the force exceeds the limit by what that length presses.
  EXPECT_GE(json["regions"][1]["rupture_N"], 2.8);
  EXPECT_LE(json["regions"][1]["rupture_N"], 2.8 + 50e-6 * (250.0 + 2 * 4e4 * 0.006));
  EXPECT_NEAR(json["regions"][1]["peak_force_N"], 0.5, 1e-9);
}

TEST_F(TouchNeedle, TheTableHasTheLayersAndTheirRuptures) {
  const CommandResult result = runPalpate(
      {"touch", scenePath("slab.yaml"), "--insert", "0,0,5", "0,0,-25", "--plot", "p.svg"},
      folder_.path());
  ASSERT_EQ(result.exit_code, 0) << result.err;
  for (const char* part : {"wall gave way at", "skin ", "2.8", "depth at entry"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

// 25 mm deep and 3 mm sideways, compared with the closed form for skin, fat and muscle plus the
// cutting force of the tip.
TEST_F(TouchNeedle, TheFlankHoldsTheShaftSideways) {
  (void)touch({"--insert", "0,0,5", "0,0,-25", "3,0,-25", "--trace", "t.csv"}, "flank.yaml");
  const auto cells = cellsOf(linesOf(textOf(folder_.path("t.csv"))).back());
  const auto cubes = [](double a, double b) { return (b * b * b - a * a * a) / 3.0; };
  const double turning =
      6.2e4 * cubes(0.0, 0.003) + 1.5e4 * cubes(0.003, 0.015) + 3.6e4 * cubes(0.015, 0.025);
  const double reach = std::hypot(0.025, 0.003);
  const double shaft = turning / reach * (0.003 / reach) * (0.025 / reach);
  // 2 % for the part of the shaft that enters during the sideways motion, and at most 0.6 N for the
  // cutting by the tip.
  EXPECT_GT(-std::stod(cells[7]), 0.98 * shaft);
  EXPECT_LT(-std::stod(cells[7]), 1.02 * shaft + 0.6 + 0.1);
}

TEST_F(TouchNeedle, APressBesideTheSlabSaysThatItMissed) {
  const CommandResult result =
      runPalpate({"touch", scenePath("slab.yaml"), "--press", "200,0,0", "--normal", "0,0,1"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.out.find("met nothing"), std::string::npos) << result.out;
}

}  // namespace
}  // namespace palpate::testing
