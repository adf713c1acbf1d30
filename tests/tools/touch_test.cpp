// palpate touch: the forces, the report and the written files.

#include <algorithm>
#include <cmath>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

constexpr const char* kHeader =
    "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_"
    "ns";

/// The trace without its last column.
std::string withoutTimes(const std::string& trace) {
  std::string text;
  for (const std::string& line : linesOf(trace)) text += line.substr(0, line.rfind(',')) + "\n";
  return text;
}

class Touch : public ::testing::Test {
 protected:
  Touch() { (void)folder_.file("c.yaml", kContainer); }

  CommandResult touch(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"touch", "c.yaml"});
    return runPalpate(arguments, folder_.path());
  }

  TempFolder folder_;
};

TEST_F(Touch, PressingAWallGivesStiffnessTimesDepth) {
  // 2 mm into the bottom of the bowl, whose wall has 1500 N/m: 3 N at rest.
  const CommandResult result = touch(
      {"--press", "0,0,-40", "--normal", "0,0,-1", "--depth", "2", "--hold", "0.1", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json json = parseOnly(result);
  EXPECT_EQ(json["schema"], "palpate.touch/1");
  EXPECT_NEAR(json["peak_force_N"], 3.0, 1e-6);
  ASSERT_EQ(json["regions"].size(), 1U);
  EXPECT_EQ(json["regions"][0]["region"], "outside");
  EXPECT_GT(json["contact_ticks"], 100);  // the hold alone is 100 ticks
  EXPECT_EQ(json["events"].size(), 0U);
  EXPECT_TRUE(json["trace"].is_null());
}

TEST_F(Touch, RegionsComeInOrderWithDepthAndPeakForce) {
  const CommandResult result =
      touch({"--insert", "0,0,35", "0,0,-10", "--back", "--speed", "50", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json json = parseOnly(result);
  ASSERT_EQ(json["regions"].size(), 3U) << json;
  EXPECT_EQ(json["regions"][0]["region"], "outside");
  EXPECT_EQ(json["regions"][1]["region"], "liquid");
  EXPECT_EQ(json["regions"][2]["region"], "outside");
  // From the mouth at z = 15 mm to -10 mm; a tick is 0.05 mm, and the first one inside may already
  // be that deep.
  EXPECT_NEAR(json["regions"][1]["depth_m"], 0.025, 6e-5);
  EXPECT_NEAR(json["regions"][1]["entry_depth_m"], 0.0, 6e-5);
  EXPECT_NEAR(json["regions"][1]["peak_force_N"], 4.0 * 0.05, 1e-9);  // drag 4 N.s/m at 50 mm/s
  ASSERT_EQ(json["events"].size(), 2U);
  EXPECT_EQ(json["events"][0]["port"], "mouth");
  EXPECT_EQ(json["events"][1]["port"], "mouth");
}

TEST_F(Touch, TheTextSaysWhatTheJsonSays) {
  const CommandResult result = touch({"--insert", "0,0,35", "0,0,-10"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err, "");
  for (const char* part : {"liquid", "mouth", "25 mm", "0.2 N", "median"}) {
    EXPECT_NE(result.out.find(part), std::string::npos) << part << " in\n" << result.out;
  }
}

TEST_F(Touch, TicksThatDoNotComeToRestAreCountedUnlessTheRendererDoesNotSay) {
  const std::vector<std::string> motion = {"--press", "0,0,-40", "--normal",
                                           "0,0,-1",  "--depth", "2"};
  std::vector<std::string> arguments = motion;
  arguments.emplace_back("--json");
  const Json json = parseOnly(touch(arguments));
  // A single wall that bends by 2 mm in 40 is settled in every tick.
  EXPECT_EQ(json["unsettled_ticks"], 0);
  EXPECT_EQ(json["unsettled_share"], 0.0);
  EXPECT_EQ(json["longest_unsettled_ticks"], 0);
  EXPECT_NE(touch(motion).out.find("Unsettled   0 ticks (0 %), at most 0 in a row"),
            std::string::npos);

  arguments.insert(arguments.end(), {"--renderer", "paper"});
  const Json paper = parseOnly(touch(arguments));
  for (const char* key : {"unsettled_ticks", "unsettled_share", "longest_unsettled_ticks"}) {
    EXPECT_TRUE(paper.contains(key) && paper[key].is_null()) << key;
  }
  std::vector<std::string> paper_text = motion;
  paper_text.insert(paper_text.end(), {"--renderer", "paper"});
  EXPECT_EQ(touch(paper_text).out.find("Unsettled"), std::string::npos);
}

TEST_F(Touch, TheTraceHasItsHeaderAndOneRowATick) {
  const CommandResult result =
      touch({"--insert", "0,0,35", "0,0,-10", "--trace", "t.csv", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const auto lines = linesOf(textOf(folder_.path("t.csv")));
  ASSERT_GT(lines.size(), 1U);
  EXPECT_EQ(lines[0], kHeader);
  EXPECT_EQ(lines.size() - 1, parseOnly(result)["ticks"].get<std::size_t>());
  std::size_t passed = 0;
  for (std::size_t i = 1; i < lines.size(); ++i) {
    const auto cells = cellsOf(lines[i]);
    ASSERT_EQ(cells.size(), 14U) << lines[i];
    EXPECT_GT(std::stoll(cells[13]), 0);
    if (cells[12] == "mouth") ++passed;
  }
  EXPECT_EQ(passed, 1U);
}

TEST_F(Touch, TheSameTraceTwiceExceptForTheTimes) {
  const std::vector<std::string> motion = {"--insert", "3,2,35", "10,-5,-45", "12,0,0", "--back"};
  for (const char* name : {"a.csv", "b.csv"}) {
    std::vector<std::string> arguments = motion;
    arguments.insert(arguments.end(), {"--trace", name});
    ASSERT_EQ(touch(arguments).exit_code, 0);
  }
  const std::string first = withoutTimes(textOf(folder_.path("a.csv")));
  EXPECT_GT(first.size(), 10000U);
  EXPECT_EQ(first, withoutTimes(textOf(folder_.path("b.csv"))));
}

TEST_F(Touch, ARecordedPathIsFollowedRowByRow) {
  (void)folder_.file("p.csv", "t,x,y,z\n0,0,0,0.05\n0.001,0,0,0.04\n0.002,0.001,0,0.03\n");
  ASSERT_EQ(touch({"--path", "p.csv", "--trace", "t.csv"}).exit_code, 0);
  const auto lines = linesOf(textOf(folder_.path("t.csv")));
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[3].find("0.002,0.001,0,0.03,"), 0U) << lines[3];
}

TEST_F(Touch, EveryMotionRunsWithBothRenderers) {
  const std::vector<std::vector<std::string>> motions = {
      {"--press", "0,0,-40", "--normal", "0,0,-1"},
      {"--tap", "0,0,-40", "--normal", "0,0,-1", "--taps", "2", "--frequency", "8"},
      {"--stroke", "-10,0,-39", "10,0,-39", "--repeats", "2"},
      {"--insert", "0,0,35", "0,0,0", "--hold", "0.05"}};
  for (auto motion : motions) {
    for (const char* renderer : {"constraint", "paper"}) {
      std::vector<std::string> arguments = motion;
      arguments.insert(arguments.end(), {"--renderer", renderer, "--json"});
      const CommandResult result = touch(arguments);
      ASSERT_EQ(result.exit_code, 0) << motion[0] << " " << renderer << "\n"
                                     << result.err << result.out;
      EXPECT_EQ(parseOnly(result)["renderer"], renderer);
      EXPECT_GT(parseOnly(result)["peak_force_N"], 0.0) << motion[0] << " " << renderer;
    }
  }
}

// The wall gives 3 N at 2 mm; the limits reduce the force on the hand.
TEST_F(Touch, LimitsOfTheForce) {
  const std::vector<std::string> motion = {"--press", "0,0,-40", "--normal", "0,0,-1",
                                           "--depth", "2",       "--hold",   "0.5",
                                           "--trace", "t.csv",   "--force",  "--json"};
  const auto forces = [&](std::vector<std::string> limits, Json& json) {
    limits.insert(limits.begin(), motion.begin(), motion.end());
    const CommandResult result = touch(limits);
    EXPECT_EQ(result.exit_code, 0) << result.err;
    json = parseOnly(result);
    std::vector<double> all;
    const auto lines = linesOf(textOf(folder_.path("t.csv")));
    for (std::size_t i = 1; i < lines.size(); ++i) {
      const auto cells = cellsOf(lines[i]);
      all.push_back(std::hypot(std::stod(cells[7]), std::stod(cells[8]), std::stod(cells[9])));
    }
    return all;
  };
  Json json;
  const std::vector<double> plain = forces({}, json);
  EXPECT_NEAR(json["peak_force_N"], 3.0, 1e-6);
  EXPECT_TRUE(json["limits"]["max_force_N"].is_null());
  EXPECT_TRUE(json["limits"]["slew_N_per_s"].is_null());
  EXPECT_TRUE(json["limits"]["ramp_s"].is_null());

  const std::vector<double> clamped = forces({"--max-force", "1.2"}, json);
  EXPECT_EQ(json["limits"]["max_force_N"], 1.2);
  EXPECT_NEAR(json["peak_force_N"], 1.2, 1e-12);
  ASSERT_EQ(clamped.size(), plain.size());
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(clamped[i], std::min(plain[i], 1.2), 1e-12) << i;
  }
  (void)forces({"--max-force", "1200mN"}, json);
  EXPECT_EQ(json["limits"]["max_force_N"], 1.2);

  // 10 N/s at 1 kHz: 0.01 N per tick upwards, and down at once.
  const std::vector<double> slewed = forces({"--slew", "10N/s"}, json);
  EXPECT_EQ(json["limits"]["slew_N_per_s"], 10.0);
  bool was_held_back = false;
  for (std::size_t i = 1; i < plain.size(); ++i) {
    EXPECT_LE(slewed[i] - slewed[i - 1], 0.01 + 1e-12) << i;
    EXPECT_LE(slewed[i], plain[i] + 1e-12) << i;
    was_held_back = was_held_back || slewed[i] < plain[i] - 0.1;
  }
  EXPECT_TRUE(was_held_back);

  // The motion takes well over 0.1 s before it rests at 3 N.
  const std::vector<double> ramped = forces({"--ramp", "400ms"}, json);
  EXPECT_EQ(json["limits"]["ramp_s"], 0.4);
  for (std::size_t i = 0; i < plain.size(); ++i) {
    EXPECT_NEAR(ramped[i], plain[i] * std::min(1.0, static_cast<double>(i) / 400.0), 1e-2) << i;
  }
  const std::string text = touch({"--press", "0,0,-40", "--normal", "0,0,-1", "--max-force", "2",
                                  "--slew", "50", "--ramp", "0.1"})
                               .out;
  EXPECT_NE(text.find("at most 2 N, growing by at most 50 N/s, from 0 in 0.1 s"), std::string::npos)
      << text;
}

TEST_F(Touch, RealTimeKeepsToTheClockAndReportsOverruns) {
  const CommandResult result = touch({"--press", "0,0,-40", "--normal", "0,0,-1", "--depth", "0.5",
                                      "--clearance", "0.5", "--hold", "0", "--realtime", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json realtime = parseOnly(result)["realtime"];
  EXPECT_EQ(realtime["clock"], "machine");
  EXPECT_TRUE(realtime["overruns"].is_number());
  // A turn never begins early; the histogram's quantiles rise.
  EXPECT_GE(realtime["late_ns"]["p50"], 0);
  EXPECT_LE(realtime["late_ns"]["p50"], realtime["late_ns"]["p999"]);
  EXPECT_LE(realtime["late_ns"]["p999"], realtime["late_ns"]["max"]);
  EXPECT_GT(realtime["work_ns"]["max"], 0);
}

TEST_F(Touch, AnInterruptEndsTheLoopAndKeepsWhatWasFelt) {
  const CommandResult result =
      runInterrupted({"touch", "c.yaml", "--press", "0,0,-40", "--normal", "0,0,-1", "--hold",
                      "3600", "--realtime", "--trace", "t.csv", "--plot", "p.svg"},
                     folder_.path(), SIGINT);
  EXPECT_EQ(result.out, "");
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"c.yaml", "t.csv"}));
  const std::string trace = textOf(folder_.path("t.csv"));
  EXPECT_EQ(trace.find(kHeader), 0U);
  EXPECT_EQ(trace.back(), '\n') << "whole rows";
}

TEST_F(Touch, NothingIsOverwrittenUnlessForced) {
  (void)folder_.file("t.csv", "mine");
  const CommandResult refused =
      touch({"--insert", "0,0,35", "0,0,0", "--trace", "t.csv", "--image", "i.png"});
  EXPECT_EQ(refused.exit_code, 1);
  EXPECT_NE(refused.err.find("t.csv"), std::string::npos);
  EXPECT_NE(refused.err.find("--force"), std::string::npos);
  EXPECT_EQ(textOf(folder_.path("t.csv")), "mine");
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"c.yaml", "t.csv"}));

  EXPECT_EQ(touch({"--insert", "0,0,35", "0,0,0", "--trace", "t.csv", "--force"}).exit_code, 0);
  EXPECT_EQ(textOf(folder_.path("t.csv")).find(kHeader), 0U);
}

TEST_F(Touch, AMissingFolderIsToldBeforeTheWork) {
  const CommandResult result = touch({"--insert", "0,0,35", "0,0,0", "--trace", "no/such/t.csv"});
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("no/such"), std::string::npos) << result.err;
}

TEST_F(Touch, APictureComesWithIt) {
  ASSERT_EQ(touch({"--insert", "0,0,35", "0,0,-10", "--image", "i.png"}).exit_code, 0);
  EXPECT_EQ(textOf(folder_.path("i.png")).substr(1, 3), "PNG");
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"c.yaml", "i.png"}));
}

TEST_F(Touch, APlotComesWithIt) {
  const CommandResult result =
      touch({"--insert", "0,0,35", "0,0,-10", "--back", "--plot", "p.svg", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(parseOnly(result)["plot"], "p.svg");
  const std::string svg = textOf(folder_.path("p.svg"));
  EXPECT_EQ(svg.rfind("<svg ", 0), 0U);
  EXPECT_NE(svg.find("depth of the hand, mm"), std::string::npos);
  // The mouth is named on the way in and on the way back; two curves of 45 mm at 50 um per tick.
  std::size_t mouths = 0;
  for (std::size_t at = svg.find(">mouth<"); at != std::string::npos;
       at = svg.find(">mouth<", at + 1)) {
    ++mouths;
  }
  EXPECT_EQ(mouths, 2U);
  EXPECT_GT(std::count(svg.begin(), svg.end(), ','), 2 * 900);
  const CommandResult wrong = touch({"--insert", "0,0,35", "0,0,-10", "--plot", "p.png"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find(".svg"), std::string::npos);
}

TEST_F(Touch, WorkIsThatOfTheTrace) {
  const CommandResult result = touch({"--insert", "0,0,35", "0,0,-10", "--back", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json json = parseOnly(result);
  // Twice 25 mm of syrup at 4 N.s/m and 50 mm/s; in the first quarter millimeter behind the mouth
  // the drag fades in.
  EXPECT_NEAR(json["work_on_hand_J"], -2 * 0.2 * 0.025, 0.2 * 0.5e-3);
  EXPECT_EQ(json["source_work_J"], 0.0);
}

TEST(TouchScenes, TheShippedScenesRun) {
  const struct {
    const char* scene;
    std::vector<std::string> motion;
    std::vector<std::string> regions;
  } runs[] = {
      {"container.yaml",
       {"--insert", "0,0,60", "0,0,0", "--back"},
       {"outside", "liquid", "outside"}},
      {"csg_part.yaml",
       {"--insert", "-22,0,30", "-22,0,5", "--back"},
       {"outside", "chamber", "outside"}},
      {"valve_tube.yaml",
       {"--insert", "-60,0,0", "60,0,0"},
       {"outside", "upstream", "downstream", "outside"}},
      {"fields.yaml", {"--stroke", "-120,30,14", "120,30,14"}, {"outside"}},
      {"sponge.yaml",
       {"--insert", "-6,0,40", "-6,0,-16", "--back"},
       {"outside", "jelly", "outside"}},
      {"flag.yaml",
       {"--insert", "30,0,15", "-5,0,15", "-5,0,-15", "30,0,-15"},
       {"outside", "water"}},
      {"slab.yaml",
       {"--insert", "0,0,5", "0,0,-45", "--back"},
       {"outside", "skin", "fat", "muscle", "outside", "muscle", "fat", "skin", "outside"}},
      {"lattice.yaml",
       {"--insert", "3,-7,30", "-11,13,-15", "--back"},
       {"outside", "grid", "outside"}},
      // The valve is closed on the way back: the proxy stays downstream.
      {"valve_tube.yaml",
       {"--insert", "-60,0,0", "20,0,0", "--back"},
       {"outside", "upstream", "downstream"}},
  };
  for (const auto& run : runs) {
    std::vector<std::string> arguments = {"touch", scenePath(run.scene), "--json"};
    arguments.insert(arguments.end(), run.motion.begin(), run.motion.end());
    const CommandResult result = runPalpate(arguments);
    ASSERT_EQ(result.exit_code, 0) << run.scene << "\n" << result.out << result.err;
    std::vector<std::string> regions;
    Json json = parseOnly(result);
    for (const Json& visit : json["regions"]) regions.push_back(visit["region"]);
    EXPECT_EQ(regions, run.regions) << run.scene;
    EXPECT_GT(json["peak_force_N"], 0.0) << run.scene;
  }
}

}  // namespace
}  // namespace palpate::testing
