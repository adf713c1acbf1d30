#pragma once
/// A hand that follows a path exactly, whatever the force: deterministic, for tests and traces.

#include <cstddef>
#include <optional>

#include "palpate/devices/device.h"
#include "palpate/devices/path.h"

namespace palpate::devices {

/// One read() is one row of the path. The velocity is the backward difference of the rows (0 at the
/// first, and where the time does not rise), the time is the row's. After the last row read() answers kEnd and leaves its argument alone.
/// While it is not open, read() and write() answer kDisconnected. open() starts the path anew.
/// Its maximum force is kMaxForce, its workspace the box of the path.
class VirtualDevice final : public Device {
 public:
  /// [N] A hundred times what desktop devices hold, so that closed forms hold in every sane scene, and
  /// yet a limit, as every device has one.
  static constexpr double kMaxForce = 1000.0;

  /// @throws Error (kInput) for an empty path or times that do not rise, unless `rules` let them.
  /// Positions are taken as they are, so that a NaN from a broken sensor can be played.
  explicit VirtualDevice(Path path, DeviceFrame frame = DeviceFrame::kWorld,
                         PathRules rules = PathRules::kSound);

  /// The same of a path that is computed row by row: it takes no memory.
  explicit VirtualDevice(PathFormula formula, DeviceFrame frame = DeviceFrame::kWorld);

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const noexcept override;
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override;

  /// The last force written [N]; zero before the first and after close().
  [[nodiscard]] const Vec3& lastForce() const noexcept { return force_; }

 private:
  void describe(DeviceFrame frame);
  [[nodiscard]] std::size_t size() const noexcept;
  [[nodiscard]] PathPoint pointAt(std::size_t row) const;

  DeviceInfo info_;
  Path path_;  ///< empty: formula_ says it
  std::optional<PathFormula> formula_;
  std::size_t next_ = 0;
  bool is_open_ = false;
  Vec3 force_{0.0, 0.0, 0.0};
};

}  // namespace palpate::devices
