#include "palpate/devices/simulated_device.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <utility>

#include "hand_path.h"
#include "palpate/core/error.h"
#include "plant_axis.h"
#include "servo_clock.h"

namespace palpate::devices {
namespace {

/// [s] If the machine slept longer than this between two readings, that time is not simulated:
/// forces are not held for hours.
constexpr double kLongestGap = 1.0;

Error usageError(const char* code, std::string message) {
  return Error(ErrorKind::kUsage, {code, std::move(message)});
}

void check(const SimulationSettings& settings, const HandPath& path) {
  check(settings.device);
  if (settings.hand) check(*settings.hand);
  if (!(settings.rate >= 1.0 && settings.rate <= 1e5)) {
    throw usageError("device.rate",
                     "the rate of a simulated device must be 1 to 1e5 readings a second, not " +
                         std::to_string(settings.rate));
  }
  if (settings.delay < 0 || settings.delay > SimulatedDevice::kMostDelay) {
    throw usageError("device.delay", "the delay of a simulated device must be 0 to " +
                                         std::to_string(SimulatedDevice::kMostDelay) +
                                         " samples, not " + std::to_string(settings.delay));
  }
  if (!isFinite(settings.push)) {
    throw usageError("device.push", "the push on a simulated device must be finite");
  }
  if (path.size() == 0) {
    throw inputError("path.empty", "a simulated device needs a path of one point or more");
  }
  double last = -kInfinity;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const PathPoint point = path.row(i);
    if (!(point.t > last) || !std::isfinite(point.t)) {
      throw inputError("path.time", "time does not rise at point " + std::to_string(i) +
                                        " of the path (counted from 0)");
    }
    if (!isFinite(point.position)) {
      throw inputError("path.not_finite", "point " + std::to_string(i) +
                                              " of the path (counted from 0) is not finite");
    }
    last = point.t;
  }
}

}  // namespace

class SimulatedDevice::Plant {
 public:
  Plant(const SimulationSettings& settings, HandPath path, DeviceFrame frame)
      : settings_((check(settings, path), settings)),
        path_(std::move(path)),
        tables_(settings.device, settings.hand, 1.0 / settings.rate) {
    info_.name = "simulated " + settings.device.name;
    info_.frame = frame;
    info_.max_force = settings.device.max_force;
    info_.workspace = settings.device.workspace;
  }

  void open() {
    path_.rewind();
    time_ = path_.begin();
    const Vec3 start = path_.at(time_);
    for (int i = 0; i < 3; ++i) {
      axes_[at(i)].start(start[i], settings_.push[i], settings_.device.damping);
    }
    held_ = Vec3(0.0);
    delayed_.fill(Vec3(0.0));
    newest_ = 0;
    readings_ = 0;
    is_open_ = true;
  }

  void close() noexcept {
    held_ = Vec3(0.0);
    is_open_ = false;
  }

  DeviceStatus read(DeviceState& out) noexcept {
    if (!is_open_) return DeviceStatus::kDisconnected;
    if (readings_ == 0) {
      opened_ = settings_.realtime ? monotonicNs() : 0;
    } else {
      const double now = settings_.realtime
                             ? path_.begin() + 1e-9 * static_cast<double>(monotonicNs() - opened_)
                             : path_.begin() + static_cast<double>(readings_) / settings_.rate;
      // The path's last row must be felt even if its time is rounded down.
      if (now > path_.end() + 1e-6 / settings_.rate) return DeviceStatus::kEnd;
      advanceTo(now);
    }
    const Vec3 before = reading_;
    const double span = time_ - read_at_;
    reading_ = measured();
    out.time = time_;
    out.position = reading_;
    out.velocity = readings_ > 0 && span > 0.0 ? (reading_ - before) / span : Vec3(0.0);
    read_at_ = time_;
    ++readings_;
    return DeviceStatus::kOk;
  }

  DeviceStatus write(const Vec3& force) noexcept {
    if (!is_open_) return DeviceStatus::kDisconnected;
    newest_ = (newest_ + 1) % delayed_.size();
    delayed_[newest_] = isFinite(force) ? force : Vec3(0.0);
    const auto delay = static_cast<std::size_t>(settings_.delay);
    held_ = delayed_[(newest_ + delayed_.size() - delay) % delayed_.size()];
    const double length = glm::length(held_);
    if (length > settings_.device.max_force) held_ *= settings_.device.max_force / length;
    return DeviceStatus::kOk;
  }

  [[nodiscard]] const DeviceInfo& info() const noexcept { return info_; }
  [[nodiscard]] const Vec3& held() const noexcept { return held_; }
  [[nodiscard]] Vec3 position() const noexcept {
    return {axes_[0].position(), axes_[1].position(), axes_[2].position()};
  }
  [[nodiscard]] Vec3 velocity() const noexcept {
    return {axes_[0].velocity(), axes_[1].velocity(), axes_[2].velocity()};
  }
  [[nodiscard]] Vec3 handPosition() const noexcept {
    return {axes_[0].handPosition(tables_), axes_[1].handPosition(tables_),
            axes_[2].handPosition(tables_)};
  }
  [[nodiscard]] DeviceWork work() const noexcept {
    DeviceWork sum;
    for (const PlantAxis& axis : axes_) {
      sum.motor += axis.work().motor;
      sum.push += axis.work().push;
      sum.friction += axis.work().friction;
      sum.viscous += axis.work().viscous;
      sum.kinetic += 0.5 * settings_.device.mass * axis.velocity() * axis.velocity();
    }
    return sum;
  }

 private:
  static std::size_t at(int axis) noexcept { return static_cast<std::size_t>(axis); }

  void advanceTo(double now) noexcept {
    const double span = now - time_;
    if (!(span > 0.0)) return;
    const double moved = std::min(span, kLongestGap);
    const auto quanta = settings_.realtime
                            ? static_cast<std::int64_t>(std::llround(moved / tables_.quantum))
                            : PlantTables::kLongest *
                                  std::llround(1.0 / (settings_.rate * tables_.quantum *
                                                      static_cast<double>(PlantTables::kLongest)));
    const Vec3 from = path_.at(time_);
    const Vec3 to = path_.at(now);
    for (int i = 0; i < 3; ++i) {
      axes_[at(i)].advance(tables_, {held_[i], from[i], (to[i] - from[i]) / span}, quanta);
    }
    time_ = now;
  }

  /// [m] The position as the encoders report it.
  [[nodiscard]] Vec3 measured() const noexcept {
    const double step = settings_.device.encoder;
    Vec3 out = position();
    if (!(step > 0.0)) return out;
    for (int i = 0; i < 3; ++i) out[i] = step * std::round(out[i] / step);
    return out;
  }

  SimulationSettings settings_;
  HandPath path_;
  PlantTables tables_;
  DeviceInfo info_;
  std::array<PlantAxis, 3> axes_;
  std::array<Vec3, kMostDelay + 1> delayed_{};  ///< [N] forces as written, in a ring
  std::size_t newest_ = 0;
  Vec3 held_{0.0, 0.0, 0.0};     ///< [N]
  Vec3 reading_{0.0, 0.0, 0.0};  ///< [m] the last one
  double read_at_ = 0.0;         ///< [s]
  double time_ = 0.0;            ///< [s] of the path
  std::int64_t opened_ = 0;      ///< [ns] time of the first reading
  std::uint64_t readings_ = 0;
  bool is_open_ = false;
};

SimulatedDevice::SimulatedDevice(const SimulationSettings& settings, Path path, DeviceFrame frame)
    : plant_(std::make_unique<Plant>(settings, HandPath(std::move(path)), frame)) {}

SimulatedDevice::SimulatedDevice(const SimulationSettings& settings, PathFormula path,
                                 DeviceFrame frame)
    : plant_(std::make_unique<Plant>(settings, HandPath(std::move(path)), frame)) {}

SimulatedDevice::SimulatedDevice(const SimulationSettings& settings, LiveHand hand,
                                 DeviceFrame frame)
    : plant_(std::make_unique<Plant>(settings, HandPath(std::move(hand)), frame)) {}

SimulatedDevice::~SimulatedDevice() = default;

void SimulatedDevice::open() { plant_->open(); }
void SimulatedDevice::close() noexcept { plant_->close(); }
const DeviceInfo& SimulatedDevice::info() const noexcept { return plant_->info(); }
DeviceStatus SimulatedDevice::read(DeviceState& out) noexcept { return plant_->read(out); }
DeviceStatus SimulatedDevice::write(const Vec3& force) noexcept { return plant_->write(force); }
Vec3 SimulatedDevice::position() const noexcept { return plant_->position(); }
Vec3 SimulatedDevice::velocity() const noexcept { return plant_->velocity(); }
Vec3 SimulatedDevice::handPosition() const noexcept { return plant_->handPosition(); }
DeviceWork SimulatedDevice::work() const noexcept { return plant_->work(); }
const Vec3& SimulatedDevice::heldForce() const noexcept { return plant_->held(); }

}  // namespace palpate::devices
