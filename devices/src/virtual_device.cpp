#include "palpate/devices/virtual_device.h"

#include <cmath>
#include <string>
#include <utility>

#include "palpate/core/error.h"

namespace palpate::devices {

VirtualDevice::VirtualDevice(Path path) : path_(std::move(path)) {
  if (path_.empty()) {
    throw inputError("path.empty", "a virtual device needs a path of one point or more");
  }
  for (std::size_t i = 0; i < path_.size(); ++i) {
    const bool rises = i == 0 || path_[i].t > path_[i - 1].t;
    if (!std::isfinite(path_[i].t) || !rises) {
      throw inputError("path.time", "time does not rise at point " + std::to_string(i) +
                                        " of the path (counted from 0)");
    }
    if (isFinite(path_[i].position)) info_.workspace.include(path_[i].position);
  }
  info_.name = "virtual";
  info_.max_force = kMaxForce;
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
  if (next_ == path_.size()) return DeviceStatus::kEnd;
  const PathPoint& now = path_[next_];
  out.time = now.t;
  out.position = now.position;
  out.velocity = Vec3(0.0);
  if (next_ > 0) {
    const PathPoint& before = path_[next_ - 1];
    out.velocity = (now.position - before.position) / (now.t - before.t);
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
