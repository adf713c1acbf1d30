#include "devices/falcon_emulator.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpate::devices {
namespace {

constexpr int kSubsteps = 20;
constexpr double kZero = 35.0 * std::numbers::pi / 180.0;

/// The angle of the thigh of leg `i` at `p`, by bisection: the lower leg's length grows as the
/// thigh turns outward.
double thighAngle(int i, const Vec3& p) {
  const double azimuth = (105.0 - 120.0 * i) * std::numbers::pi / 180.0;
  const double u = std::cos(azimuth) * p.x + std::sin(azimuth) * p.y - 0.0400 + 0.01443;
  const double v = -std::sin(azimuth) * p.x + std::cos(azimuth) * p.y + 0.02309 - 0.025;
  const double lower = 0.0225 + std::sqrt(std::max(0.0, 0.1025 * 0.1025 - v * v));
  const auto excess = [&](double angle) {
    return std::hypot(u - 0.060 * std::cos(angle), p.z - 0.060 * std::sin(angle)) - lower;
  };
  // The knee is on the outer side of the line to the grip: from that line outward, the excess
  // grows.
  const double line = std::atan2(p.z, u);
  double near = line;
  double far = line - std::numbers::pi;
  for (int n = 0; n < 60; ++n) {
    const double middle = 0.5 * (near + far);
    (excess(middle) < 0.0 ? near : far) = middle;
  }
  return near;
}

}  // namespace

std::vector<std::uint8_t> syntheticFirmware(std::size_t words) {
  std::vector<std::uint8_t> out;
  const auto word = [&](std::size_t w) {
    out.push_back(static_cast<std::uint8_t>(w & 255U));
    out.push_back(static_cast<std::uint8_t>((w >> 8) & 255U));
  };
  word(0x08AA);
  for (int i = 0; i < 8; ++i) word(0);
  word(0x003F);
  word(0x8002);
  const std::size_t first = words / 3;
  for (const std::size_t count : {first, words - first}) {
    word(count);
    word(0x003F);
    word(0x8000);
    for (std::size_t i = 0; i < count; ++i) word(i * 2654435761U);
  }
  word(0);
  return out;
}

FalconEmulator::FalconEmulator() { encode(); }

void FalconEmulator::place(const Vec3& position) {
  position_ = position;
  velocity_ = Vec3(0.0);
  encode();
}

void FalconEmulator::encode() {
  for (int i = 0; i < 3; ++i) {
    counts_[static_cast<std::size_t>(i)] =
        static_cast<int>(std::lround((thighAngle(i, position_) - kZero) / radians_per_count));
  }
}

void FalconEmulator::move(double seconds) {
  // Virtual work, by differences: the force along an axis is the torque times the angle by which
  // the thighs turn along it.
  constexpr double kStep = 1e-6;          // [m]
  constexpr double kNewtonMeter = -1e-4;  // [Nm] per count
  Vec3 push(0.0);
  quantum = 0.0;
  for (int i = 0; i < 3; ++i) {
    Vec3 slope(0.0);  // [rad/m]
    for (int k = 0; k < 3; ++k) {
      Vec3 d(0.0);
      d[k] = kStep;
      slope[k] = (thighAngle(i, position_ + d) - thighAngle(i, position_ - d)) / (2.0 * kStep);
    }
    push += kNewtonMeter * motors[static_cast<std::size_t>(i)] * slope;
    quantum += 0.5 * std::abs(kNewtonMeter) * glm::length(slope);
  }
  felt = push;
  const double dt = seconds / kSubsteps;
  for (int n = 0; n < kSubsteps; ++n) {
    Vec3 force = push - damping * velocity_;
    if (hand) force += hand(position_);
    // The mean of the two speeds: exact for a held force, so that the emulation adds no delay of
    // its own.
    const Vec3 before = velocity_;
    velocity_ += force * (dt / mass);
    position_ += 0.5 * dt * (before + velocity_);
  }
  encode();
}

void FalconEmulator::control(std::uint8_t request, std::uint16_t value) {
  if (request == 0 && value == 1) to_host_.clear();
  if (request == 0 && value == 2) heard_.clear();
  if (request == 1 && value == 0x0101) {
    boot_ = Boot::kHello;  // DTR resets the processor
    has_firmware = false;
    image_.clear();
  }
  if (request == 3) baud_ = value;
  if (request == 9) latency = value;
}

void FalconEmulator::out(std::span<const std::uint8_t> bytes) {
  for (const std::uint8_t byte : bytes) has_firmware ? firmware(byte) : boot(byte);
}

void FalconEmulator::boot(std::uint8_t byte) {
  if (boot_ == Boot::kHello && baud_ == 0x4138) {
    heard_.push_back(byte);
    if (heard_.size() >= 3 && std::equal(heard_.end() - 3, heard_.end(), "\x0A\x43\x0D")) {
      for (const char c : {'\x00', '\x0A', '\x44', '\x2C', '\x0D'}) {
        to_host_.push_back(static_cast<std::uint8_t>(c));
      }
      heard_.clear();
      boot_ = Boot::kAutobaud;
    }
  } else if (boot_ == Boot::kAutobaud && baud_ == 0x0015) {
    if (byte != 0x41) return;
    to_host_.push_back(0x41);
    boot_ = Boot::kLoading;
  } else if (boot_ == Boot::kLoading && baud_ == 0x0015) {
    to_host_.push_back(byte);
    image_.push_back(byte);
    ++loaded;
    // The boot table: key, eight words, entry, and blocks up to one of size 0.
    std::size_t at = 2 * 11;
    while (at + 2 <= image_.size()) {
      const std::size_t count = image_[at] + 256U * image_[at + 1];
      if (count == 0) {
        has_firmware = image_[0] == 0xAA && image_[1] == 0x08;
        boot_ = Boot::kCold;
        homed = 0;
        heard_.clear();
        return;
      }
      at += 2 * (3 + count);
    }
  }
}

void FalconEmulator::firmware(std::uint8_t byte) {
  if (baud_ != 0x0002) return;
  if (byte == '<') heard_.clear();
  heard_.push_back(byte);
  if (heard_.size() != 16 || heard_.front() != '<' || byte != '>') return;
  for (std::size_t i = 0; i < 3; ++i) {
    int value = 0;
    for (std::size_t k = 4; k-- > 0;) value = 16 * value + (heard_[1 + 4 * i + k] - 'A');
    motors[i] = value < 32768 ? value : value - 65536;
  }
  lights = static_cast<unsigned>(heard_[13] - 'A');
  heard_.clear();
  answer();
}

void FalconEmulator::answer() {
  ++commands;
  if (motors != std::array<int, 3>{}) ++moving_commands;
  if (moves) move(1e-3);
  now_ += 1'000'000;
  std::vector<std::uint8_t> reply = {'<'};
  for (const int count : counts_) {
    int rest = count & 0xFFFF;
    for (int k = 0; k < 4; ++k) {
      reply.push_back(static_cast<std::uint8_t>('A' + rest % 16));
      rest /= 16;
    }
  }
  reply.push_back(static_cast<std::uint8_t>('A' + buttons + 16 * homed));
  reply.push_back('A');
  reply.push_back('>');
  if (damage) damage(reply);
  to_host_.insert(to_host_.end(), reply.begin(), reply.end());
}

std::vector<std::uint8_t> FalconEmulator::in() {
  std::vector<std::uint8_t> out = {0x01, 0x60};
  while (!to_host_.empty() && out.size() < 64) {
    out.push_back(to_host_.front());
    to_host_.pop_front();
  }
  // The chip's timer: without data it sends its state once a millisecond.
  if (out.size() == 2) now_ += 1'000'000;
  return out;
}

}  // namespace palpate::devices
