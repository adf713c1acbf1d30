#include "palpate/devices/replay_device.h"

#include <limits>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/devices/record.h"

namespace palpate::devices {

ReplayDevice::ReplayDevice(std::vector<DeviceState> rows, DeviceInfo info,
                           std::vector<InjectedFault> faults)
    : rows_(std::move(rows)), info_(std::move(info)), faults_(std::move(faults)) {
  if (rows_.empty())
    throw inputError("record.empty", "a replay needs a record of one tick or more");
}

void ReplayDevice::open() {
  next_ = 0;
  reads_ = 0;
  force_ = Vec3(0.0);
  is_open_ = true;
}

void ReplayDevice::close() noexcept {
  force_ = Vec3(0.0);
  is_open_ = false;
}

DeviceStatus ReplayDevice::read(DeviceState& out) noexcept {
  constexpr double kFarAway = 0.5;  // [m]
  if (!is_open_) return DeviceStatus::kDisconnected;
  const std::uint64_t call = reads_++;
  if (next_ == rows_.size()) return DeviceStatus::kEnd;
  const InjectedFault* fault = nullptr;
  for (const InjectedFault& each : faults_) {
    if (call >= each.read && call - each.read < each.count) fault = &each;
  }
  if (fault != nullptr && fault->kind == InjectedKind::kStale) return DeviceStatus::kStale;
  const DeviceState& row = rows_[next_++];
  if (fault == nullptr) {
    out = row;
    return DeviceStatus::kOk;
  }
  switch (fault->kind) {
    case InjectedKind::kTimeout:
      return DeviceStatus::kTimeout;
    case InjectedKind::kUnplug:
      is_open_ = false;
      return DeviceStatus::kDisconnected;
    case InjectedKind::kNan:
      out = row;
      out.position.x = std::numeric_limits<double>::quiet_NaN();
      return DeviceStatus::kOk;
    case InjectedKind::kJump:
      out = row;
      out.position.x += kFarAway;
      return DeviceStatus::kOk;
    case InjectedKind::kStale:
    case InjectedKind::kShortPacket:
      break;
  }
  return DeviceStatus::kStale;
}

DeviceStatus ReplayDevice::write(const Vec3& force) noexcept {
  if (!is_open_) return DeviceStatus::kDisconnected;
  force_ = force;
  return DeviceStatus::kOk;
}

std::vector<DeviceState> readingsOf(const std::string& file) {
  RecordReader reader(file);
  std::vector<DeviceState> out;
  out.reserve(reader.size());
  for (TickRecord row; reader.next(row);) out.push_back(readingOf(row));
  return out;
}

}  // namespace palpate::devices
