// Devices on the command line: a simulated one in a touch, and the stability budget of a scene.

#include <cmath>

#include "folders/folders.h"
#include "palpate/devices/device_presets.h"
#include "palpate/devices/scene_budget.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/register.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

constexpr const char* kWall = R"(
palpate: 1
length: mm
materials:
  wall: {stiffness: 1000 N/m}
layers:
  - {name: wall, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: wall}
)";

class DeviceInTheLoop : public ::testing::Test {
 protected:
  DeviceInTheLoop() { (void)folder_.file("wall.yaml", kWall); }
  CommandResult run(const std::vector<std::string>& arguments) {
    return runPalpate(arguments, folder_.path());
  }
  TempFolder folder_;
};

TEST_F(DeviceInTheLoop, ATouchMovesTheDeviceByTheHandAndTheWall) {
  // A relaxed hand aims 4 mm into the wall. At rest its spring, 250 N/m, its grip, 800 N/m, and the
  // wall, 1000 N/m, are in series: the wall takes 1 / 1000 of 4 mm / (1 / 250 + 1 / 800 + 1 /
  // 1000), 0.64 mm and 0.64 N. The device may rest off this place by its friction, 0.3 N,
  // divided by the stiffness of wall and hand together, 1190 N/m, plus the encoder's step, 9 um.
  const CommandResult result =
      run({"touch", "wall.yaml", "--press", "0,0,0", "--depth", "4", "--hold", "2", "--device",
           "omega_3", "--trace", "trace.csv", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err;
  const Json json = parseOnly(result);
  EXPECT_EQ(json["device"]["name"], "omega_3");
  EXPECT_EQ(json["device"]["mass_kg"]["known"], "assumed");
  EXPECT_EQ(json["device"]["max_force_N"]["known"], "sourced");
  EXPECT_EQ(json["device"]["hand"]["name"], "relaxed");
  EXPECT_EQ(json["over_budget"].size(), 0U);
  const std::vector<std::string> rows = linesOf(textOf(folder_.path() + "/trace.csv"));
  // The last tick of the hold; the way there takes 0.18 s.
  const std::string& row = rows[2100];
  double t = 0.0;
  double x = 0.0;
  double y = 0.0;
  double z = 0.0;
  ASSERT_EQ(std::sscanf(row.c_str(), "%lf,%lf,%lf,%lf", &t, &x, &y, &z), 4) << row;
  EXPECT_NEAR(z, -0.64e-3, 0.3 / 1190.0 + 9e-6);
  EXPECT_LT(z, -0.3e-3);
  // Positions are multiples of the encoder's step.
  EXPECT_NEAR(z / 9e-6, std::round(z / 9e-6), 1e-6);
}

TEST_F(DeviceInTheLoop, TheSameTouchGivesTheSameTrace) {
  const std::vector<std::string> arguments = {"touch",   "wall.yaml", "--tap",
                                              "0,0,0",   "--device",  "virtual:touch",
                                              "--delay", "1",         "--record"};
  std::vector<std::string> first = arguments;
  first.emplace_back("a.npy");
  std::vector<std::string> second = arguments;
  second.emplace_back("b.npy");
  ASSERT_EQ(run(first).exit_code, 0);
  ASSERT_EQ(run(second).exit_code, 0);
  // Replayed, a record of the device's readings gives the same result, bit for bit.
  EXPECT_EQ(run({"replay", "a.npy"}).exit_code, 0);
  EXPECT_EQ(run({"replay", "b.npy"}).exit_code, 0);
}

TEST_F(DeviceInTheLoop, ATouchWarnsOfWhatTheDeviceCannotHold) {
  const CommandResult result = run(
      {"touch", "wall.yaml", "--press", "0,0,0", "--device", "touch", "--hand", "none", "--json"});
  // Nobody holds the device: it hovers where it was put, and the press meets nothing.
  EXPECT_EQ(result.exit_code, 1);
  EXPECT_NE(result.err.find("wall.stiffness, 1000 N/m at the hand, is 31.2 times its budget"),
            std::string::npos)
      << result.err;
  EXPECT_NE(result.err.find("palpate explain wall.yaml --device touch --rate 1000 --hand none"),
            std::string::npos)
      << result.err;
  const Json json = parseOnly(result);
  ASSERT_EQ(json["over_budget"].size(), 1U);
  EXPECT_EQ(json["over_budget"][0]["ruled_by"], "linear");
}

TEST_F(DeviceInTheLoop, ExplainListsTheBudgetAndTheCures) {
  const CommandResult json = run(
      {"explain", "wall.yaml", "--device", "touch", "--hand", "none", "--rate", "1000", "--json"});
  ASSERT_EQ(json.exit_code, 0) << json.err;
  const Json report = parseOnly(json);
  ASSERT_EQ(report["budget"].size(), 1U);
  const Json& wall = report["budget"][0];
  devices::LoopModel loop;
  loop.device = devices::devicePreset("touch").model();
  const devices::StabilityBudget budget = devices::budgetOf(loop);
  EXPECT_DOUBLE_EQ(wall["linear_N_per_m"], budget.linear);
  EXPECT_DOUBLE_EQ(wall["passive_N_per_m"], budget.passive);
  EXPECT_DOUBLE_EQ(wall["encoder_N_per_m"], budget.friction);
  EXPECT_DOUBLE_EQ(wall["allowed_N_per_m"], budget.stiffness());
  EXPECT_TRUE(wall["above"]);
  EXPECT_NEAR(wall["quiet_up_to_m_per_s"], 0.69, 0.02);
  EXPECT_EQ(wall["cure"]["hands"], Json::array({"relaxed", "firm"}));
  EXPECT_NEAR(wall["cure"]["rate_Hz"], 31250.0, 100.0);  // 1000 / (0.8 * 40) kHz
  EXPECT_NEAR(wall["cure"]["force_share"], 0.032, 1e-4);
  ASSERT_EQ(report["hand_limits"].size(), 3U);
  EXPECT_NEAR(report["hand_limits"][1]["linear_N_per_m"], 6699.0, 1.0);

  const CommandResult text = run({"explain", "wall.yaml", "--device", "touch", "--hand", "none"});
  ASSERT_EQ(text.exit_code, 0) << text.err;
  for (const char* part :
       {"Stability at 1000 Hz", "Touch (3D Systems)", "(not verified)", "(assumed)", "nobody",
        "31.2 times its budget", "taps up to 690 mm/s", "a hand that is relaxed or firm"}) {
    EXPECT_NE(text.out.find(part), std::string::npos) << part << " in\n" << text.out;
  }
  const CommandResult held = run({"explain", "wall.yaml", "--device", "falcon"});
  EXPECT_NE(held.out.find("All of it is within the budget"), std::string::npos) << held.out;
}

TEST_F(DeviceInTheLoop, WrongUsesAreSaid) {
  struct Case {
    std::vector<std::string> arguments;
    const char* says;
  };
  const std::vector<Case> cases = {
      {{"touch", "wall.yaml", "--press", "0,0,0", "--hand", "firm"}, "add --device"},
      {{"touch", "wall.yaml", "--press", "0,0,0", "--device", "omni"}, "premium_1_5"},
      {{"touch", "wall.yaml", "--press", "0,0,0", "--device", "touch", "--hand", "iron"},
       "relaxed"},
      {{"touch", "wall.yaml", "--press", "0,0,0", "--device", "touch", "--delay", "65"}, "--delay"},
      {{"explain", "wall.yaml", "--rate", "1000"}, "add --device"},
      {{"explain", "wall.yaml", "--device", "omni"}, "excalibur"}};
  for (const Case& each : cases) {
    const CommandResult result = run(each.arguments);
    EXPECT_EQ(result.exit_code, 2) << each.says;
    EXPECT_NE(result.err.find(each.says), std::string::npos) << result.err;
  }
}

/// The remark that a scene file must contain about itself.
std::string remarkOf(const std::vector<std::string>& names) {
  if (names.empty())
    return "# In a relaxed hand at 1 kHz within the stability budget of every device preset.";
  std::string list;
  for (const std::string& name : names) list += (list.empty() ? "" : ", ") + name;
  return "# In a relaxed hand at 1 kHz above the stability budget of: " + list + ".";
}

TEST(ExampleScenes, SayOnWhichDevicesTheyAreAboveTheStabilityBudget) {
  int scenes = 0;
  for (const auto& entry :
       std::filesystem::directory_iterator(palpate::test::sourceFolder() + "/data/scenes")) {
    if (entry.path().extension() != ".yaml") continue;
    ++scenes;
    SceneRegistry registry;
    vdb::registerKinds(registry, {});
    const ScenePtr scene = compile(readScene(entry.path().string(), registry));
    std::vector<std::string> above;
    for (const devices::DevicePreset& preset : devices::devicePresets()) {
      devices::LoopModel loop;
      loop.device = preset.model();
      loop.hand = devices::handPreset("relaxed");
      double most = 0.0;
      std::string worst;
      for (const devices::BudgetItem& each : devices::sceneBudget(*scene, loop)) {
        if (each.share > most) {
          most = each.share;
          worst = each.item.material + "." + each.item.parameter;
        }
      }
      if (most > 1.0) above.emplace_back(preset.name);
      std::printf("  %-20s %-12s %7.1f %% of the budget: %s\n",
                  entry.path().stem().string().c_str(), std::string(preset.name).c_str(),
                  100.0 * most, worst.c_str());
    }
    const std::string remark = remarkOf(above);
    const std::vector<std::string> lines = linesOf(textOf(entry.path().string()));
    EXPECT_EQ(std::count(lines.begin(), lines.end(), remark), 1)
        << entry.path().filename() << " must say, in a line of its own:\n"
        << remark;
  }
  EXPECT_GT(scenes, 15);
}

}  // namespace
}  // namespace palpate::testing
