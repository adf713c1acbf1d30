// The effect of an input device's events on a position: closed forms, and random events against a
// separate model. The use of the kernel's interface is tested in tests/evdev.

#include "palpate/devices/evdev.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <map>
#include <random>
#include <vector>

#include "evdev/input_hand.h"
#include "evdev/input_map.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"

namespace palpate::devices::evdev {
namespace {

constexpr std::int64_t kSecond = 1'000'000'000;
constexpr std::int64_t kMilli = 1'000'000;
constexpr double kRounding = 1e-12;  // [m], [-] rounding of some thousand additions

Capabilities withKeys(std::initializer_list<int> keys) {
  Capabilities has;
  for (const int key : keys) has.keys.set(static_cast<std::size_t>(key));
  return has;
}

void addAxes(Capabilities& has, std::initializer_list<int> axes, int least, int most,
             int flat = 0) {
  for (const int axis : axes) {
    const auto at = static_cast<std::size_t>(axis);
    has.absolute.set(at);
    has.ranges[at].minimum = least;
    has.ranges[at].maximum = most;
    has.ranges[at].flat = flat;
  }
}

Capabilities spaceMouse() {
  Capabilities has = withKeys({BTN_0, BTN_1});
  for (const int axis : {REL_X, REL_Y, REL_Z, REL_RX, REL_RY, REL_RZ}) {
    has.relative.set(static_cast<std::size_t>(axis));
  }
  return has;
}

Capabilities olderSpaceMouse() {
  Capabilities has = withKeys({BTN_0, BTN_1});
  addAxes(has, {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ}, -350, 350);
  return has;
}

Capabilities gamepad() {
  Capabilities has = withKeys({BTN_SOUTH, BTN_EAST, BTN_START});
  addAxes(has, {ABS_X, ABS_Y, ABS_RX, ABS_RY}, -32768, 32767, 4096);
  addAxes(has, {ABS_Z, ABS_RZ}, 0, 255);
  addAxes(has, {ABS_HAT0X, ABS_HAT0Y}, -1, 1);
  return has;
}

Capabilities mouse() {
  Capabilities has = withKeys({BTN_LEFT, BTN_RIGHT, BTN_MIDDLE});
  for (const int axis : {REL_X, REL_Y, REL_WHEEL}) has.relative.set(static_cast<std::size_t>(axis));
  return has;
}

/// A hand whose time begins at 0; it takes one report at a time.
class Hand {
 public:
  struct Input {
    int type, code, value;
  };
  explicit Hand(const Capabilities& has, const EvdevSettings& settings = {})
      : hand_(*mapOf(has), settings, 0) {}
  bool report(std::int64_t at, const std::vector<Input>& inputs) {
    for (const Input& each : inputs) {
      EXPECT_FALSE(take(each.type, each.code, each.value, at));
    }
    return take(EV_SYN, SYN_REPORT, 0, at);
  }
  bool take(int type, int code, int value, std::int64_t at) {
    return hand_.take(static_cast<std::uint16_t>(type), static_cast<std::uint16_t>(code), value,
                      at);
  }
  InputHand* operator->() { return &hand_; }

 private:
  InputHand hand_;
};

void expectNear(const Vec3& a, const Vec3& b) { EXPECT_LE(glm::length(a - b), kRounding); }

TEST(InputMap, TellsDevicesByWhatTheyHave) {
  EXPECT_EQ(mapOf(spaceMouse())->kind, InputKind::kSpaceMouse);
  EXPECT_EQ(mapOf(olderSpaceMouse())->kind, InputKind::kSpaceMouse);
  EXPECT_EQ(mapOf(gamepad())->kind, InputKind::kGamepad);
  EXPECT_EQ(mapOf(mouse())->kind, InputKind::kMouse);
  EXPECT_EQ(mapOf(gamepad())->buttons,
            (std::vector<std::uint16_t>{BTN_SOUTH, BTN_EAST, BTN_START}));

  EXPECT_FALSE(mapOf(withKeys({KEY_A, KEY_ENTER})));  // a keyboard
  Capabilities touchpad = withKeys({BTN_LEFT, BTN_TOOL_FINGER, BTN_TOUCH});
  addAxes(touchpad, {ABS_X, ABS_Y}, 0, 1000);
  EXPECT_FALSE(mapOf(touchpad));
  Capabilities sensors;  // of a gamepad
  addAxes(sensors, {ABS_X, ABS_Y, ABS_Z, ABS_RX, ABS_RY, ABS_RZ}, -8192, 8192);
  EXPECT_FALSE(mapOf(sensors));
}

TEST(InputMap, ASpaceMouseMovesAndTurnsAboutTheFramesAxes) {
  // To the right, towards the hand, down: the same for both kinds of SpaceMouse.
  const std::vector<Vec3> directions = {Vec3(1, 0, 0), Vec3(0, 0, 1), Vec3(0, -1, 0)};
  for (const bool is_older : {false, true}) {
    const Capabilities has = is_older ? olderSpaceMouse() : spaceMouse();
    const int type = is_older ? EV_ABS : EV_REL;
    for (int axis = 0; axis < 3; ++axis) {
      Hand moved(has, {.max_speed = 0.2, .dead_zone = 0.0});
      moved.report(0, {{type, axis, 350}});
      moved->advance(20 * kMilli);
      expectNear(moved->position(), 0.004 * directions[static_cast<std::size_t>(axis)]);
      EXPECT_EQ(moved->orientation(), Mat3(1.0));

      Hand turned(has, {.max_turn = 10.0, .dead_zone = 0.0});
      turned.report(0, {{type, REL_RX + axis, 350}});
      turned->advance(40 * kMilli);
      EXPECT_EQ(turned->position(), Vec3(0.0));
      // The hand turned by 0.4 rad about u: u stays, and vectors perpendicular to it turn by the
      // right-hand rule.
      const Vec3 u = directions[static_cast<std::size_t>(axis)];
      const Vec3 across(u.y, u.z, u.x);
      expectNear(turned->orientation() * u, u);
      expectNear(turned->orientation() * across,
                 std::cos(0.4) * across + std::sin(0.4) * glm::cross(u, across));
    }
  }
}

TEST(InputHand, ADeflectionIsASpeedBeyondTheDeadZone) {
  struct Case {
    int value;
    double dead_zone, share;
  };
  // For a range of -350 to 350 the share of full speed grows from 0 at the edge of the dead zone to
  // 1 at the end.
  const std::vector<Case> cases = {{350, 0.1, 1.0},    {-350, 0.1, -1.0},     {35, 0.1, 0.0},
                                   {-35, 0.1, 0.0},    {0, 0.0, 0.0},         {7, 0.0, 0.02},
                                   {175, 0.2, 0.375},  {-280, 0.5, -0.6},     {700, 0.1, 1.0},
                                   {-9999, 0.1, -1.0}, {36, 0.1, 1.0 / 315.0}};
  for (const Case& each : cases) {
    Hand hand(olderSpaceMouse(), {.max_speed = 0.05, .dead_zone = each.dead_zone});
    hand.report(0, {{EV_ABS, ABS_X, each.value}});
    hand->advance(kSecond);
    expectNear(hand->position(), Vec3(0.05 * each.share, 0, 0));
  }
}

TEST(InputHand, TheKernelsFlatRangeCountsWhereItIsWider) {
  // The flat zone of 4096, over half of 65535 counts, is an eighth: at its edge nothing moves, at
  // the end the speed is full.
  Hand hand(gamepad(), {.max_speed = 0.05, .dead_zone = 0.01});
  hand.report(0, {{EV_ABS, ABS_X, 4095}});
  hand->advance(kSecond);
  EXPECT_EQ(hand->position(), Vec3(0.0));
  hand.report(kSecond, {{EV_ABS, ABS_X, 32767}});
  hand->advance(2 * kSecond);
  expectNear(hand->position(), Vec3(0.05, 0, 0));
}

TEST(InputHand, AGamepadsTriggersLiftAndLowerAndRestAtTheirLeastValue) {
  Hand hand(gamepad(), {.max_speed = 0.05, .dead_zone = 0.0});
  for (const int trigger : {ABS_Z, ABS_RZ}) {
    hand->setAxis(static_cast<std::uint16_t>(trigger), 0);  // as the kernel reports it at open
  }
  hand.report(0, {{EV_ABS, ABS_RZ, 255}});
  hand.report(kSecond, {{EV_ABS, ABS_RZ, 0}, {EV_ABS, ABS_Z, 51}});
  hand->advance(2 * kSecond);
  expectNear(hand->position(), Vec3(0, 0.04, 0));
}

TEST(InputHand, OppositeInputsDoNotGoFasterThanOne) {
  Hand hand(gamepad(), {.max_speed = 0.05, .dead_zone = 0.0});
  hand.report(0, {{EV_ABS, ABS_RZ, 255}, {EV_ABS, ABS_RY, -32768}});
  hand->advance(kSecond);
  expectNear(hand->position(), Vec3(0, 0.05, 0));
}

TEST(InputHand, ARelativeAxisThatIsSilentIsAtRest) {
  Hand hand(spaceMouse(), {.max_speed = 0.1, .dead_zone = 0.0});
  hand.report(0, {{EV_REL, REL_X, 350}, {EV_REL, REL_RX, 350}});
  // The kernel leaves axes that are 0 out of a report.
  hand.report(10 * kMilli, {{EV_REL, REL_Y, 350}});
  hand->advance(5 * kSecond);
  expectNear(hand->position(), Vec3(0.001, 0, 0.1e-9 * InputHand::kHold));
  // The rotation had its own report, and no later report has ended it.
  expectNear(hand->orientation() * Vec3(0, 1, 0),
             Vec3(0, std::cos(1e-9 * InputHand::kHold), std::sin(1e-9 * InputHand::kHold)));
}

TEST(InputHand, AMouseGoesAsFarAsItsCounts) {
  Hand hand(mouse(), {.meters_per_count = 1e-5, .meters_per_notch = 2e-3});
  hand.report(0, {{EV_REL, REL_X, 100}, {EV_REL, REL_Y, -40}});
  hand.report(kMilli, {{EV_REL, REL_X, 20}, {EV_REL, REL_WHEEL, 3}, {EV_REL, REL_HWHEEL, 9}});
  hand->advance(kSecond);
  expectNear(hand->position(), Vec3(1.2e-3, 6e-3, -4e-4));
}

TEST(InputHand, ThePositionBeginsInTheMiddleOfItsWorkspaceAndNeverLeavesIt) {
  EvdevSettings settings{.max_speed = 1.0, .dead_zone = 0.0};
  settings.workspace = {Vec3(0.0, -0.02, 0.0), Vec3(0.01, 0.02, 0.03)};
  Hand hand(olderSpaceMouse(), settings);
  expectNear(hand->position(), Vec3(0.005, 0.0, 0.015));
  hand.report(0, {{EV_ABS, ABS_X, 350}});
  hand->advance(kSecond);
  EXPECT_EQ(hand->position().x, 0.01);
  // When the stick is reversed, the position leaves the workspace's border at once.
  hand.report(kSecond, {{EV_ABS, ABS_X, -350}});
  hand->advance(kSecond + 5 * kMilli);
  expectNear(hand->position(), Vec3(0.005, 0.0, 0.015));
}

TEST(InputHand, NothingCountsBeforeItsReportAndTimesNeverGoBack) {
  Hand hand(olderSpaceMouse(), {.max_speed = 0.1, .dead_zone = 0.0});
  EXPECT_FALSE(hand.take(EV_ABS, ABS_X, 350, 0));
  EXPECT_FALSE(hand.take(EV_KEY, BTN_0, 1, 0));
  hand->advance(kSecond);
  EXPECT_EQ(hand->position(), Vec3(0.0));
  EXPECT_EQ(hand->buttons(), 0U);
  // An event with a time in the past counts from now on.
  (void)hand.take(EV_SYN, SYN_REPORT, 0, kMilli);
  EXPECT_EQ(hand->buttons(), 1U);
  hand->advance(kSecond + 100 * kMilli);
  hand->advance(kSecond);
  expectNear(hand->position(), Vec3(0.01, 0, 0));
}

TEST(InputHand, ButtonsAreBitsInTheOrderOfTheirCodes) {
  Hand hand(gamepad());
  hand.report(0, {{EV_KEY, BTN_START, 1}, {EV_KEY, BTN_EAST, 1}, {EV_KEY, KEY_A, 1}});
  EXPECT_EQ(hand->buttons(), 6U);
  hand.report(0, {{EV_KEY, BTN_EAST, 0}, {EV_KEY, BTN_SOUTH, 1}});
  EXPECT_EQ(hand->buttons(), 5U);
}

TEST(InputHand, AfterLostEventsTheDeviceIsAskedAndWhatWasHalfToldIsForgotten) {
  Hand hand(gamepad(), {.max_speed = 0.1, .dead_zone = 0.2});
  hand.report(0, {{EV_ABS, ABS_X, 32767}, {EV_KEY, BTN_SOUTH, 1}});
  (void)hand.take(EV_ABS, ABS_Y, 32767, 100 * kMilli);
  (void)hand.take(EV_SYN, SYN_DROPPED, 0, 100 * kMilli);
  (void)hand.take(EV_KEY, BTN_EAST, 1, 150 * kMilli);
  EXPECT_TRUE(hand.take(EV_SYN, SYN_REPORT, 0, 200 * kMilli));
  EXPECT_EQ(hand->buttons(), 1U);
  hand->setKeys(withKeys({BTN_START}).keys);
  hand->setAxis(ABS_X, 0);
  hand->setAxis(ABS_RY, 32767);
  EXPECT_EQ(hand->buttons(), 4U);
  hand->advance(300 * kMilli);
  expectNear(hand->position(), Vec3(0.02, -0.01, 0.0));
  // From here on events count again.
  EXPECT_FALSE(hand.report(300 * kMilli, {{EV_KEY, BTN_SOUTH, 1}}));
  EXPECT_EQ(hand->buttons(), 5U);
}

TEST(InputHand, AfterLostEventsARelativeAxisIsAtRestUntilItIsToldAgain) {
  Hand hand(spaceMouse(), {.max_speed = 0.1, .dead_zone = 0.0});
  hand.report(0, {{EV_REL, REL_X, 350}});
  (void)hand.take(EV_SYN, SYN_DROPPED, 0, 0);
  EXPECT_TRUE(hand.take(EV_SYN, SYN_REPORT, 0, 10 * kMilli));
  hand->advance(30 * kMilli);
  expectNear(hand->position(), Vec3(0.001, 0, 0));
}

/// Adds up the effect of each axis of a gamepad, report by report, from a list of all events.
class GamepadModel {
 public:
  explicit GamepadModel(const EvdevSettings& settings) : settings_(settings) {}
  void go(std::int64_t to) {
    const double way = settings_.max_speed * 1e-9 * static_cast<double>(to - time_);
    const double x = stick(values_[ABS_X]);
    const double z = stick(values_[ABS_Y]);
    const double y = -stick(values_[ABS_RY]) + trigger(values_[ABS_RZ]) - trigger(values_[ABS_Z]);
    const Vec3 speed(x, std::min(1.0, std::max(-1.0, y)), z);
    for (int i = 0; i < 3; ++i) {
      at_[i] = std::min(settings_.workspace.hi[i],
                        std::max(settings_.workspace.lo[i], at_[i] + way * speed[i]));
    }
    time_ = to;
  }
  void set(int code, int value) { values_[code] = value; }
  [[nodiscard]] const Vec3& at() const { return at_; }

 private:
  /// Piecewise linear: 0 up to the edge of the dead zone, then up to 1.
  [[nodiscard]] static double ramp(double counts, double edge, double full) {
    if (counts <= edge) return 0.0;
    return counts >= full ? 1.0 : (counts - edge) / (full - edge);
  }
  [[nodiscard]] double stick(int value) const {
    const double from_middle = value + 0.5;
    const double edge = std::max(settings_.dead_zone * 32767.5, 4096.0);
    return ramp(from_middle, edge, 32767.5) - ramp(-from_middle, edge, 32767.5);
  }
  [[nodiscard]] double trigger(int value) const {
    return ramp(value, settings_.dead_zone * 255.0, 255.0);
  }

  EvdevSettings settings_;
  std::map<int, int> values_;
  std::int64_t time_ = 0;
  Vec3 at_{0.0, 0.0, 0.0};
};

TEST(InputHand, RandomEventsOfAGamepadGoWhereAModelSays) {
  const unsigned seed = 20210921;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  const auto number = [&](int least, int most) {
    return std::uniform_int_distribution<int>(least, most)(random);
  };
  for (int round = 0; round < 200; ++round) {
    EvdevSettings settings{.max_speed = 0.02 * number(0, 10), .dead_zone = 0.05 * number(0, 19)};
    settings.workspace = {Vec3(-0.01 * number(1, 9)), Vec3(0.01)};
    const double middle = settings.workspace.center().x;
    settings.workspace = {settings.workspace.lo - Vec3(middle),
                          settings.workspace.hi - Vec3(middle)};
    Hand hand(gamepad(), settings);
    GamepadModel model(settings);
    std::map<int, int> pending;
    std::int64_t time = 0;
    for (const int code : {ABS_Z, ABS_RZ}) hand->setAxis(static_cast<std::uint16_t>(code), 0);
    for (int event = 0; event < 300; ++event) {
      time += number(0, 3) * number(0, 5'000'000);
      switch (number(0, 4)) {
        case 0:  // the loop reads
          hand->advance(time);
          model.go(time);
          break;
        case 1:
          EXPECT_FALSE(hand.take(EV_SYN, SYN_REPORT, 0, time));
          model.go(time);
          for (const auto& [code, value] : pending) model.set(code, value);
          pending.clear();
          break;
        case 2: {
          const int code = number(0, 1) == 0 ? ABS_Z : ABS_RZ;
          pending[code] = number(0, 255);
          EXPECT_FALSE(hand.take(EV_ABS, code, pending[code], time));
          break;
        }
        default: {
          constexpr std::array<int, 4> kCodes = {ABS_X, ABS_Y, ABS_RX, ABS_RY};
          const int code = kCodes[static_cast<std::size_t>(number(0, 3))];
          pending[code] = number(-32768, 32767);
          EXPECT_FALSE(hand.take(EV_ABS, code, pending[code], time));
        }
      }
      ASSERT_LE(glm::length(hand->position() - model.at()), kRounding)
          << "round " << round << ", event " << event;
      ASSERT_TRUE(settings.workspace.contains(hand->position()));
      // The orientation is still a rotation: its rows are unit vectors at right angles.
      const Mat3 square = hand->orientation() * glm::transpose(hand->orientation());
      for (int i = 0; i < 3; ++i) ASSERT_LE(glm::length(square[i] - Mat3(1.0)[i]), kRounding);
    }
  }
}

TEST(InputHand, AnyEventsAtAllLeaveItFiniteInItsWorkspaceAndAllocateNothing) {
  const unsigned seed = 7;
  SCOPED_TRACE("seed " + std::to_string(seed));
  std::mt19937 random(seed);
  for (const Capabilities& has : {spaceMouse(), olderSpaceMouse(), gamepad(), mouse()}) {
    EvdevSettings settings;
    InputHand hand(*mapOf(has), settings, 0);
    const testing::AllocGuard guard;
    bool is_sound = true;
    std::int64_t time = 0;
    for (int i = 0; i < 50'000; ++i) {
      time += static_cast<std::int64_t>(random() % 4'000'000U) - 1'000'000;
      const auto type = static_cast<std::uint16_t>(random() % 5U);
      const auto code =
          static_cast<std::uint16_t>(type == EV_KEY ? BTN_MISC + random() % 80U : random() % 12U);
      if (hand.take(type, code, static_cast<std::int32_t>(random()), time)) {
        hand.setAxis(ABS_X, static_cast<std::int32_t>(random()));
      }
      hand.advance(time);
      is_sound = is_sound && settings.workspace.contains(hand.position());
    }
    EXPECT_TRUE(is_sound);
    EXPECT_EQ(guard.violations(), 0);
  }
}

TEST(Evdev, SettingsThatAreOutOfRangeAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const std::vector<EvdevSettings> all = {
      {.max_speed = -1.0},         {.max_speed = nan},
      {.max_turn = kInfinity},     {.dead_zone = 1.0},
      {.dead_zone = nan},          {.dead_zone = -0.1},
      {.meters_per_count = -1e-6}, {.meters_per_notch = nan},
      {.workspace = Box3{}},       {.workspace = Box3::everything()}};
  for (const EvdevSettings& settings : all) {
    EXPECT_EQ(errorOf([&] { (void)makeEvdev(settings); }).kind(), ErrorKind::kUsage);
  }
}

TEST(Evdev, ANodeThatIsNotThereOrIsNoneIsADeviceErrorWithARemedy) {
  for (const char* node : {"/dev/input/no_such_event", "/dev/null"}) {
    const auto device = makeEvdev({.node = node});
    const Error error = errorOf([&] { device->open(); });
    EXPECT_EQ(error.kind(), ErrorKind::kDevice);
    EXPECT_FALSE(error.problem().hint.empty());
    DeviceState state;
    EXPECT_EQ(device->read(state), DeviceStatus::kDisconnected);
    EXPECT_EQ(device->write(Vec3(1.0)), DeviceStatus::kDisconnected);
  }
}

}  // namespace
}  // namespace palpate::devices::evdev
