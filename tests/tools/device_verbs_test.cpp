// `palpate devices`, `palpate doctor`, `palpate bench servo`: well-formed reports, whatever is
// plugged in here. The rights on this machine, and its latency, are not asserted.

#include <set>

#include "tools/helpers.h"

namespace palpate::testing {
namespace {

TEST(DeviceVerbs, TheListNamesEveryWayToADeviceAndWhatIsNotVerified) {
  const Json report = parseOnly(runPalpate({"devices", "--json"}));
  std::set<std::string> names;
  for (const Json& device : report["devices"]) {
    // For a connected input device, with its node.
    const std::string name = device["name"];
    names.insert(name.substr(0, name.find(':')));
    EXPECT_NE(device["notice"].get<std::string>().find("unverified on hardware"),
              std::string::npos);
    EXPECT_FALSE(device["found"].get<std::string>().empty());
  }
  EXPECT_EQ(names, (std::set<std::string>{"falcon", "inverse3", "hd", "dhd", "evdev"}));
}

/// The stand-in for Force Dimension's library: its device rests at its origin.
std::string fakeLibrary() { return test::buildFolder() + "/tests/libpalpate_fake_dhd.so"; }

TEST(DeviceVerbs, TheTableOfStatesIsThatOfTheLoop) {
  const CommandResult result = runPalpate({"devices", "--states"});
  EXPECT_EQ(result.exit_code, 0);
  for (const char* state :
       {"closed", "open", "uncalibrated", "idle", "ramping", "active", "fault"}) {
    EXPECT_NE(result.out.find(state), std::string::npos) << state;
  }
  const Json report = parseOnly(runPalpate({"devices", "--states", "--json"}));
  for (const Json& rule : report["states"]) {
    if (rule["from"] == "fault") {
      EXPECT_EQ(rule["to"], "closed");
    }
    if (rule["to"] == "active") {
      EXPECT_EQ(rule["from"], "ramping");
    }
  }
}

TEST(DeviceVerbs, ADeviceThatIsNotThereIsADeviceErrorWithARemedy) {
  const CommandResult hd =
      runPalpate({"devices", "--test", "hd", "--library", "libno_such_haptics.so", "--json"});
  EXPECT_EQ(hd.exit_code, 4);
  EXPECT_EQ(parseOnly(hd)["error"]["code"], "device.library");
  EXPECT_FALSE(parseOnly(hd)["error"]["hint"].is_null());
  // No service listens on port 1 of this machine.
  const CommandResult inverse =
      runPalpate({"devices", "--test", "inverse3", "--service", "127.0.0.1:1", "--json"});
  EXPECT_EQ(inverse.exit_code, 4);
}

TEST(DeviceVerbs, WhatADeviceDoesNotHaveIsAUsageError) {
  EXPECT_EQ(runPalpate({"devices", "--test", "phantom"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"devices", "--test", "hd", "--firmware", "x.bin"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"devices", "--test", "falcon", "--service", "127.0.0.1:1"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"devices", "--test", "inverse3", "--service", "here"}).exit_code, 2);
  EXPECT_EQ(runPalpate({"devices", "--test", "hd", "--states"}).exit_code, 2);
  const CommandResult unused = runPalpate({"devices", "--service", "127.0.0.1:1"});
  EXPECT_EQ(unused.exit_code, 2);
  EXPECT_NE(unused.err.find("add --test"), std::string::npos) << unused.err;
}

TEST(DeviceVerbs, AFirmwareThatIsNoneIsRefusedBeforeAnyDeviceIsLookedFor) {
  const TempFolder folder;
  const std::string image = folder.file("novint.bin", "not a boot table");
  const CommandResult result =
      runPalpate({"devices", "--test", "falcon", "--firmware", image, "--json"});
  EXPECT_EQ(result.exit_code, 3);
  EXPECT_EQ(parseOnly(result)["error"]["code"], "falcon.firmware");
}

/// Whether the loop stalled because this machine was busy: the only fault with which a device at
/// rest may end here.
bool stoodStill(const std::string& text) {
  return text.find("the servo loop stood still for too long") != std::string::npos;
}

TEST(DeviceVerbs, ATestReadsTheDeviceAndSaysThatItsDriverIsNotVerified) {
  const CommandResult result = runPalpate(
      {"devices", "--test", "dhd", "--library", fakeLibrary(), "--seconds", "1", "--json"});
  const Json report = parseOnly(result);
  EXPECT_EQ(report["notice"], "protocol from public sources, unverified on hardware");
  EXPECT_GT(report["result"]["ticks"].get<int>(), 0);
  if (result.exit_code == 0) {
    EXPECT_EQ(report["result"]["state"], "active");
  } else {
    EXPECT_TRUE(stoodStill(result.out)) << result.out;
  }
}

class TouchWithADevice : public ::testing::Test {
 protected:
  TouchWithADevice() {
    // The device's origin is 1 mm above a wall.
    (void)folder_.file("wall.yaml", kWallBelow);
  }
  CommandResult run(const std::vector<std::string>& arguments) {
    return runPalpate(arguments, folder_.path());
  }
  TempFolder folder_;
};

TEST_F(TouchWithADevice, ItsReadingsAreFeltAndRecordedUntilTheTimeIsOver) {
  const CommandResult result =
      run({"touch", "wall.yaml", "--device", "dhd", "--library", fakeLibrary(), "--seconds", "0.3",
           "--record", "felt.npy", "--json"});
  if (result.exit_code != 0) {
    EXPECT_EQ(result.exit_code, 4);
    EXPECT_TRUE(stoodStill(result.out)) << result.out;
    return;
  }
  const Json report = parseOnly(result);
  EXPECT_EQ(report["device"]["name"], "dhd");
  EXPECT_EQ(report["device"]["simulated"], false);
  EXPECT_EQ(report["device"]["notice"], "protocol from public sources, unverified on hardware");
  EXPECT_NE(result.err.find("unverified on hardware"), std::string::npos) << result.err;
  EXPECT_EQ(report["safety"]["fault"], "no fault");
  EXPECT_EQ(run({"replay", "felt.npy"}).exit_code, 0);
}

TEST_F(TouchWithADevice, ADeviceThatIsNotThereIsADeviceError) {
  const std::vector<std::vector<std::string>> cases = {
      {"evdev:/dev/input/no_such_event"},
      {"inverse3", "--service", "127.0.0.1:1"},
      {"hd", "--library", "libno_such_haptics.so"}};
  for (const std::vector<std::string>& device : cases) {
    std::vector<std::string> arguments = {"touch", "wall.yaml", "--json", "--device"};
    arguments.insert(arguments.end(), device.begin(), device.end());
    const CommandResult result = run(arguments);
    EXPECT_EQ(result.exit_code, 4) << result.err;
    EXPECT_FALSE(parseOnly(result)["error"]["hint"].is_null());
  }
}

TEST_F(TouchWithADevice, ANameIsADeviceOrAModelOfOneAndTheirOptionsAreNotMixed) {
  struct Case {
    std::vector<std::string> arguments;
    const char* says;
  };
  const std::vector<Case> cases = {
      {{"touch", "wall.yaml", "--device", "falcon", "--press", "0,0,0"}, "virtual:NAME"},
      {{"touch", "wall.yaml", "--device", "falcon", "--depth", "3"}, "--device falcon"},
      {{"touch", "wall.yaml", "--device", "falcon", "--hand", "firm"}, "virtual:NAME"},
      {{"touch", "wall.yaml", "--device", "hd", "--firmware", "x.bin"}, "--firmware"},
      {{"touch", "wall.yaml", "--device", "virtual:hd", "--press", "0,0,0"}, "excalibur"},
      {{"touch", "wall.yaml", "--press", "0,0,0", "--seconds", "3"}, "add --device falcon"},
      {{"touch", "wall.yaml", "--press", "0,0,0", "--device", "touch", "--serial", "A"},
       "add --device falcon"},
      {{"touch", "wall.yaml", "--device", "evdev", "--press", "0,0,0"}, "a hand moves the device"},
      {{"touch", "wall.yaml", "--device", "evdev", "--library", "x.so"}, "--library"},
      {{"touch", "wall.yaml", "--device", "evdev:", "--press", "0,0,0"}, "excalibur"},
      {{"explain", "wall.yaml", "--device", "evdev"}, "has no motors"},
      {{"explain", "wall.yaml", "--device", "dhd"}, "name the model"}};
  for (const Case& each : cases) {
    const CommandResult result = run(each.arguments);
    EXPECT_EQ(result.exit_code, 2) << each.says;
    EXPECT_NE(result.err.find(each.says), std::string::npos) << result.err;
  }
}

TEST_F(TouchWithADevice, TheModelOfADeviceIsSimulatedByItsPrefixAndItsBudgetNeedsNone) {
  const CommandResult simulated =
      run({"touch", "wall.yaml", "--device", "virtual:falcon", "--press", "0,0,-1", "--json"});
  EXPECT_EQ(simulated.exit_code, 0) << simulated.err;
  EXPECT_EQ(parseOnly(simulated)["device"]["simulated"], true);
  const CommandResult bare = run({"explain", "wall.yaml", "--device", "falcon", "--json"});
  const CommandResult prefixed =
      run({"explain", "wall.yaml", "--device", "virtual:falcon", "--json"});
  EXPECT_EQ(bare.exit_code, 0) << bare.err;
  EXPECT_EQ(parseOnly(bare)["budget"], parseOnly(prefixed)["budget"]);
}

TEST(DeviceVerbs, TheDoctorSaysOfEachThingWhetherItIsGood) {
  const CommandResult result = runPalpate({"doctor", "--json"});
  const Json report = parseOnly(result);
  bool is_good = true;
  for (const Json& finding : report["machine"]) {
    is_good = is_good && finding["good"].get<bool>();
    if (!finding["good"].get<bool>()) {
      EXPECT_FALSE(finding["remedy"].is_null()) << finding;
    }
  }
  EXPECT_EQ(report["good"], is_good);
  EXPECT_EQ(result.exit_code, is_good ? 0 : 1);
}

TEST(DeviceVerbs, TheServoBenchReportsEachRate) {
  const CommandResult result = runPalpate({"bench", "servo", "--rate", "100", "--rate", "500",
                                           "--seconds", "0.1", "--load", "0", "--json"});
  const Json report = parseOnly(result);
  ASSERT_EQ(report["results"].size(), 2U);
  bool is_good = true;
  for (const Json& row : report["results"]) {
    EXPECT_GT(row["turns"].get<int>(), 0);
    EXPECT_LE(row["late_ns"]["p50"], row["late_ns"]["max"]);
    is_good = is_good && row["good"].get<bool>();
  }
  EXPECT_EQ(result.exit_code, is_good ? 0 : 1);
}

}  // namespace
}  // namespace palpate::testing
