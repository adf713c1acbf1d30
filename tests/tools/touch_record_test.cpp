// palpate touch --record and palpate replay: a record survives however the run ends, NumPy reads
// it, and a replay gives the same results bit for bit.

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <string>
#include <vector>

#include "helpers.h"
#include "support/run_command.h"
#include "support/temp_file.h"
#include "support/wait.h"
#include "vdb/python_oracle.h"

namespace palpate::testing {
namespace {

/// A soft ball with friction and a viscous content.
constexpr const char* kBall = R"(palpate: 1
length: mm
materials:
  skin: {stiffness: 700 N/m, friction: {static: 0.4, kinetic: 0.2}}
  jelly: {viscosity: 2 N.s/m}
layers:
  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: 20}}, wall: skin, content: jelly}
ports:
  - {name: hole, between: [outside, ball], opens_at: 1 N, back: 0.4 N}
)";

class TouchRecord : public ::testing::Test {
 protected:
  TouchRecord() { (void)folder_.file("ball.yaml", kBall); }

  CommandResult palpate(const std::vector<std::string>& arguments) {
    return runPalpate(arguments, folder_.path());
  }
  std::vector<double> facts(const std::string& record) {
    return vdb::test::askScript("tools/record_oracle.py", "facts", {folder_.path(record)}).at(0);
  }
  /// A hand that wanders in and out of the ball.
  std::string wandering(unsigned seed, int ticks) {
    std::mt19937 random(seed);
    const auto any = [&](double lo, double hi) {
      return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    std::ostringstream text;
    text.precision(17);
    text << "t,x,y,z\n";
    double at[3] = {0.0, 0.0, 0.024};
    double goal[3] = {0.0, 0.0, 0.0};
    double t = 0.0;
    for (int n = 0; n < ticks; ++n) {
      t += any(0.8e-3, 1.2e-3);
      text << t;
      for (int i = 0; i < 3; ++i) {
        if (n % 150 == 0) goal[i] = any(-0.02, 0.02);
        at[i] += 0.01 * (goal[i] - at[i]);
        text << ',' << at[i];
      }
      text << '\n';
    }
    return text.str();
  }

  TempFolder folder_;
};

TEST_F(TouchRecord, NumPyFindsWhatTheTraceSaysAndItIsFeltAnew) {
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const std::string path = folder_.file("p.csv", wandering(seed, 1500));
    const CommandResult felt = palpate({"touch", "ball.yaml", "--path", path, "--record", "r.npy",
                                        "--states", "250", "--trace", "t.csv", "--slew", "50",
                                        "--set", "jelly.viscosity=9@0.6", "--force", "--json"});
    ASSERT_EQ(felt.exit_code, 0) << felt.err;
    EXPECT_EQ(parseOnly(felt)["record"], "r.npy");
    const auto rows =
        vdb::test::askScript("tools/record_oracle.py", "rows", {folder_.path("r.npy")});
    const auto lines = linesOf(textOf(folder_.path("t.csv")));
    ASSERT_EQ(rows.size(), 1500U);
    ASSERT_EQ(lines.size(), rows.size() + 1);
    double most = 0.0;
    for (std::size_t n = 0; n < rows.size(); ++n) {
      const auto cells = cellsOf(lines[n + 1]);
      for (std::size_t i = 0; i < 10; ++i) ASSERT_EQ(rows[n].at(i), std::stod(cells[i])) << n;
      ASSERT_EQ(rows[n].at(10), cells[10] == "ball" ? 1.0 : 0.0);
      ASSERT_EQ(rows[n].at(11), std::stod(cells[11]));
      most = std::max(most, std::fabs(rows[n].at(9)));
    }
    EXPECT_GT(most, 0.3);
    EXPECT_EQ(facts("r.npy").at(5), 5.0);

    const Json about = Json::parse(textOf(folder_.path("r.npy.json")));
    EXPECT_EQ(about["renderer"], "constraint");
    EXPECT_EQ(about["device"]["frame"], "world");
    EXPECT_EQ(about["regions"], Json({"outside", "ball"}));

    for (const std::string from : {"0", "249", "250", "777", "1499"}) {
      const CommandResult anew = palpate({"replay", "r.npy", "--from", from, "--json"});
      ASSERT_EQ(anew.exit_code, 0) << from << anew.err << anew.out;
      const Json json = parseOnly(anew);
      EXPECT_TRUE(json["is_same"]);
      EXPECT_EQ(json["begun_at_tick"], std::stoi(from) / 250 * 250);
      EXPECT_EQ(json["compared"], 1500 - std::stoi(from));
    }
  }
  // A replay works from another folder, too.
  EXPECT_EQ(runPalpate({"replay", folder_.path("r.npy")}).exit_code, 0);

  // If results differ, the answer is negative.
  std::string harder = kBall;
  harder.replace(harder.find("700"), 3, "770");
  (void)folder_.file("harder.yaml", harder);
  const CommandResult other =
      palpate({"replay", "r.npy", "--scene", "harder.yaml", "--from", "300", "--json"});
  EXPECT_EQ(other.exit_code, 1) << other.err;
  const Json json = parseOnly(other);
  EXPECT_FALSE(json["is_same"]);
  EXPECT_GE(json["first"]["tick"], 300);
  EXPECT_GT(json["largest_force_N"], 0.01);

  // Replay reports a scene that has changed.
  (void)folder_.file("ball.yaml", harder);
  const CommandResult changed = palpate({"replay", "r.npy"});
  EXPECT_EQ(changed.exit_code, 1);
  EXPECT_NE(changed.err.find("has changed since it was felt"), std::string::npos) << changed.err;
}

TEST_F(TouchRecord, StatesAreOnlyForTheSceneThatWasFelt) {
  // Two balls; the record has a state inside the one with the syrup.
  const auto scene = [](bool is_swapped) {
    const std::string one =
        "  - {name: one, inside: {sphere: {center: [0, 0, 0], radius: 20}}, wall: a, content: s}\n";
    const std::string two =
        "  - {name: two, inside: {sphere: {center: [100, 0, 0], radius: 20}}, wall: a}\n";
    return "palpate: 1\nlength: mm\nmaterials: {a: {stiffness: 500 N/m}, s: {viscosity: 4 "
           "N.s/m}}\nlayers:\n" +
           (is_swapped ? two + one : one + two) +
           "ports:\n  - {name: p, between: [outside, one]}\n";
  };
  (void)folder_.file("two.yaml", scene(false));
  ASSERT_EQ(palpate({"touch", "two.yaml", "--insert", "0,0,40", "0,0,0", "--record", "r.npy",
                     "--states", "100"})
                .exit_code,
            0);
  EXPECT_EQ(parseOnly(palpate({"replay", "r.npy", "--from", "300", "--json"}))["begun_at_tick"],
            300);
  // The same file at another place has the states, too.
  (void)folder_.file("copy.yaml", scene(false));
  EXPECT_EQ(parseOnly(palpate({"replay", "r.npy", "--from", "300", "--scene", "copy.yaml",
                               "--json"}))["begun_at_tick"],
            300);
  (void)folder_.file("two.yaml", scene(true));
  const CommandResult anew = palpate({"replay", "r.npy", "--from", "300", "--json"});
  EXPECT_EQ(anew.exit_code, 0) << anew.err << anew.out;
  EXPECT_EQ(parseOnly(anew)["begun_at_tick"], 0);
  EXPECT_NE(anew.err.find("has changed since it was felt"), std::string::npos) << anew.err;
  EXPECT_NE(anew.err.find("begins at the first tick"), std::string::npos) << anew.err;
}

TEST_F(TouchRecord, WhatGuardedTheLoopIsPartOfTheRecord) {
  std::string stiff = kBall;
  stiff.replace(stiff.find("700 N/m"), 7, "30000 N/m");
  stiff.replace(stiff.find("opens_at: 1 N"), 13, "opens_at: 90 N");
  (void)folder_.file("stiff.yaml", stiff);
  (void)folder_.file("own.yaml", stiff +
                                     "device: {passivity: {mass: 0.2 kg}, coupling: {stiffness: "
                                     "9000 N/m, damping: 4 N.s/m}}\n");
  const std::vector<std::vector<std::string>> all = {
      {"stiff.yaml"},
      {"stiff.yaml", "--device", "virtual:falcon"},
      {"stiff.yaml", "--coupling", "800,4"},
      {"stiff.yaml", "--device", "virtual:falcon", "--passivity", "observe"},
      {"stiff.yaml", "--device", "virtual:falcon", "--passivity", "control"},
      {"stiff.yaml", "--device", "virtual:falcon", "--passivity", "control", "--hand-force", "5"},
      {"stiff.yaml", "--device", "touch", "--hand", "firm", "--delay", "1", "--passivity",
       "control", "--coupling", "any_scene"},
      {"own.yaml"},
      {"own.yaml", "--device", "omega_3", "--coupling", "springs"}};
  for (const std::vector<std::string>& how : all) {
    std::vector<std::string> touch = {"touch",    "--press", "0,0,20",  "--depth",  "3",
                                      "--record", "r.npy",   "--force", "--states", "100"};
    touch.insert(touch.begin() + 1, how.begin(), how.end());
    const CommandResult felt = palpate(touch);
    ASSERT_EQ(felt.exit_code, 0) << how.back() << felt.err;
    for (const std::string from : {"0", "99", "333"}) {
      const CommandResult anew = palpate({"replay", "r.npy", "--from", from, "--json"});
      ASSERT_EQ(anew.exit_code, 0) << how.back() << ", from " << from << anew.err << anew.out;
      EXPECT_EQ(parseOnly(anew)["begun_at_tick"], std::stoi(from) / 100 * 100);
    }
    // Without its guards the loop behaves differently.
    const Json about = Json::parse(textOf(folder_.path("r.npy.json")));
    // Not tried: guards that do not change the force, and scenes that then guard the loop by
    // themselves.
    const char* key = about["options"]["coupling"] != "" ? "coupling" : "passivity";
    const std::string guard = about["options"][key];
    if (guard != "" && guard != "observe" && how.front() != "own.yaml") {
      Json other = about;
      other["options"][key] = "";
      other["options"]["hand_force"] = "";
      (void)folder_.file("r.npy.json", other.dump());
      EXPECT_EQ(palpate({"replay", "r.npy"}).exit_code, 1) << how.back() << ", " << key;
      EXPECT_EQ(palpate({"replay", "r.npy", "--from", "333"}).exit_code, 3);
    }
    for (const char* wrong : {"coupling", "passivity", "device", "hand_force"}) {
      Json other = about;
      other["options"][wrong] = "none such";
      (void)folder_.file("r.npy.json", other.dump());
      const CommandResult refused = palpate({"replay", "r.npy"});
      EXPECT_EQ(refused.exit_code, 3) << how.back() << ", " << wrong << refused.err;
    }
  }
}

TEST_F(TouchRecord, RegionsAreComparedByTheNamesInTheRecord) {
  ASSERT_EQ(
      palpate({"touch", "ball.yaml", "--press", "0,0,20", "--depth", "4", "--record", "r.npy"})
          .exit_code,
      0);
  std::string renamed = kBall;
  for (auto at = renamed.find("ball"); at != std::string::npos; at = renamed.find("ball")) {
    renamed.replace(at, 4, "bead");
  }
  (void)folder_.file("renamed.yaml", renamed);
  const CommandResult other = palpate({"replay", "r.npy", "--scene", "renamed.yaml", "--json"});
  EXPECT_EQ(other.exit_code, 1) << other.err;
  const Json json = parseOnly(other);
  EXPECT_GT(json["other_regions"], 10);
  EXPECT_EQ(json["largest_force_N"], 0.0);
}

TEST_F(TouchRecord, AnInterruptKeepsWhatWasFelt) {
  const CommandResult result =
      runInterrupted({"touch", "ball.yaml", "--press", "0,0,20", "--depth", "1", "--hold", "3600",
                      "--realtime", "--record", "r.npy", "--trace", "t.csv"},
                     folder_.path(), SIGINT);
  EXPECT_EQ(result.out, "");
  EXPECT_NE(result.err.find("r.npy and t.csv"), std::string::npos) << result.err;
  // The signal may come before the first tick; then nothing was felt.
  const char* told = facts("r.npy").at(0) == 0.0 ? "no tick was felt" : "the ticks until then";
  EXPECT_NE(result.err.find(told), std::string::npos) << result.err;
  EXPECT_EQ(filesIn(folder_.path()), (std::vector<std::string>{"ball.yaml", "r.npy", "r.npy.json",
                                                               "r.npy.states", "t.csv"}));
  EXPECT_EQ(linesOf(textOf(folder_.path("t.csv"))).size(), facts("r.npy").at(0) + 1.0);
}

TEST_F(TouchRecord, AKillInTheMiddleLeavesARecordThatIsWhole) {
  bool sent = false;
  const std::string record = folder_.path("r.npy");
  const CommandResult result = runPalpate(
      {"touch", "ball.yaml", "--press", "0,0,20", "--depth", "3", "--hold", "3600", "--realtime",
       "--record", "r.npy", "--states", "100"},
      folder_.path(), [&](std::string_view, pid_t process) {
        if (sent) return;
        sent = true;
        // Waits until some hundred ticks have been written.
        std::error_code failed;
        EXPECT_TRUE(waitUntil([&] {
          return kill(process, 0) != 0 || (std::filesystem::exists(record, failed) &&
                                           std::filesystem::file_size(record, failed) > 100000);
        }));
        kill(process, SIGKILL);
      });
  EXPECT_TRUE(sent);
  EXPECT_EQ(result.exit_code, 128 + SIGKILL);
  const std::vector<double> found = facts("r.npy");
  EXPECT_GT(found.at(0), 100.0);
  EXPECT_EQ(found.at(2), 0.0);
  EXPECT_EQ(found.at(3), found.at(0) - 1.0);
  EXPECT_EQ(palpate({"replay", "r.npy"}).exit_code, 0);
  EXPECT_EQ(palpate({"replay", "r.npy", "--from", "150"}).exit_code, 0);
}

TEST_F(TouchRecord, AFullDiskIsReportedAndWhatWasWrittenIsWhole) {
  rlimit old{};
  getrlimit(RLIMIT_FSIZE, &old);
  const rlimit small{1000000, old.rlim_max};
  setrlimit(RLIMIT_FSIZE, &small);
  const CommandResult result = palpate({"touch", "ball.yaml", "--press", "0,0,20", "--depth", "3",
                                        "--hold", "4", "--record", "r.npy"});
  setrlimit(RLIMIT_FSIZE, &old);
  EXPECT_EQ(result.exit_code, 1) << result.out;
  EXPECT_NE(result.err.find("r.npy: error: cannot write"), std::string::npos) << result.err;
  const std::vector<double> found = facts("r.npy");
  EXPECT_GT(found.at(0), 3400.0) << "1 MB of rows of 288 bytes";
  EXPECT_LT(found.at(0), 3500.0);
  EXPECT_EQ(palpate({"replay", "r.npy"}).exit_code, 0);
}

TEST_F(TouchRecord, AFaultIsPlayedAsItWasRecorded) {
  auto lines = linesOf(wandering(7, 900));
  for (const std::size_t n : {200U, 201U, 202U, 500U})
    lines[n].replace(lines[n].find(','), 99, ",nan,inf,0");
  for (const std::size_t n : {300U, 301U})
    lines[n].replace(0, lines[n].find(','), lines[299].substr(0, lines[299].find(',')));
  lines[400].replace(0, lines[400].find(','), "nan");
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  const std::string path = folder_.file("p.csv", text);
  const CommandResult refused = palpate({"touch", "ball.yaml", "--path", path});
  EXPECT_EQ(refused.exit_code, 3);
  EXPECT_NE(refused.err.find("p.csv:201"), std::string::npos) << refused.err;

  const CommandResult played =
      palpate({"touch", "ball.yaml", "--path", path, "--as-recorded", "--record", "r.npy",
               "--states", "100", "--trace", "t.csv", "--plot", "p.svg", "--image", "i.png"});
  ASSERT_EQ(played.exit_code, 0) << played.err;
  const auto rows = linesOf(textOf(folder_.path("t.csv")));
  ASSERT_EQ(rows.size(), 901U);
  for (std::size_t n = 1; n < rows.size(); ++n) {
    const auto cells = cellsOf(rows[n]);
    const bool is_broken = n == 200 || n == 201 || n == 202 || n == 500;
    EXPECT_EQ(cells[1] == "nan", is_broken) << rows[n];
    for (std::size_t i = 7; i < 10; ++i) {
      ASSERT_TRUE(std::isfinite(std::stod(cells[i]))) << rows[n];
      if (is_broken) {
        EXPECT_EQ(std::stod(cells[i]), 0.0) << rows[n];
      }
    }
  }
  EXPECT_EQ(palpate({"replay", "r.npy"}).exit_code, 0);
  EXPECT_EQ(palpate({"replay", "r.npy", "--from", "451"}).exit_code, 0);
  EXPECT_EQ(palpate({"touch", "ball.yaml", "--press", "0,0,20", "--as-recorded"}).exit_code, 2);
}

TEST_F(TouchRecord, ARecordThatCannotBeReadIsOneErrorWithItsFile) {
  const std::string path = folder_.file("p.csv", wandering(2, 600));
  ASSERT_EQ(palpate({"touch", "ball.yaml", "--path", path, "--record", "r.npy", "--states", "100"})
                .exit_code,
            0);
  const std::vector<std::string> files = {"r.npy", "r.npy.json", "r.npy.states"};
  std::vector<std::string> good;
  for (const std::string& file : files) good.push_back(textOf(folder_.path(file)));
  std::mt19937 random(1);
  int refused = 0;
  for (int i = 0; i < 30; ++i) {
    const std::size_t which = random() % 3;
    std::string bytes = good[which];
    const std::size_t at = random() % std::min<std::size_t>(bytes.size(), 1500);
    if (random() % 3 == 0) {
      bytes.resize(at);
    } else {
      bytes[at] ^= static_cast<char>(1 + random() % 255);
    }
    for (std::size_t f = 0; f < 3; ++f) (void)folder_.file(files[f], f == which ? bytes : good[f]);
    const CommandResult result = palpate({"replay", "r.npy", "--from", "200"});
    // Results agree, results differ, or there is one error that names a file of the record.
    EXPECT_TRUE(result.exit_code == 0 || result.exit_code == 1 || result.exit_code == 3)
        << result.exit_code << result.err;
    if (result.exit_code != 3) continue;
    ++refused;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("error: "), std::string::npos) << result.err;
  }
  EXPECT_GT(refused, 10);

  for (std::size_t f = 0; f < 3; ++f) (void)folder_.file(files[f], good[f]);
  EXPECT_EQ(palpate({"replay", "r.npy", "--from", "600"}).exit_code, 3);
  EXPECT_EQ(palpate({"replay", "none.npy"}).exit_code, 3);
  EXPECT_EQ(palpate({"replay"}).exit_code, 2);
  EXPECT_EQ(palpate({"replay", "p.csv"}).exit_code, 3);
  EXPECT_EQ(palpate({"touch", "ball.yaml", "--path", path, "--record", "r.csv"}).exit_code, 2);
  const CommandResult there = palpate({"touch", "ball.yaml", "--path", path, "--record", "r.npy"});
  EXPECT_EQ(there.exit_code, 1);
  EXPECT_NE(there.err.find("--force"), std::string::npos) << there.err;
  EXPECT_EQ(textOf(folder_.path("r.npy")), good[0]);
}

TEST_F(TouchRecord, AnOutputThatIsALinkToAnotherIsRefused) {
  const std::vector<std::string> press = {"touch", "ball.yaml", "--press", "0,0,20"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), press.begin(), press.end());
    return palpate(more);
  };
  ASSERT_EQ(with({"--record", "r.npy"}).exit_code, 0);
  const std::string good = textOf(folder_.path("r.npy"));
  std::filesystem::create_symlink("r.npy", folder_.path("link.csv"));
  std::filesystem::create_symlink("r.npy.json", folder_.path("about.csv"));
  std::filesystem::create_directory(folder_.path("sub"));
  std::filesystem::create_directory_symlink("sub", folder_.path("same"));
  const std::vector<std::vector<std::string>> wrong = {
      {"--record", "r.npy", "--trace", "link.csv", "--force"},
      {"--record", "r.npy", "--trace", "about.csv", "--force"},
      {"--record", "r.npy", "--trace", "./sub/../r.npy", "--force"},
      {"--record", "sub/n.npy", "--trace", "same/n.npy"},
  };
  for (const std::vector<std::string>& more : wrong) {
    const CommandResult result = with(more);
    EXPECT_EQ(result.exit_code, 2) << more.at(3) << result.err;
    EXPECT_NE(result.err.find("two outputs are the same file"), std::string::npos) << result.err;
    EXPECT_EQ(textOf(folder_.path("r.npy")), good);
  }
  EXPECT_TRUE(filesIn(folder_.path("sub")).empty());
  EXPECT_EQ(with({"--record", "sub/n.npy", "--trace", "same/t.csv"}).exit_code, 0);
}

TEST_F(TouchRecord, OptionsThatARecordCannotHaveAreAFaultOfItsFile) {
  ASSERT_EQ(palpate({"touch", "ball.yaml", "--press", "0,0,20", "--record", "r.npy"}).exit_code, 0);
  const Json good = Json::parse(textOf(folder_.path("r.npy.json")));
  const std::vector<std::pair<const char*, Json>> wrong = {
      {"ramp", "nan"},
      {"epsilon", "1e999"},
      {"max_force", "3 mm"},
      {"set", Json::array({"zz"})},
      {"set", Json::array({"jelly.viscosity=-7@0.3"})},
      {"set", Json::array({"honey.viscosity=7@0.3"})},
      {"alpha", -1.0},
      {"alpha_form", "none"},
      {"interior", "both"},
      {"halvings", 0},
      {"halvings", 2.5},
      {"halvings", 1001},
  };
  for (const auto& [key, value] : wrong) {
    Json about = good;
    about["options"][key] = value;
    (void)folder_.file("r.npy.json", about.dump());
    const CommandResult result = palpate({"replay", "r.npy"});
    EXPECT_EQ(result.exit_code, 3) << key << value << result.err;
    EXPECT_EQ(result.out, "");
    EXPECT_NE(result.err.find("r.npy.json: error: "), std::string::npos) << result.err;
  }
  (void)folder_.file("r.npy.json", good.dump());
  EXPECT_EQ(palpate({"replay", "r.npy"}).exit_code, 0);
}

TEST_F(TouchRecord, WhatCannotBeAskedForIsUsage) {
  ASSERT_EQ(palpate({"touch", "ball.yaml", "--press", "0,0,20", "--record", "r.npy"}).exit_code, 0);
  for (const char* from : {"-1", "-18446744073709551615", "99999999999999999999", "1.5", "x", ""}) {
    const CommandResult result = palpate({"replay", "r.npy", "--from", from});
    EXPECT_EQ(result.exit_code, 2) << from << result.err;
  }
  for (const char* output : {"--record", "--trace", "--image", "--plot"}) {
    EXPECT_EQ(palpate({"touch", "ball.yaml", "--press", "0,0,20", output, ""}).exit_code, 2)
        << output;
  }
  const CommandResult states =
      palpate({"touch", "ball.yaml", "--press", "0,0,20", "--states", "5"});
  EXPECT_EQ(states.exit_code, 2) << states.err;
  EXPECT_NE(states.err.find("--record"), std::string::npos) << states.err;
}

TEST_F(TouchRecord, ATouchedShapeIsFeltAnewWithoutItsOptions) {
  (void)folder_.file("wedge.obj",
                     "v 0 0 0\nv 30 0 0\nv 0 30 0\nv 0 0 30\nf 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n");
  ASSERT_EQ(palpate({"touch", "wedge.obj", "--voxel", "1", "--record", "r.npy"}).exit_code, 0);
  const CommandResult anew = palpate({"replay", "r.npy", "--json"});
  EXPECT_EQ(anew.exit_code, 0) << anew.err << anew.out;
}

}  // namespace
}  // namespace palpate::testing
