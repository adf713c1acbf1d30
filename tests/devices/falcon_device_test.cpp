// The Falcon's driver against a device that is not there, through the libusb that everybody uses.

#include "falcon/falcon_device.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <utility>

#include "devices/falcon_emulator.h"
#include "falcon/boot_table.h"
#include "folders/folders.h"
#include "palpate/devices/device.h"
#include "palpate/devices/path.h"
#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#include "support/wait.h"
#ifdef PALPATE_LIBUSB
#include "devices/falcon_rig.h"
#include "usb/libusb_list.h"
#endif

namespace palpate::devices {
namespace {

const std::atomic<bool> kNeverStop{false};
const Vec3 kPush(0.0, 0.0, 1.0);
Vec3 push(const DeviceState& /*state*/) { return kPush; }

TEST(FalconFirmware, ASoundImageIsTakenAndEveryCutOfItRefused) {
  const auto image = syntheticFirmware(200);
  const falcon::BootTable table = falcon::readBootTable(image, "image");
  EXPECT_EQ(table.entry, 0x3F8002U);
  EXPECT_EQ(table.blocks, 2);
  EXPECT_EQ(table.words, 200U);
  for (std::size_t size = 0; size < image.size(); ++size) {
    EXPECT_THROW((void)falcon::readBootTable(std::span(image).first(size), "image"), Error) << size;
  }
  auto longer = image;
  longer.push_back(0);
  EXPECT_THROW((void)falcon::readBootTable(longer, "image"), Error);
  auto other = image;
  other[0] = 0xAB;
  EXPECT_THROW((void)falcon::readBootTable(other, "image"), Error);
}

TEST(FalconCalibrationFile, IsReadAsItIsWrittenAndErrorsNameTheirLine) {
  FalconCalibration calibration;
  calibration.counts_per_torque = -3456.5;
  calibration.origin.z = 0.11;
  calibration.zero_angles.y = 0.6;
  const testing::TempFolder folder;
  const FalconCalibration read =
      readFalconCalibration(folder.file("calibration.txt", textOf(calibration)));
  EXPECT_EQ(read.counts_per_torque, -3456.5);
  EXPECT_EQ(read.origin, calibration.origin);
  EXPECT_EQ(read.zero_angles, calibration.zero_angles);
  EXPECT_EQ(textOf(read), textOf(calibration));
  for (const char* bad : {"max_force\n", "max_force 1 2\n", "max_force x\n", "max_force -1\n",
                          "max_force nan\n", "what 1\n"}) {
    const std::string broken = folder.file("calibration.txt", std::string("# none\n") + bad);
    try {
      (void)readFalconCalibration(broken);
      FAIL() << bad;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kInput);
      EXPECT_EQ(error.problem().line, 2) << bad;
    }
  }
}

#ifdef PALPATE_LIBUSB

TEST(FalconDevice, ReadsWhereTheGripIs) {
  Rig rig;
  rig.device.open();
  for (const Vec3& place :
       {Vec3(0.0, 0.0, 0.125), Vec3(0.02, -0.01, 0.11), Vec3(-0.03, 0.02, 0.14)}) {
    rig.emulator.place(place);
    rig.emulator.buttons = 5;
    DeviceState state;
    (void)rig.turn(state);
    ASSERT_EQ(rig.turn(state), DeviceStatus::kOk);
    ASSERT_EQ(rig.turn(state), DeviceStatus::kOk);
    // Half a count of each arm: at most 0.1 mm, where a count is worst.
    EXPECT_LT(glm::length(state.position - (place - Vec3(0.0, 0.0, 0.125))), 1e-4);
    EXPECT_EQ(state.buttons, 5U);
    EXPECT_TRUE(state.is_homed);
  }
  rig.device.close();
  EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  EXPECT_EQ(rig.usb.pending(), 0);
}

TEST(FalconDevice, AForceMovesTheGripItsWay) {
  for (const Vec3& force :
       {Vec3(2.0, 0.0, 0.0), Vec3(0.0, -2.0, 0.0), Vec3(0.0, 0.0, 2.0), Vec3(1.0, 1.0, -1.0)}) {
    Rig rig;
    rig.device.open();
    DeviceState state;
    (void)rig.turn(state);
    (void)rig.turn(state);
    const Vec3 begin = rig.emulator.position();
    for (int i = 0; i < 30; ++i) (void)rig.turn(state, force);
    const Vec3 way = rig.emulator.position() - begin;
    // 0.2 kg, 2 Ns/m: about F t^2 / 2 m in the first 30 ms. The direction is the force's to a few parts in a hundred: a motor's
    // command has 1e-4 Nm, and the arms are taken where they were.
    EXPECT_GT(glm::dot(way, force), 0.99 * glm::length(way) * glm::length(force));
    EXPECT_GT(glm::length(way), 1e-3);
  }
}

TEST(FalconDevice, AForceBeyondTheMotorsKeepsItsDirection) {
  Rig rig;
  rig.device.open();
  DeviceState state;
  (void)rig.turn(state);
  (void)rig.turn(state);
  rig.emulator.mass = 1e9;  // stays
  (void)rig.turn(state, Vec3(3.0, 1.0, -2.0));
  (void)rig.turn(state, Vec3(3.0, 1.0, -2.0));
  const auto small = rig.emulator.motors;
  (void)rig.turn(state, 1e4 * Vec3(3.0, 1.0, -2.0));
  (void)rig.turn(state, 1e4 * Vec3(3.0, 1.0, -2.0));
  const auto large = rig.emulator.motors;
  int most = 0;
  for (const int m : large) most = std::max(most, std::abs(m));
  EXPECT_EQ(most, 4096);
  std::size_t largest = 0;
  for (std::size_t i = 0; i < 3; ++i) {
    if (std::abs(small[i]) > std::abs(small[largest])) largest = i;
  }
  for (std::size_t i = 0; i < 3; ++i) {
    const double share = static_cast<double>(small[i]) / small[largest];
    // Both are rounded to a count.
    EXPECT_NEAR(large[i], share * large[largest], 1.0 + 4096.0 / std::abs(small[largest]));
  }
}

TEST(FalconDevice, LoadsItsFirmwareOnceAndOnlyIfItRunsNone) {
  Rig rig(syntheticFirmware());
  rig.emulator.has_firmware = false;
  rig.device.open();
  EXPECT_EQ(rig.emulator.loaded, syntheticFirmware().size());
  EXPECT_EQ(rig.emulator.latency, 1);
  rig.device.close();
  rig.device.open();
  EXPECT_EQ(rig.emulator.loaded, syntheticFirmware().size()) << "it lives until power is lost";
}

TEST(FalconDevice, WithoutFirmwareAndWithoutAnImageItSaysWhatToGive) {
  Rig rig;
  rig.emulator.has_firmware = false;
  try {
    rig.device.open();
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "falcon.firmware");
    EXPECT_NE(error.problem().hint.find("image"), std::string::npos);
  }
  EXPECT_EQ(rig.usb.pending(), 0);
}

TEST(FalconDevice, ALoopGivesNoForceUntilItIsHomedAndThenRamps) {
  Rig rig;
  rig.emulator.homed = 0;
  rig.emulator.mass = 1e9;
  std::vector<std::array<int, 3>> motors;
  std::uint64_t homed_at = 0;
  std::atomic<bool> stop{false};
  rig.emulator.damage = [&](std::vector<std::uint8_t>& /*reply*/) {
    motors.push_back(rig.emulator.motors);
    if (rig.emulator.commands == 300) {
      rig.emulator.homed = 7;
      homed_at = rig.emulator.commands;
    }
    if (rig.emulator.commands == 1500) stop = true;
  };
  const ServoReport report = runServo(rig.device, push, {}, stop);
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  for (std::size_t i = 0; i < homed_at; ++i) ASSERT_EQ(motors[i], (std::array<int, 3>{}));
  const auto length = [&](std::size_t i) {
    return std::hypot(motors[i][0], motors[i][1], motors[i][2]);
  };
  // Half a second to the full force, in steps of at most one part in 500 and a count of each motor.
  for (std::size_t i = homed_at; i + 1 < 1400; ++i) {
    ASSERT_LE(length(i + 1), length(i) + length(1400) / 500.0 + 2.0) << i;
  }
  EXPECT_GT(length(1400), 100.0);
  EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  EXPECT_EQ(report.state, SafetyState::kActive);
}

/// Zero force in the end, and nothing left with the kernel.
void expectLetGo(Rig& rig) {
  EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  EXPECT_EQ(rig.usb.pending(), 0);
}

TEST(FalconFaults, UnpluggedAtEveryStepOfOpenItSaysSoAndLeavesNothing) {
  int steps = 0;
  {
    Rig rig(syntheticFirmware(300));
    rig.emulator.has_firmware = false;
    rig.device.open();
    steps = rig.usb.steps();
  }
  ASSERT_GT(steps, 50);
  for (int at = 0; at < steps; ++at) {
    Rig rig(syntheticFirmware(300));
    rig.emulator.has_firmware = false;
    rig.usb.fault = [&, n = 0](UsbfsEmulation::Step) mutable { return n++ == at ? ENODEV : 0; };
    try {
      rig.device.open();
      // The last steps are asked ahead: the next reading knows.
      DeviceState state;
      EXPECT_EQ(rig.turn(state), DeviceStatus::kDisconnected) << at;
    } catch (const Error& error) {
      EXPECT_EQ(error.kind(), ErrorKind::kDevice);
      EXPECT_EQ(error.problem().code, "device.disconnected") << at << ": " << error.what();
    }
    rig.device.close();
    ASSERT_EQ(rig.usb.pending(), 0) << at;
  }
}

TEST(FalconFaults, FirmwareThatIsLostOnTheWayIsLoadedAgainAndInTheEndGivenUp) {
  for (const bool goes_on : {false, true}) {
    Rig rig(syntheticFirmware(300));
    rig.emulator.has_firmware = false;
    int lost = 0;
    rig.usb.fault = [&](UsbfsEmulation::Step step) {
      // Once some of it was sent, a piece is lost: no echo comes.
      const bool is_lost = step == UsbfsEmulation::Step::kReapOut && rig.emulator.loaded >= 200 &&
                           (goes_on || lost == 0);
      lost += is_lost ? 1 : 0;
      return is_lost ? EPROTO : 0;
    };
    if (!goes_on) {
      rig.device.open();
      EXPECT_GT(rig.emulator.loaded, syntheticFirmware(300).size()) << "in part twice";
      DeviceState state;
      EXPECT_EQ(rig.turn(state), DeviceStatus::kOk);
      continue;
    }
    EXPECT_EQ(errorOf([&] { rig.device.open(); }).problem().code, "device.usb");
    EXPECT_GE(lost, 3) << "a piece at each of three starts";
    EXPECT_EQ(rig.usb.pending(), 0);
  }
}

TEST(FalconFaults, ADeviceThatThisUserMayNotOpenNamesTheRemedy) {
  constexpr int kAccess = -3;  // LIBUSB_ERROR_ACCESS: no emulation of a descriptor leads there
  const Problem problem = usb::openError(kAccess, "open the device").problem();
  EXPECT_EQ(problem.code, "device.access");
  EXPECT_NE(problem.hint.find("udev"), std::string::npos);
}

TEST(FalconFaults, AClaimThatIsRefusedNamesTheRemedy) {
  for (const auto& [error, code] :
       {std::pair{EBUSY, "device.busy"}, std::pair{EACCES, "device.usb"}}) {
    Rig rig;
    rig.usb.fault = [error = error](UsbfsEmulation::Step step) {
      return step == UsbfsEmulation::Step::kClaim ? error : 0;
    };
    EXPECT_EQ(errorOf([&] { rig.device.open(); }).problem().code, code);
  }
}

/// Runs a loop, and lets `world` happen at reply number `at` or at a step of the kernel.
struct FaultRun {
  ServoReport report;
  std::vector<double> forces;  ///< [N] of each tick, as written
};

FaultRun runWith(Rig& rig, const std::function<void(Rig&)>& prepare, std::uint64_t most = 3000) {
  rig.emulator.mass = 1e9;
  FaultRun out;
  std::atomic<bool> stop{false};
  prepare(rig);
  std::uint64_t ticks = 0;
  const auto tick = [&](const DeviceState& /*state*/) {
    if (++ticks == most) stop = true;
    return kPush;
  };
  out.report = runServo(rig.device, tick, {}, stop, [&](const ServoTurn& turn) {
    out.forces.push_back(glm::length(turn.written));
  });
  return out;
}

TEST(FalconFaults, UnpluggedInTheMiddleOfATransferEndsTheLoop) {
  using Step = UsbfsEmulation::Step;
  // A hub that is reset ends the transfers under way.
  for (const auto& [step, error] :
       {std::pair{Step::kSubmitIn, ENODEV}, std::pair{Step::kSubmitOut, ENODEV},
        std::pair{Step::kReapIn, ENODEV}, std::pair{Step::kReapOut, ENODEV},
        std::pair{Step::kReapIn, ESHUTDOWN}, std::pair{Step::kReapOut, ESHUTDOWN}}) {
    Rig rig;
    const FaultRun run = runWith(rig, [step = step, error = error](Rig& r) {
      r.usb.fault = [step, error, n = 0](Step now) mutable {
        return now == step && ++n == 700 ? error : 0;
      };
    });
    EXPECT_EQ(run.report.exit, ServoExit::kDisconnected) << static_cast<int>(step);
    EXPECT_EQ(rig.usb.pending(), 0);
    // Plugged in again: the ramp begins at zero.
    Rig again;
    const FaultRun more = runWith(
        again, [](Rig&) {}, 600);
    ASSERT_GT(more.forces.size(), 500U);
    EXPECT_EQ(more.forces[0], 0.0);
    EXPECT_LT(more.forces[100], 0.25);
  }
}

TEST(FalconFaults, OneFailedTransferIsOnePacketLess) {
  for (const int error : {EPIPE, EOVERFLOW, EPROTO, ETIME}) {
    for (const auto step : {UsbfsEmulation::Step::kReapIn, UsbfsEmulation::Step::kReapOut}) {
      Rig rig;
      constexpr std::uint64_t kTicks = 700;
      const auto every_hundredth = [=](Rig& r) {
        r.usb.fault = [=, n = 0](UsbfsEmulation::Step now) mutable {
          return now == step && ++n % 100 == 0 ? error : 0;
        };
      };
      const FaultRun run = runWith(rig, every_hundredth, kTicks);
      EXPECT_EQ(run.report.exit, ServoExit::kStopped) << error;
      EXPECT_EQ(run.report.ticks, kTicks);
      expectLetGo(rig);
    }
  }
}

TEST(FalconFaults, TransfersThatGoOnFailingAreAFaultWithinAHundredMilliseconds) {
  for (const int error : {EPIPE, EOVERFLOW, EPROTO}) {
    Rig rig;
    std::int64_t since = 0;
    const FaultRun run = runWith(rig, [&](Rig& r) {
      r.usb.fault = [&, error, n = 0](UsbfsEmulation::Step now) mutable {
        if (now != UsbfsEmulation::Step::kReapIn || ++n < 1500) return 0;
        if (since == 0) since = r.emulator.now();
        return error;
      };
    });
    EXPECT_EQ(run.report.exit, ServoExit::kFault);
    EXPECT_EQ(run.report.fault, SafetyFault::kSilence);
    EXPECT_EQ(run.report.stale, 91U) << "zero from 10 ms to the fault at 100, a turn a millisecond";
    EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  }
}

TEST(FalconFaults, ShortPacketsAndGarbageAreDropped) {
  for (const int kind : {0, 1, 2}) {
    Rig rig;
    const FaultRun run = runWith(rig, [kind](Rig& r) {
      r.emulator.damage = [kind, n = 0](std::vector<std::uint8_t>& reply) mutable {
        if (++n % 100 != 0) return;
        if (kind == 0) reply.resize(14);
        if (kind == 1) reply.insert(reply.begin() + 5, {'>', '>', 0xFF, '<'});
        if (kind == 2) reply.clear();
      };
    });
    EXPECT_EQ(run.report.exit, ServoExit::kStopped);
    EXPECT_EQ(run.report.fault, SafetyFault::kNone);
    if (kind < 2) {
      EXPECT_GT(rig.device.dropped(), 100U);
    }
    expectLetGo(rig);
  }
}

TEST(FalconFaults, AnEncoderThatJumpsIsDroppedAndThreeJumpsAreAFault) {
  for (const int times : {1, 3}) {
    Rig rig;
    const FaultRun run = runWith(rig, [times](Rig& r) {
      r.emulator.damage = [times, n = 0](std::vector<std::uint8_t>& reply) mutable {
        ++n;
        if (n < 1000 || n >= 1000 + times) return;
        reply[3] = static_cast<std::uint8_t>('A' + (reply[3] - 'A' + 2) % 16);  // 512 counts
      };
    });
    EXPECT_EQ(run.report.exit, times == 1 ? ServoExit::kStopped : ServoExit::kFault);
    EXPECT_EQ(run.report.fault, times == 1 ? SafetyFault::kNone : SafetyFault::kJump);
    EXPECT_EQ(run.report.safety.jumps, static_cast<std::uint64_t>(times));
    expectLetGo(rig);
  }
}

TEST(FalconFaults, AnOriginThatIsLostIsAFault) {
  Rig rig;
  const FaultRun run = runWith(rig, [](Rig& r) {
    r.emulator.damage = [&r](std::vector<std::uint8_t>& /*reply*/) {
      if (r.emulator.commands == 1000) r.emulator.homed = 5;
    };
  });
  EXPECT_EQ(run.report.fault, SafetyFault::kHomingLost);
  expectLetGo(rig);
}

TEST(FalconFaults, ATickThatThrowsLeavesTheMotorsAtZero) {
  Rig rig;
  rig.emulator.mass = 1e9;
  int n = 0;
  const auto tick = [&](const DeviceState&) -> Vec3 {
    if (++n == 1000) throw std::runtime_error("broken tick");
    return kPush;
  };
  EXPECT_THROW((void)runServo(rig.device, tick, {}, kNeverStop), std::runtime_error);
  EXPECT_GT(rig.emulator.moving_commands, 500U);
  expectLetGo(rig);
}

TEST(FalconFaults, ForcesThatAreNotFiniteAreAFault) {
  Rig rig;
  rig.emulator.mass = 1e9;
  int n = 0;
  const auto tick = [&](const DeviceState&) { return ++n < 1000 ? kPush : Vec3(std::nan("")); };
  const ServoReport report = runServo(rig.device, tick, {}, kNeverStop);
  EXPECT_EQ(report.fault, SafetyFault::kNotFinite);
  EXPECT_EQ(report.zeroed, 3U);
  expectLetGo(rig);
}

TEST(FalconFaults, AThreadThatStandsStillIsCutByAnother) {
  Rig rig;
  rig.emulator.mass = 1e9;
  std::atomic<bool> stop{false};
  bool was_cut = false;
  int n = 0;
  const auto tick = [&](const DeviceState&) {
    // Stands still until the motors have let go; nobody but the second thread can do that.
    if (++n == 700) {
      const std::uint64_t before = rig.usb.outs();
      was_cut = testing::waitUntil([&] { return rig.usb.outs() != before; });
    }
    if (n == 701) stop = true;
    return kPush;
  };
  const ServoReport report = runServo(rig.device, tick, {.realtime = true}, stop);
  EXPECT_TRUE(was_cut);
  EXPECT_GE(report.safety.hangs, 1U);
  expectLetGo(rig);
}

/// [N/m] of a wall at which a mass neither comes to rest nor swings up: the exact discrete system, in which a force that is
/// computed from the reading at the end of one turn is held over the next, has a determinant of 1.
double limitOf(double mass, double damping) {
  constexpr double kPeriod = 1e-3;  // [s]
  const double e = std::exp(-damping * kPeriod / mass);
  const double place_by_speed = (1.0 - e) * mass / damping;
  const double place_by_force = (kPeriod - place_by_speed) / damping;
  const double speed_by_force = (1.0 - e) / damping;
  return (1.0 - e) / (place_by_speed * speed_by_force - e * place_by_force);
}

TEST(FalconDevice, AWallIsHeldWithoutAHiddenSample) {
  constexpr double kMass = 0.02;    // [kg]
  constexpr double kDamping = 0.2;  // [Ns/m]
  const double limit = limitOf(kMass, kDamping);
  // Another sample of delay would make it a third of that: b / (T / 2 + T).
  std::printf("growth changes sign at %.1f N/m; b / (T / 2): %.1f N/m\n", limit, kDamping / 0.5e-3);
  EXPECT_NEAR(limit, kDamping / 0.5e-3, 0.02 * limit);
  for (const double share : {0.98, 1.02}) {
    FalconCalibration calibration;
    calibration.radians_per_count =
        1e-5;  // so that the steps of the encoders do not hide the growth
    Rig rig({}, calibration);
    rig.emulator.radians_per_count = calibration.radians_per_count;
    rig.emulator.mass = kMass;
    rig.emulator.damping = kDamping;
    rig.device.open();
    rig.emulator.place(Vec3(0.0, 0.0, 0.130));
    DeviceState state;
    (void)rig.turn(state);
    rig.emulator.place(Vec3(0.0, 0.0, 0.130));
    double early = 0.0;
    double late = 0.0;
    for (int i = 0; i < 2000; ++i) {
      DeviceStatus status = DeviceStatus::kStale;
      for (int k = 0; k < 10 && status == DeviceStatus::kStale; ++k)
        status = rig.device.read(state);
      ASSERT_EQ(status, DeviceStatus::kOk) << i;
      (void)rig.device.write(-share * limit * state.position);
      const double size = std::abs(state.position.z);
      if (i >= 100 && i < 300) early = std::max(early, size);
      if (i >= 1800) late = std::max(late, size);
    }
    // About 0.1 / s.
    EXPECT_EQ(late > early, share > 1.0) << share << ": " << early << " then " << late << " m";
  }
}

/// [m] The largest swing about its mean of the grip, which a hand pushes steadily against a wall of `stiffness` [N/m]: early and
/// late, by scene, session, servo loop, driver and libusb. It is displaced by 2 mm once the push is there.
std::pair<double, double> swingAt(double stiffness, double mass, double damping) {
  SceneDescription scene = parseScene(
      "{palpate: 1, length: m, materials: {wall: {stiffness: " + std::to_string(stiffness) +
          " N/m}}, layers: [{name: wall, wall: wall, inside: {half_space: {point: [0, 0, 0], "
          "normal: [0, 0, 1]}}}]}",
      "wall");
  Session session(compile(std::move(scene)));
  FalconCalibration calibration;
  calibration.radians_per_count = 1e-5;  // so that the steps of the encoders do not hide the growth
  Rig rig({}, calibration);
  rig.emulator.radians_per_count = calibration.radians_per_count;
  rig.emulator.mass = mass;
  rig.emulator.damping = damping;
  rig.emulator.place(Vec3(0.0, 0.0, 0.125));
  // The push comes slowly, after the ramp of the force; it holds the grip 5 mm deep, so that it never leaves the wall.
  rig.emulator.hand = [&](const Vec3&) {
    const double t = 1e-9 * static_cast<double>(rig.emulator.now());
    return Vec3(0.0, 0.0, -5e-3 * stiffness * std::clamp(t - 1.0, 0.0, 1.0));
  };
  std::atomic<bool> stop{false};
  double early = 0.0;
  double late = 0.0;
  int n = 0;
  const auto tick = [&](const DeviceState& reading) {
    ++n;
    if (n == 3000) rig.emulator.place(rig.emulator.position() + Vec3(0.0, 0.0, 2e-3));
    const double swing = std::abs(reading.position.z + 5e-3);
    if (n >= 3100 && n < 3300) early = std::max(early, swing);
    if (n >= 4800) late = std::max(late, swing);
    if (n == 5000) stop = true;
    return session.step(reading, DeviceFrame::kDevice).force;
  };
  const ServoReport report = runServo(rig.device, tick, {}, stop);
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.fault, SafetyFault::kNone);
  EXPECT_GT(early, 1e-3);
  return {early, late};
}

TEST(FalconDevice, AWallOfASceneGrowsFromTheExactLimitOnThroughTheWholeChain) {
  constexpr double kMass = 0.02;    // [kg]
  constexpr double kDamping = 0.2;  // [Ns/m]
  const double limit = limitOf(kMass, kDamping);
  for (const double share : {0.98, 1.02}) {
    const auto [early, late] = swingAt(share * limit, kMass, kDamping);
    std::printf("  %.2f of %.1f N/m: a swing of %.3f mm becomes one of %.3f mm\n", share, limit,
                1e3 * early, 1e3 * late);
    EXPECT_EQ(late > early, share > 1.0) << share;
  }
}

TEST(FalconDevice, TheWholeChainInByTheMouthAlongTheWallAndOut) {
  // data/scenes/container.yaml, in the device's own space: 30 mm above the bowl's center, down to its bottom, and back.
  const ScenePtr scene = compile(readScene(test::sourceFolder() + "/data/scenes/container.yaml"));
  Session session(scene);
  Rig rig;
  rig.emulator.damping = 7.0;
  rig.emulator.place(Vec3(0.005, 0.0, 0.125 + 0.030));
  std::atomic<bool> stop{false};
  constexpr double kWay = 2.0;  // [s] down, and the same up
  rig.emulator.hand = [&](const Vec3& p) {
    const double t = 1e-9 * static_cast<double>(rig.emulator.now()) - 0.6;
    const double down = std::clamp(t < kWay ? t / kWay : 2.0 - t / kWay, 0.0, 1.0);
    const Vec3 target(0.005, 0.0, 0.125 + 0.030 - 0.090 * down);
    if (t > 2.0 * kWay + 0.2) stop = true;
    return 250.0 * (target - p);
  };
  Path path;
  std::vector<Vec3> asked;
  std::vector<SessionTick> felt;
  double most_inside = 0.0;
  double worst = 0.0;
  SessionTick now;
  const auto tick = [&](const DeviceState& reading) {
    now = session.step(reading, DeviceFrame::kDevice);
    path.push_back({reading.time, reading.position});
    asked.push_back(now.force);
    felt.push_back(now);
    if (scene->regions()[now.result.region].name == "liquid" && now.result.contact) {
      most_inside = std::max(most_inside, now.force.z);
    }
    return now.force;
  };
  const ServoReport report = runServo(rig.device, tick, {}, stop, [&](const ServoTurn& turn) {
    const double off = glm::length(rig.emulator.felt - turn.written);
    // Half a count of each motor is 0.5e-4 Nm, at 20 to 30 rad/m; and the arms are taken where the encoders say, which
    // turns a force by less than two parts in a thousand.
    const double allowed = 3e-3 + 2e-3 * glm::length(turn.written);
    worst = std::max(worst, off / allowed);
  });
  EXPECT_EQ(report.exit, ServoExit::kStopped);
  EXPECT_EQ(report.fault, SafetyFault::kNone);
  EXPECT_LE(worst, 1.0);
  EXPECT_GT(most_inside, 2.0) << "the bottom, from inside";
  std::vector<std::string> regions;
  for (const SessionTick& t : felt) {
    const std::string& name = scene->regions()[t.result.region].name;
    if (regions.empty() || regions.back() != name) regions.push_back(name);
  }
  EXPECT_EQ(regions, (std::vector<std::string>{"outside", "liquid", "outside"}));
  // The same hand by the virtual device: the same forces, bit for bit.
  Session again(scene);
  VirtualDevice device(path, DeviceFrame::kDevice);
  std::size_t at = 0;
  (void)again.run(device, kNeverStop, [&](const SessionTick& t, const HapticRenderer&) {
    ASSERT_EQ(t.force, asked[at]) << at;
    ++at;
  });
  EXPECT_EQ(at, asked.size());
  expectLetGo(rig);
}

#endif

}  // namespace
}  // namespace palpate::devices
