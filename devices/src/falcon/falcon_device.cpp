#include "falcon/falcon_device.h"

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include "falcon/boot_table.h"
#include "servo_clock.h"
#include "usb/ftdi.h"

namespace palpate::devices::falcon {
namespace {

using usb::Status;
namespace ftdi = usb::ftdi;

constexpr int kStarts = 3;          // attempts at the whole of open()
constexpr int kHellos = 100;        // calls to the boot loader
constexpr int kPolls = 20;          // packets that an answer at set-up may take
constexpr int kSetUpWait = 20;      // [ms] wait for each of them
constexpr int kReads = 4;           // packets that one reading may take
constexpr int kReadWait = 1;        // [ms] wait for each of them: the chip's latency timer
constexpr int kPatience = 2;        // readings without a reply before the command is repeated
constexpr std::size_t kChunk = 62;  // [bytes] of firmware between two checks of its echo
constexpr int kZeros = 3;           // zero commands at the end, since one may be lost

const Packet kIdle = encode({});

}  // namespace

FalconDevice::FalconDevice(usb::Opener opener, std::vector<std::uint8_t> firmware,
                           const FalconCalibration& calibration, Clock clock)
    : opener_(std::move(opener)),
      firmware_(std::move(firmware)),
      calibration_(calibration),
      clock_(std::move(clock)) {
  constexpr double kReach = 0.05;  // [m] usable part of the workspace, from the origin
  info_.name = "Novint Falcon";
  info_.max_force = calibration.max_force;
  info_.workspace = {Vec3(-kReach), Vec3(kReach)};
  info_.buttons = 4;
  info_.is_clock = true;
  info_.limits = handLimits();
  info_.limits.continuous_force = calibration.continuous_force;
}

FalconDevice::~FalconDevice() { close(); }

void FalconDevice::need(Status status, const char* step) {
  if (status != Status::kOk) throw usb::failure(step, status);
}

void FalconDevice::open() {
  close();
  for (int attempt = 1; !transport_; ++attempt) {
    try {
      start();
    } catch (const Error& error) {
      transport_.reset();
      // Loading the firmware is known to fail now and then, so try again; a device that is absent
      // or without permission stays so.
      const std::string& code = error.problem().code;
      const bool may_help = code == "falcon.boot" || code == "device.usb";
      if (!may_help || attempt == kStarts) throw;
    }
  }
  opened_at_ = clock_();
}

void FalconDevice::start() {
  transport_ = opener_();
  parser_ = Parser();
  is_homed_ = is_placed_ = is_owed_ = is_let_go_ = false;
  silent_reads_ = 0;
  last_time_ = -1.0;
  const auto normal = [&] {
    need(usb::control(*transport_,
                      {ftdi::kLatency1ms, ftdi::kBaud1500k, ftdi::kPurgeIn, ftdi::kPurgeOut}),
         "set up the Falcon's serial chip");
  };
  normal();
  if (answers()) return;
  if (firmware_.empty()) {
    throw Error(ErrorKind::kDevice,
                {"falcon.firmware", "the Falcon has no firmware loaded",
                 "give the firmware image (on the command line --firmware FILE): it comes "
                 "with the device's driver, or with libnifalcon in its folder firmware/; "
                 "Palpate may not ship it"});
  }
  loadFirmware();
  normal();
  if (!answers()) {
    throw Error(ErrorKind::kDevice,
                {"falcon.boot", "the Falcon does not answer after its firmware was loaded",
                 "unplug it and its power supply, and try again"});
  }
}

Status FalconDevice::receive(std::optional<Reply>& last, int wait) noexcept {
  std::array<std::uint8_t, usb::Transport::kPacket> packet{};
  std::size_t got = 0;
  const Status status = transport_->receive(packet, got, wait);
  if (status != Status::kOk) return status;
  for (const std::uint8_t byte : usb::payload(std::span(packet).first(got))) {
    if (const auto reply = parser_.push(byte)) last = reply;
  }
  return status;
}

bool FalconDevice::answers() {
  constexpr int kTries = 3;
  for (int i = 0; i < kTries; ++i) {
    need(transport_->send(kIdle), "send to the Falcon");
    for (int poll = 0; poll < kPolls; ++poll) {
      std::optional<Reply> reply;
      const Status status = receive(reply, kSetUpWait);
      if (status == Status::kGone) need(status, "read from the Falcon");
      if (reply) return true;
    }
  }
  return false;
}

void FalconDevice::exchange(std::span<const std::uint8_t> out, std::span<const std::uint8_t> wanted,
                            const char* step) {
  need(transport_->send(out), step);
  std::size_t at = 0;
  std::array<std::uint8_t, usb::Transport::kPacket> packet{};
  for (int poll = 0; poll < kPolls && at < wanted.size(); ++poll) {
    std::size_t got = 0;
    const Status status = transport_->receive(packet, got, kSetUpWait);
    if (status == Status::kTimeout) continue;
    need(status, step);
    for (const std::uint8_t byte : usb::payload(std::span(packet).first(got))) {
      if (at == 0 && byte == 0 && wanted[0] != 0) continue;  // noise before the first answer
      if (at >= wanted.size() || byte != wanted[at]) {
        throw Error(ErrorKind::kDevice,
                    {"falcon.boot", std::string(step) + ": the Falcon answered something else",
                     "unplug it and its power supply, and try again"});
      }
      ++at;
    }
  }
  if (at == wanted.size()) return;
  throw Error(ErrorKind::kDevice, {"falcon.boot", std::string(step) + ": the Falcon did not answer",
                                   "unplug it and its power supply, and try again"});
}

void FalconDevice::handshake() {
  constexpr std::array<std::uint8_t, 3> kHello = {0x0A, 0x43, 0x0D};
  constexpr std::array<std::uint8_t, 4> kWelcome = {0x0A, 0x44, 0x2C, 0x0D};
  for (int i = 1;; ++i) {
    try {
      exchange(kHello, kWelcome, "call the Falcon's boot loader");
      return;
    } catch (const Error& error) {
      if (error.problem().code != "falcon.boot" || i == kHellos) throw;
    }
    need(usb::control(*transport_, {ftdi::kPurgeIn, ftdi::kPurgeOut}),
         "call the Falcon's boot loader");
  }
}

void FalconDevice::loadFirmware() {
  need(usb::control(*transport_,
                    {ftdi::kPurgeIn, ftdi::kPurgeOut, ftdi::kLatency16ms, ftdi::kBaud9600,
                     ftdi::k8N1, ftdi::kFlowOff, ftdi::kRtsLow, ftdi::kDtrLow, ftdi::kDtrHigh}),
       "set up the Falcon's boot loader");
  handshake();
  need(usb::control(*transport_, {ftdi::kDtrLow, ftdi::kBaud143k}),
       "set up the Falcon's boot loader");
  constexpr std::array<std::uint8_t, 1> kAutobaud = {0x41};
  exchange(kAutobaud, kAutobaud, "find the boot loader's speed");
  for (std::size_t at = 0; at < firmware_.size(); at += kChunk) {
    const auto chunk = std::span(firmware_).subspan(at, std::min(kChunk, firmware_.size() - at));
    exchange(chunk, chunk, "load the Falcon's firmware");
  }
}

void FalconDevice::close() noexcept {
  if (!transport_) return;
  for (int i = 0; i < kZeros; ++i) {
    if (transport_->send(kIdle) == Status::kGone) break;
    std::optional<Reply> ignored;
    if (receive(ignored, kReadWait) == Status::kGone) break;
  }
  transport_.reset();
}

void FalconDevice::cut() noexcept {
  if (transport_) transport_->cut(kIdle);
}

DeviceStatus FalconDevice::take(const Reply& reply, DeviceState& out) noexcept {
  const bool is_homed = reply.isHomed();
  // When the origin is found or lost, every angle changes: search for the pose from the middle
  // again.
  if (is_homed != is_homed_) is_placed_ = false;
  is_homed_ = is_homed;
  Vec3 angles(0.0);
  for (int i = 0; i < 3; ++i) {
    angles[i] = calibration_.zero_angles[i] +
                calibration_.radians_per_count * reply.counts[static_cast<std::size_t>(i)];
  }
  auto grip = gripAt(angles, is_placed_ ? grip_ : middle());
  if (!grip && is_placed_) grip = gripAt(angles, middle());
  // Before homing the angles have no meaning, and may not fit any pose; the reply still shows that
  // the device is alive.
  if (!grip && is_homed) return DeviceStatus::kStale;
  is_placed_ = grip.has_value() && is_homed;
  if (grip) grip_ = grip->position;
  const double time = 1e-9 * static_cast<double>(clock_() - opened_at_);
  out.position = grip ? grip_ - calibration_.origin : Vec3(0.0);
  out.velocity = Vec3(0.0);
  const double dt = time - last_time_;
  if (is_homed && last_time_ >= 0.0 && dt > 0.0) out.velocity = (out.position - before_) / dt;
  out.time = time;
  out.buttons = reply.buttons;
  out.is_homed = is_homed;
  before_ = out.position;
  last_time_ = is_homed ? time : -1.0;
  return DeviceStatus::kOk;
}

DeviceStatus FalconDevice::read(DeviceState& out) noexcept {
  if (!transport_) return DeviceStatus::kDisconnected;
  std::optional<Reply> reply;
  for (int i = 0; i < kReads && !reply; ++i) {
    const Status status = receive(reply, kReadWait);
    if (status == Status::kGone) return DeviceStatus::kDisconnected;
    // Any other failure counts as a lost packet; if more are lost, no reply comes and the loop
    // releases the force.
  }
  if (!reply) {
    ++silent_reads_;
    return DeviceStatus::kStale;
  }
  silent_reads_ = 0;
  is_owed_ = false;
  return take(*reply, out);
}

std::array<int, 3> FalconDevice::motorsFor(const Vec3& force) const noexcept {
  if (!is_homed_ || !is_placed_ || !isFinite(force)) return {};
  const auto arms = armsAt(grip_);
  const auto torques = arms ? torquesFor(force, *arms) : std::nullopt;
  if (!torques) return {};
  Vec3 counts = calibration_.counts_per_torque * *torques;
  const double most = std::max({std::abs(counts.x), std::abs(counts.y), std::abs(counts.z)});
  if (!std::isfinite(most)) return {};
  // Scale all three together, so that the direction stays the same.
  if (most > kMotorMost) counts *= kMotorMost / most;
  return {static_cast<int>(std::lround(counts.x)), static_cast<int>(std::lround(counts.y)),
          static_cast<int>(std::lround(counts.z))};
}

DeviceStatus FalconDevice::write(const Vec3& force) noexcept {
  if (!transport_) return DeviceStatus::kDisconnected;
  Command command;
  command.motors = motorsFor(force);
  const bool is_zero = command.motors == std::array<int, 3>{};
  // One command for each reply; if there was no reply for a while, the command is repeated. A zero
  // force is sent without waiting.
  const bool says_again = silent_reads_ > 0 && silent_reads_ % kPatience == 0;
  const bool lets_go = is_zero && !is_let_go_;
  if (is_owed_ && !says_again && !lets_go) return DeviceStatus::kOk;
  command.homes = !is_homed_;
  command.red = !is_homed_;
  command.green = is_homed_;
  const Status status = transport_->send(encode(command));
  if (status == Status::kGone) return DeviceStatus::kDisconnected;
  is_owed_ = status == Status::kOk;
  is_let_go_ = is_owed_ && is_zero;
  return DeviceStatus::kOk;
}

}  // namespace palpate::devices::falcon

namespace palpate::devices {

std::unique_ptr<Device> makeFalcon(const FalconSettings& settings) {
  std::vector<std::uint8_t> firmware;
  if (!settings.firmware.empty()) firmware = falcon::readFirmware(settings.firmware);
  const usb::Choice choice{kFalconVendor, kFalconProduct, settings.serial, settings.descriptor};
  return std::make_unique<falcon::FalconDevice>([choice] { return usb::openUsb(choice); },
                                                std::move(firmware), settings.calibration,
                                                [] { return monotonicNs(); });
}

}  // namespace palpate::devices
