#pragma once
// A device that fails as scripted.

#include <cstddef>
#include <limits>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/devices/device.h"

namespace palpate::devices {

/// Answers read k with `reads[k]` and write k with `writes[k]` (kOk beyond the end), and records
/// all calls. Position k is (k, 0, 0) [m]; a stale read leaves garbage in its argument, as a
/// careless driver might.
class ScriptedDevice : public Device {
 public:
  std::vector<DeviceStatus> reads;
  std::vector<DeviceStatus> writes;
  std::vector<std::size_t> nan_positions;  ///< indices of reads that report a NaN position
  bool fails_to_open = false;
  double max_force = 10.0;  ///< [N]

  std::vector<Vec3> written;
  int opened = 0;
  int closed = 0;
  bool wrote_while_closed = false;

  ScriptedDevice() { written.reserve(1000); }

  void open() override {
    if (fails_to_open) {
      throw Error(ErrorKind::kDevice, {"device.none", "nothing is plugged in"});
    }
    ++opened;
  }
  void close() noexcept override { ++closed; }
  [[nodiscard]] const DeviceInfo& info() const noexcept override {
    info_.max_force = max_force;
    return info_;
  }

  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override {
    const std::size_t k = read_count_++;
    if (k >= reads.size()) return DeviceStatus::kEnd;
    out.time = 1e-3 * static_cast<double>(k);
    out.position = Vec3(static_cast<double>(k), 0.0, 0.0);
    for (const std::size_t bad : nan_positions) {
      if (bad == k) out.position.y = std::numeric_limits<double>::quiet_NaN();
    }
    if (reads[k] != DeviceStatus::kOk) out.position = Vec3(1e6);
    return reads[k];
  }

  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override {
    if (opened != closed + 1) wrote_while_closed = true;
    if (written.size() < written.capacity()) written.push_back(force);
    const std::size_t k = write_count_++;
    return k < writes.size() ? writes[k] : DeviceStatus::kOk;
  }

 private:
  mutable DeviceInfo info_{"scripted", 10.0, {}};
  std::size_t read_count_ = 0;
  std::size_t write_count_ = 0;
};

}  // namespace palpate::devices
