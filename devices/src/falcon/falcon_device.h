#pragma once
// The Falcon driver: how it is started, read and written, independent of the connection to it.

#include <array>
#include <atomic>
#include <functional>
#include <memory>
#include <vector>

#include "falcon/kinematics.h"
#include "falcon/packet.h"
#include "palpate/devices/falcon.h"
#include "usb/transport.h"

namespace palpate::devices::falcon {

class FalconDevice final : public Device {
 public:
  using Clock = std::function<std::int64_t()>;  ///< [ns], never going back; real-time safe

  /// `firmware` must have been checked. `clock` stamps the readings.
  FalconDevice(usb::Opener opener, std::vector<std::uint8_t> firmware,
               const FalconCalibration& calibration, Clock clock);
  ~FalconDevice() override;

  void open() override;
  void close() noexcept override;
  [[nodiscard]] const DeviceInfo& info() const noexcept override { return info_; }
  [[nodiscard]] DeviceStatus read(DeviceState& out) noexcept override;
  [[nodiscard]] DeviceStatus write(const Vec3& force) noexcept override;
  void cut() noexcept override;

  /// Bytes that were not part of a reply since open().
  [[nodiscard]] std::uint64_t dropped() const noexcept { return parser_.dropped(); }

 private:
  void start();
  [[nodiscard]] bool answers();
  void loadFirmware();
  void handshake();
  void need(usb::Status status, const char* step);
  void exchange(std::span<const std::uint8_t> out, std::span<const std::uint8_t> wanted,
                const char* step);
  [[nodiscard]] usb::Status receive(std::optional<Reply>& last, int wait) noexcept;
  [[nodiscard]] DeviceStatus take(const Reply& reply, DeviceState& out) noexcept;
  [[nodiscard]] std::array<int, 3> motorsFor(const Vec3& force) const noexcept;

  usb::Opener opener_;
  std::vector<std::uint8_t> firmware_;
  FalconCalibration calibration_;
  Clock clock_;
  DeviceInfo info_;
  std::unique_ptr<usb::Transport> transport_;
  Parser parser_;
  Vec3 grip_{0.0, 0.0, 0.0};    ///< [m] the last pose, in the base's frame
  Vec3 before_{0.0, 0.0, 0.0};  ///< [m] position of the last reading
  double last_time_ = -1.0;     ///< [s] time of that reading; negative: none
  std::int64_t opened_at_ = 0;  ///< [ns]
  bool is_homed_ = false;
  bool is_placed_ = false;  ///< grip_ is a pose that was found
  bool is_owed_ = false;    ///< a command has had no reply yet
  bool is_let_go_ = false;  ///< the last command that went out was zero force
  int silent_reads_ = 0;
};

}  // namespace palpate::devices::falcon
