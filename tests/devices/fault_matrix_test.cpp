// Faults while a Falcon, behind the usual libusb, pushes a hand, in the device's own
// time: each leads to its state, its text, and zero force in time; plugged in again, the device is
// homed and ramped. Faults of opening are in falcon_device_test.cpp, of a record in
// replay_device_test.cpp and tools/touch_record_test.cpp, of signals in
// tools/falcon_chain_test.cpp, of access in usb/falcon_node_test.cpp.

#ifdef PALPATE_LIBUSB

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <stdexcept>

#include "devices/falcon_rig.h"
#include "devices/virtual_clock.h"
#include "palpate/devices/device.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

using Step = UsbfsEmulation::Step;
using Reply = std::vector<std::uint8_t>;

constexpr std::int64_t kMillisecond = 1'000'000;  // [ns]
constexpr std::uint64_t kBegins = 1000;  // the command at which the fault begins, after the ramp
const Vec3 kPush(0.0, 0.0, 1.0);         // [N]

/// One case: the fault, and the device's behavior.
struct World {
  VirtualClock clock;
  std::function<int(Step)> kernel;    ///< errno of a step of libusb's, from kBegins on
  std::function<void(Reply&)> reply;  ///< damages a reply, from kBegins on
  std::function<Vec3()> tick;         ///< [N] used instead of kPush, from kBegins on
  std::atomic<bool> stop{false};
  std::int64_t since = -1;    ///< [ns] when the fault began
  std::int64_t zero_at = -1;  ///< [ns] the first command of zero force after that; negative: none
  bool is_over = false;       ///< further commands belong to closing

  explicit World(Rig& rig) : clock(rig.emulator) {}
};

struct Fault {
  const char* name;
  std::function<void(World&, Rig&)> prepare;
  ServoExit exit;
  SafetyState state;
  SafetyFault why;
  const char* text;
  /// [ms] of its time until its motors are zero; negative: no command reaches it any more
  double zero_within;
};

std::ostream& operator<<(std::ostream& out, const Fault& fault) { return out << fault.name; }

/// A lasting fault of the kernel.
std::function<void(World&, Rig&)> failing(Step at, int error) {
  return
      [=](World& world, Rig&) { world.kernel = [=](Step step) { return step == at ? error : 0; }; };
}

/// Damages each reply.
std::function<void(World&, Rig&)> replying(std::function<void(Reply&)> damage) {
  return [damage = std::move(damage)](World& world, Rig&) { world.reply = damage; };
}

/// Damages the first `times` replies.
std::function<void(World&, Rig&)> replying(int times, const std::function<void(Reply&)>& damage) {
  return replying([times, damage, n = 0](Reply& reply) mutable {
    if (n++ < times) damage(reply);
  });
}

void jump(Reply& reply) { reply[3] = static_cast<std::uint8_t>('A' + (reply[3] - 'A' + 2) % 16); }
void loseOrigin(Reply& reply) { reply[13] = static_cast<std::uint8_t>('A' + 16 * 5); }

/// The loop hangs for this long [ms], and until the motors were released.
std::function<void(World&, Rig&)> hanging(int duration) {
  return [=](World& world, Rig& rig) {
    world.tick = [&world, &rig, duration, has_hung = false]() mutable {
      if (has_hung) return kPush;
      has_hung = true;
      world.since = rig.emulator.now();
      const std::uint64_t before = rig.usb.outs();
      // Slightly more than the 20 ms; the rest passes after the other thread has acted.
      rig.emulator.pass(21 * kMillisecond);
      EXPECT_TRUE(testing::waitUntil([&] { return rig.usb.outs() != before; }));
      rig.emulator.pass((duration - 21) * kMillisecond);
      return kPush;
    };
  };
}

constexpr auto kEnded = ServoExit::kFault;
constexpr auto kFaulty = SafetyState::kFault;
constexpr const char* kGoneText = "the device reported a fault";
constexpr const char* kSilentText = "the device gave no valid reply for too long";
constexpr const char* kNothing = "no fault";

// Zero force comes with the next command, 1 ms. In silence it comes after 10 ms plus the wait of
// the present reading, at most four packets of 1 ms each; and the command takes 1 ms.
constexpr double kNext = 1.0;
constexpr double kSilence = 10.0 + 4.0 + 1.0;
// The watching thread cuts the force 20 ms after the last turn, which was up to 1 ms earlier.
constexpr double kHang = 20.0 + 1.0 + 1.0;
constexpr double kNever = -1.0;

std::vector<Fault> faults() {
  const auto gone = [](const char* name, Step step, int error) {
    return Fault{name,    failing(step, error), ServoExit::kDisconnected,
                 kFaulty, SafetyFault::kDevice, kGoneText,
                 kNever};
  };
  const auto silent = [](const char* name, std::function<void(World&, Rig&)> prepare,
                         double within = kSilence) {
    return Fault{name,  std::move(prepare), kEnded, kFaulty, SafetyFault::kSilence, kSilentText,
                 within};
  };
  const auto goes_on = [](const char* name, std::function<void(World&, Rig&)> prepare,
                          double within) {
    return Fault{name,
                 std::move(prepare),
                 ServoExit::kStopped,
                 SafetyState::kActive,
                 SafetyFault::kNone,
                 kNothing,
                 within};
  };
  const auto nothing = [](Reply& reply) { reply.clear(); };
  return {
      gone("UnpluggedWhileAskingForAReply", Step::kSubmitIn, ENODEV),
      gone("UnpluggedWhileSendingACommand", Step::kSubmitOut, ENODEV),
      gone("UnpluggedInTheMiddleOfAReply", Step::kReapIn, ENODEV),
      gone("UnpluggedInTheMiddleOfACommand", Step::kReapOut, ENODEV),
      gone("HubResetInTheMiddleOfAReply", Step::kReapIn, ESHUTDOWN),
      gone("HubResetInTheMiddleOfACommand", Step::kReapOut, ESHUTDOWN),
      silent("RepliesStall", failing(Step::kReapIn, EPIPE)),
      silent("CommandsStall", failing(Step::kReapOut, EPIPE), kNever),
      silent("RepliesOverflow", failing(Step::kReapIn, EOVERFLOW)),
      silent("RepliesBreakTheProtocol", failing(Step::kReapIn, EPROTO)),
      silent("RepliesTimeOut", failing(Step::kReapIn, ETIME)),
      silent("RepliesAreShort", replying([](Reply& reply) { reply.resize(14); })),
      silent("RepliesAreGarbage", replying([](Reply& reply) { reply.assign(16, 0xEE); })),
      silent("RepliesLackTheirEnd", replying([](Reply& reply) { reply.back() = 'A'; })),
      silent("NoReplies", replying(nothing)),
      goes_on("NoRepliesForAWhile", replying(4, nothing), kSilence),
      silent(
          "TheClockJumpsAheadInSilence",
          [](World& world, Rig& rig) {
            world.reply = [&rig, n = 0](Reply& reply) mutable {
              if (n++ > 0) return;
              reply.clear();
              rig.emulator.pass(1000 * kMillisecond);
            };
          },
          1000.0 + kSilence),
      {"ReadingsJump", replying(jump), kEnded, kFaulty, SafetyFault::kJump,
       "the device reported jumps that no hand can make", 3.0 + kNext},
      {"TheHandIsTooFast",
       [](World& world, Rig& rig) {
         world.reply = [&rig, n = 0](Reply&) mutable {
           // 2.5 m/s over 80 mm; it counts as too fast when the filter of 10 ms has reached 2 m/s,
           // after 16 ms.
           rig.emulator.place(Vec3(0.0, 0.0, 0.085 + 2.5e-3 * std::min(n++, 32)));
         };
         rig.emulator.place(Vec3(0.0, 0.0, 0.085));
       },
       kEnded, kFaulty, SafetyFault::kSpeed, "the hand was faster than is safe", 18.0 + kNext},
      {"TheOriginIsLost", replying(loseOrigin), kEnded, kFaulty, SafetyFault::kHomingLost,
       "the device lost its origin", kNext + 1.0},
      {"ForcesAreNotFinite",
       [](World& world, Rig&) { world.tick = [] { return Vec3(std::nan("")); }; }, kEnded, kFaulty,
       SafetyFault::kNotFinite, "readings or forces were not finite, one after the other",
       kNext + 1.0},
      goes_on(
          "OneForceIsNotFinite",
          [](World& world, Rig&) {
            world.tick = [n = 0]() mutable { return n++ == 0 ? Vec3(0.0, kInfinity, 0.0) : kPush; };
          },
          kNext + 1.0),
      goes_on("TheLoopHangsForAWhile", hanging(40), kHang),
      {"TheLoopHangs", hanging(150), kEnded, kFaulty, SafetyFault::kHung,
       "the servo loop stood still for too long", kHang},
      {"ItIsStopped",
       [](World& world, Rig&) {
         world.tick = [&world] {
           world.stop = true;
           return kPush;
         };
       },
       ServoExit::kStopped, SafetyState::kActive, SafetyFault::kNone, kNothing, 2.0 + kNext},
  };
}

class FaultMatrix : public ::testing::TestWithParam<Fault> {};

/// Between two runs the device lost its origin: no force until it is homed, and then a ramp of half
/// a second.
void expectHomingAndARamp(Rig& rig) {
  const VirtualClock clock(rig.emulator);
  rig.usb.plugIn();
  rig.usb.fault = nullptr;
  rig.emulator.homed = 0;
  std::vector<double> sizes;  // [counts]
  std::atomic<bool> stop{false};
  constexpr std::size_t kHomed = 200;
  rig.emulator.damage = [&](Reply&) {
    const auto& m = rig.emulator.motors;
    sizes.push_back(std::hypot(m[0], m[1], m[2]));
    if (sizes.size() == kHomed) rig.emulator.homed = 7;
    if (sizes.size() == 900) stop = true;
  };
  const ServoReport report = runServo(
      rig.device, [](const DeviceState&) { return kPush; }, {.realtime = true}, stop);
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.state, SafetyState::kActive);
  ASSERT_GE(sizes.size(), 900U);
  for (std::size_t i = 0; i <= kHomed; ++i) ASSERT_EQ(sizes[i], 0.0) << i;
  for (std::size_t i = kHomed; i < 900; ++i) {
    // Each motor is rounded to a count, and a turn takes slightly more than a millisecond.
    const double share = std::min(1.0, static_cast<double>(i - kHomed) / 490.0);
    ASSERT_LE(sizes[i], share * sizes[899] + 2.0) << i;
  }
  EXPECT_GT(sizes[899], 50.0);
}

TEST_P(FaultMatrix, LeadsToItsStateItsTextAndZeroForceInTime) {
  const Fault& fault = GetParam();
  Rig rig;
  rig.emulator.mass = 1e9;
  {
    World world(rig);
    fault.prepare(world, rig);
    const auto is_on = [&] { return rig.emulator.commands >= kBegins; };
    rig.usb.fault = [&](Step step) {
      if (!is_on() || !world.kernel || world.is_over) return 0;
      const int error = world.kernel(step);
      if (error != 0 && world.since < 0) world.since = rig.emulator.now();
      return error;
    };
    rig.emulator.damage = [&](Reply& reply) {
      const std::int64_t now = rig.emulator.now();
      if (world.since >= 0 && world.zero_at < 0 && rig.emulator.motors == std::array<int, 3>{}) {
        world.zero_at = now;
      }
      if (!is_on() || !world.reply || world.is_over) return;
      if (world.since < 0) world.since = now;
      world.reply(reply);
    };
    std::uint64_t ticks = 0;
    const auto tick = [&](const DeviceState&) {
      if (++ticks == 3 * kBegins) world.stop = true;
      if (!is_on() || !world.tick) return kPush;
      if (world.since < 0) world.since = rig.emulator.now();
      return world.tick();
    };
    const ServoReport report = runServo(rig.device, tick, {.realtime = true}, world.stop);
    world.is_over = true;
    EXPECT_EQ(report.exit, fault.exit);
    EXPECT_EQ(report.state, fault.state);
    EXPECT_EQ(report.fault, fault.why);
    EXPECT_EQ(textOf(report.fault), fault.text);
    EXPECT_EQ(rig.usb.pending(), 0) << "transfers that the kernel still holds";
    ASSERT_GE(world.since, 0);
    const double over = 1e-6 * static_cast<double>(rig.emulator.now() - world.since);
    if (fault.zero_within >= 0.0) {
      ASSERT_GE(world.zero_at, 0) << "never let go";
      const double after = 1e-6 * static_cast<double>(world.zero_at - world.since);
      std::printf("  %-32s zero after %.1f ms of %.1f: %s\n", fault.name, after, fault.zero_within,
                  fault.text);
      EXPECT_LE(after, fault.zero_within);
      EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
    } else {
      std::printf("  %-32s the loop ended after %.1f ms: %s\n", fault.name, over, fault.text);
      // The loop ends at once; or when the next command is sent, which waits for two readings of up
      // to 4 ms; or after the silence limit.
      EXPECT_LE(over, fault.why == SafetyFault::kDevice ? 2.0 * 4.0 + 2.0 : 100.0 + 10.0);
    }
  }
  expectHomingAndARamp(rig);
}

INSTANTIATE_TEST_SUITE_P(Falcon, FaultMatrix, ::testing::ValuesIn(faults()),
                         [](const auto& each) { return std::string(each.param.name); });

TEST(FalconFaultInTime, ATickThatThrowsLeavesZeroForceByTheNextCommand) {
  Rig rig;
  rig.emulator.mass = 1e9;
  const VirtualClock clock(rig.emulator);
  const std::atomic<bool> never{false};
  std::int64_t since = -1;
  std::int64_t zero_at = -1;
  rig.emulator.damage = [&](Reply&) {
    if (since >= 0 && zero_at < 0 && rig.emulator.motors == std::array<int, 3>{}) {
      zero_at = rig.emulator.now();
    }
  };
  const auto tick = [&](const DeviceState&) -> Vec3 {
    if (rig.emulator.commands < kBegins) return kPush;
    since = rig.emulator.now();
    throw std::runtime_error("broken tick");
  };
  EXPECT_THROW((void)runServo(rig.device, tick, {.realtime = true}, never), std::runtime_error);
  ASSERT_GE(zero_at, 0);
  EXPECT_LE(zero_at - since, kMillisecond);
  EXPECT_EQ(rig.usb.pending(), 0);
}

}  // namespace
}  // namespace palpate::devices

#endif
