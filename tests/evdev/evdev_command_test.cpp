// The command with an input device in the hand. It opens a device that umockdev emulates in this
// process.

#ifdef PALPATE_TOOLS

#include <gtest/gtest.h>

#include "node.h"
#include "tools/helpers.h"

namespace palpate::testing {
namespace {

class EvdevCommand : public ::testing::Test {
 protected:
  EvdevCommand() : mouse_(bed_, 4) {
    mouse_.name = "Mock Mouse";
    mouse_.has_keys.set(BTN_LEFT);
    for (const int axis : {REL_X, REL_Y, REL_WHEEL}) {
      mouse_.has_relative.set(static_cast<std::size_t>(axis));
    }
    // The hand starts 1 mm above a wall.
    (void)folder_.file("wall.yaml", kWallBelow);
  }
  CommandResult run(const std::vector<std::string>& arguments) {
    return runPalpate(arguments, folder_.path());
  }
  Testbed bed_;
  Node mouse_;
  TempFolder folder_;
};

TEST_F(EvdevCommand, TheListHasTheDeviceByTheNameThatTouchTakes) {
  const Json report = parseOnly(run({"devices", "--json"}));
  const Json& last = report["devices"].back();
  EXPECT_EQ(last["name"], "evdev:/dev/input/event4");
  EXPECT_EQ(last["title"], "mouse, Mock Mouse");
  EXPECT_EQ(last["ready"], true);
  EXPECT_EQ(last["notice"], "force is shown, not felt; unverified on hardware");
}

TEST_F(EvdevCommand, AMouseFeelsAWallAndItsRecordIsFeltAnew) {
  // 60 counts of 25.4 um towards the wall: 0.524 mm beyond it.
  mouse_.reportAtRead(5, {{EV_REL, REL_Y, -60}});
  const CommandResult result = run({"touch", "wall.yaml", "--device", "evdev", "--seconds", "1",
                                    "--record", "felt.npy", "--json"});
  ASSERT_EQ(result.exit_code, 0) << result.err << result.out;
  const Json report = parseOnly(result);
  EXPECT_EQ(report["device"]["name"], "evdev");
  EXPECT_EQ(report["device"]["notice"], "force is shown, not felt; unverified on hardware");
  EXPECT_EQ(report["met_something"], true);
  EXPECT_NEAR(report["peak_force_N"].get<double>(), 0.524, 1e-9) << report;
  EXPECT_EQ(run({"replay", "felt.npy"}).exit_code, 0);
}

TEST_F(EvdevCommand, ADeviceThatIsUnpluggedEndsTheTouchAsADeviceError) {
  const CommandResult result =
      runPalpate({"touch", "wall.yaml", "--device", "evdev:/dev/input/event4", "--json"},
                 folder_.path(), [this](std::string_view, pid_t) { mouse_.unplug(); });
  EXPECT_EQ(result.exit_code, 4) << result.err;
}

}  // namespace
}  // namespace palpate::testing

#endif
