// palpate touch --set: contents that change while the hand moves; the paper's parameters; presses
// that meet nothing.

#include <cmath>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

class TouchSet : public ::testing::Test {
 protected:
  TouchSet() { (void)folder_.file("c.yaml", kContainer); }

  CommandResult touch(std::vector<std::string> arguments) {
    arguments.insert(arguments.begin(), {"touch", "c.yaml"});
    return runPalpate(arguments, folder_.path());
  }

  /// A column of the trace, by tick.
  std::vector<double> column(std::size_t index) {
    std::vector<double> all;
    const auto lines = linesOf(textOf(folder_.path("t.csv")));
    for (std::size_t i = 1; i < lines.size(); ++i)
      all.push_back(std::stod(cellsOf(lines[i])[index]));
    return all;
  }

  TempFolder folder_;
};

// Straight through the syrup at 50 mm/s: 4 N.s/m give 0.2 N.
const std::vector<std::string> kThroughSyrup = {"--insert", "0,0,14",  "0,0,-30", "--hold",
                                                "0",        "--trace", "t.csv",   "--json"};

TEST_F(TouchSet, TheDragBecomesThatOfTheNewViscosityInTheTickOfItsTime) {
  std::string text = kContainer;
  text += "start: {region: liquid}\n";
  (void)folder_.file("c.yaml", text);
  auto arguments = kThroughSyrup;
  arguments.insert(arguments.end(), {"--set", "syrup.viscosity=9 N.s/m@0.5s", "--set",
                                     "syrup.viscosity=0.002Ns/mm@250ms"});
  const CommandResult result = touch(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const std::vector<double> times = column(0);
  const std::vector<double> force = column(9);
  ASSERT_GT(times.back(), 0.8);
  for (std::size_t i = 400; i < times.size() - 1;
       ++i) {  // beyond the distance over which the content fades in
    const double viscosity = times[i] < 0.5 ? 2.0 : 9.0;
    ASSERT_NEAR(force[i], viscosity * 0.05, 1e-9) << times[i];
  }
  ASSERT_NEAR(force[200], 4.0 * 0.05, 1e-9);
  const Json json = parseOnly(result);
  ASSERT_EQ(json["set"].size(), 2U);
  EXPECT_EQ(json["set"][0]["t"], 0.25) << "by time";
  EXPECT_EQ(json["set"][1]["material"], "syrup");
  EXPECT_EQ(json["set"][1]["key"], "viscosity");
  EXPECT_EQ(json["set"][1]["value"], 9.0);
}

TEST_F(TouchSet, FlowLatticeAndCutting) {
  std::string text = kContainer;
  text.replace(text.find("{viscosity: 4 N.s/m}"), 20,
               "{viscosity: 4 N.s/m, stiffness: 1000 N/m, lattice: {force: 0.1 N, wavelength: [8, "
               "8, 8]}}");
  text += "start: {region: liquid}\n";
  (void)folder_.file("c.yaml", text);
  auto arguments = kThroughSyrup;
  arguments.insert(arguments.end(),
                   {"--set", "syrup.lattice.force=0@0.3", "--set", "syrup.flow=20 mm/s,0,0@0.5"});
  const CommandResult result = touch(arguments);
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const std::vector<double> times = column(0);
  const std::vector<double> x = column(7);
  const std::vector<double> z = column(9);
  bool had_lattice = false;
  for (std::size_t i = 150; i < times.size() - 1; ++i) {
    if (times[i] < 0.3) had_lattice |= std::fabs(z[i] - 0.2) > 0.05;
    if (times[i] >= 0.3) {
      ASSERT_NEAR(z[i], 0.2, 1e-9) << times[i];
    }
    ASSERT_NEAR(x[i], times[i] < 0.5 ? 0.0 : 4.0 * 0.02, 1e-9) << times[i];
  }
  EXPECT_TRUE(had_lattice);
  EXPECT_EQ(touch({"--insert", "0,0,14", "0,0,-30", "--set", "syrup.cutting=0.5@0.1"}).exit_code,
            0);
}

TEST_F(TouchSet, WhatIsNoSettingIsWrongUsage) {
  for (const char* bad :
       {"syrup.viscosity=9", "syrup.viscosity@1", "viscosity=9@1", "syrup=9@1",
        "syrup.stiffness=9@1", "syrup.viscosity=9 N@1", "syrup.viscosity=@1", "syrup.viscosity=9@",
        "syrup.viscosity=9@-1", "syrup.viscosity=9@1 N", "syrup.flow=1,2@1", ".viscosity=9@1"}) {
    const CommandResult result =
        touch({"--insert", "0,0,14", "0,0,-30", "--set", bad, "--trace", "t.csv"});
    EXPECT_EQ(result.exit_code, 2) << bad << "\n" << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("--set"), std::string::npos) << result.err;
  }
  EXPECT_EQ(filesIn(folder_.path()), std::vector<std::string>{"c.yaml"});
}

TEST_F(TouchSet, WhatTheSceneCannotHaveIsBadInput) {
  const struct {
    const char* set;
    const char* told;
  } rows[] = {{"sirup.viscosity=9@0.1", "'syrup'"},
              {"glass.viscosity=9@0.1", "no region is filled"},
              {"syrup.viscosity=-9@0.1", "0 N.s/m or more"},
              {"syrup.lattice.force=1@0.1", "lattice"},
              {"syrup.cutting=1@0.1", "stiffness"},
              {"syrup.viscosity=9@100", "the motion ends"}};
  for (const auto& row : rows) {
    const CommandResult result =
        touch({"--insert", "0,0,14", "0,0,-30", "--set", row.set, "--trace", "t.csv"});
    EXPECT_EQ(result.exit_code, 3) << row.set << "\n" << result.err;
    EXPECT_NE(result.err.find(row.told), std::string::npos) << result.err;
    const CommandResult json = touch({"--insert", "0,0,14", "0,0,-30", "--set", row.set, "--json"});
    EXPECT_EQ(json.exit_code, 3);
    EXPECT_TRUE(parseOnly(json).contains("error")) << json.out;
  }
  EXPECT_EQ(filesIn(folder_.path()), std::vector<std::string>{"c.yaml"});
}

TEST_F(TouchSet, APressThatMissesSaysSoAndEndsWith1) {
  for (const char* motion : {"--press", "--tap"}) {
    const std::vector<std::string> beside = {motion, "0,100,0"};
    const CommandResult text = touch(beside);
    EXPECT_EQ(text.exit_code, 1);
    EXPECT_NE(text.out.find("met nothing"), std::string::npos) << text.out;
    const CommandResult json = touch({motion, "0,100,0", "--json"});
    EXPECT_EQ(json.exit_code, 1);
    EXPECT_EQ(parseOnly(json)["met_something"], false);
    EXPECT_EQ(parseOnly(json)["contact_ticks"], 0);
    const CommandResult hit = touch({motion, "0,0,-40", "--normal", "0,0,-1", "--json"});
    EXPECT_EQ(hit.exit_code, 0);
    EXPECT_EQ(parseOnly(hit)["met_something"], true);
  }
  // Going into the syrup through the mouth counts as meeting something, though there is no wall;
  // and a stroke is allowed to meet nothing.
  EXPECT_EQ(touch({"--press", "0,0,15"}).exit_code, 0);
  EXPECT_EQ(touch({"--stroke", "0,100,0", "0,100,10"}).exit_code, 0);
}

TEST_F(TouchSet, ThePapersParametersAreFlags) {
  const std::vector<std::string> press = {"--insert", "0,0,30",     "0,0,-41", "1,0,-41",
                                          "--hold",   "0",          "--trace", "t.csv",
                                          "--force",  "--renderer", "paper"};
  const auto last_x = [&](std::vector<std::string> more) {
    more.insert(more.begin(), press.begin(), press.end());
    EXPECT_EQ(touch(more).exit_code, 0);
    const std::vector<double> x = column(7);
    return x[x.size() - 3];
  };
  // The wall's normal leans by 1 in 41 there, and by as much more where the paper's contact point
  // has drifted.
  const double by_wall = last_x({"--interior", "wall"});
  EXPECT_NEAR(by_wall, -1.0 / 41.0, 1.0 / 41.0);
  EXPECT_NEAR(last_x({}) - by_wall, -4.0 * 0.05, 1e-9) << "drag along the wall";
  const double tuned = last_x({"--epsilon", "1um", "--halvings", "60", "--alpha", "0.5",
                               "--alpha-form", "newton", "--interior", "together"});
  EXPECT_NEAR(tuned - by_wall, -0.2, 1e-4) << "epsilon moves the contact point by no more";
  const CommandResult wrong = touch({"--insert", "0,0,30", "0,0,0", "--alpha", "1"});
  EXPECT_EQ(wrong.exit_code, 2);
  EXPECT_NE(wrong.err.find("--renderer paper"), std::string::npos) << wrong.err;
  EXPECT_EQ(
      touch({"--insert", "0,0,30", "0,0,0", "--renderer", "paper", "--epsilon", "0"}).exit_code, 2);
}

TEST(TouchPaper, TheCompositeTubePassesItsPortsAsInFigure27) {
  const CommandResult result = runPalpate({"touch", scenePath("composite_tube.yaml"), "--renderer",
                                           "paper", "--insert", "-60,0,0", "60,0,0", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  Json json = parseOnly(result);
  std::vector<std::string> ports;
  for (const Json& event : json["events"]) ports.push_back(event["port"]);
  EXPECT_EQ(ports, (std::vector<std::string>{"port 1", "port 2", "port 3", "port 4"}));
  EXPECT_EQ(json["regions"].back()["region"], "outside");
}

}  // namespace
}  // namespace palpate::testing
