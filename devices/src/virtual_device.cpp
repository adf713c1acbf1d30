#include <cmath>
#include <string>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/path.h"

namespace palpate::devices {

VirtualDevice::VirtualDevice(Path path, DeviceFrame frame, PathRules rules)
    : path_(std::move(path)) {
  if (path_.empty()) {
    throw inputError("path.empty", "a virtual device needs a path of one point or more");
  }
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const bool rises = i == 0 || path_[i].t > path_[i - 1].t;
    if (rules == PathRules::kSound && (!std::isfinite(path_[i].t) || !rises)) {
      throw inputError("path.time", "time does not rise at point " + std::to_string(i) +
                                        " of the path (counted from 0)");
    }
  }
  describe(frame);
}

VirtualDevice::VirtualDevice(PathFormula formula, DeviceFrame frame)
    : formula_(std::move(formula)) {
  describe(frame);
}

void VirtualDevice::describe(DeviceFrame frame) {
  for (std::size_t i = 0; i < size(); ++i) {
    const Vec3 position = pointAt(i).position;
    if (isFinite(position)) info_.workspace.include(position);
  }
  info_.name = "virtual";
  info_.frame = frame;
  info_.max_force = kMaxForce;
}

std::size_t VirtualDevice::size() const noexcept {
  return formula_ ? formula_->size() : path_.size();
}

PathPoint VirtualDevice::pointAt(std::size_t row) const {
  return formula_ ? formula_->at(row) : path_[row];
}

void VirtualDevice::open() {
  next_ = 0;
  force_ = Vec3(0.0);
  is_open_ = true;
}

void VirtualDevice::close() noexcept {
  force_ = Vec3(0.0);
  is_open_ = false;
}

const DeviceInfo& VirtualDevice::info() const noexcept { return info_; }

DeviceStatus VirtualDevice::read(DeviceState& out) noexcept {
  if (!is_open_) return DeviceStatus::kDisconnected;
  if (next_ == size()) return DeviceStatus::kEnd;
  const PathPoint now = pointAt(next_);
  out.time = now.t;
  out.position = now.position;
  out.velocity = Vec3(0.0);
  if (next_ > 0) {
    const PathPoint before = pointAt(next_ - 1);
    const double step = now.t - before.t;
    if (step > 0.0) out.velocity = (now.position - before.position) / step;
  }
  ++next_;
  return DeviceStatus::kOk;
}

DeviceStatus VirtualDevice::write(const Vec3& force) noexcept {
  if (!is_open_) return DeviceStatus::kDisconnected;
  force_ = force;
  return DeviceStatus::kOk;
}

}  // namespace palpate::devices
