// The Falcon's driver against an emulated device, through the usual libusb. fault_matrix_test.cpp
// has the faults that happen while a hand is pushed, in the device's own time.

#include "falcon/falcon_device.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cmath>
#include <utility>

#include "devices/falcon_emulator.h"
#include "falcon/boot_table.h"
#include "palpate/devices/device.h"
#include "support/error_of.h"
#include "support/temp_file.h"
#ifdef PALPATE_LIBUSB
#include "devices/falcon_rig.h"
#include "usb/libusb_list.h"
#endif

namespace palpate::devices {
namespace {

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
    // Half a count for each arm: at most 0.1 mm, at the place where a count moves the grip
    // farthest.
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
    // 0.2 kg, 2 Ns/m: about F t^2 / 2 m in the first 30 ms. The direction is that of the force to a
    // few percent: a motor's command has steps of 1e-4 Nm, and the arms' pose is that of the last
    // reading.
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
  // Half a second up to the full force, in steps of at most one part in 500 plus a count of each
  // motor.
  for (std::size_t i = homed_at; i + 1 < 1400; ++i) {
    ASSERT_LE(length(i + 1), length(i) + length(1400) / 500.0 + 2.0) << i;
  }
  EXPECT_GT(length(1400), 100.0);
  EXPECT_EQ(rig.emulator.motors, (std::array<int, 3>{}));
  EXPECT_EQ(report.state, SafetyState::kActive);
}

/// Checks that the last force is zero, and that the kernel holds no transfer.
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
      // Reads are requested ahead, so the next reading reports it.
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
      // After some of the firmware was sent, a piece is lost, and no echo comes.
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
  constexpr int kAccess = -3;  // LIBUSB_ERROR_ACCESS, which an emulated descriptor cannot cause
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

/// Runs a loop, and lets `world` intervene at reply number `at` or at a step of the kernel.
struct FaultRun {
  ServoReport report;
  std::vector<double> forces;  ///< [N] written in each tick
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

#endif

}  // namespace
}  // namespace palpate::devices
