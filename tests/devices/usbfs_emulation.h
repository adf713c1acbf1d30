#pragma once
// The kernel's side of a USB device, for use by the usual libusb.

#include <functional>
#include <memory>
#include <string>

#include "devices/falcon_emulator.h"

namespace palpate::devices {

/// While it exists, `descriptor()` acts as the opened node of the device: the test executable
/// defines ioctl(), which libusb then calls, and answers for it. Everything between the driver and
/// the kernel is real. Transfers end when they are reaped; libusb polls again and again meanwhile,
/// as the descriptor is always ready.
class UsbfsEmulation {
 public:
  explicit UsbfsEmulation(FalconEmulator& falcon);
  ~UsbfsEmulation();
  UsbfsEmulation(const UsbfsEmulation&) = delete;
  UsbfsEmulation& operator=(const UsbfsEmulation&) = delete;

  [[nodiscard]] int descriptor() const noexcept;
  /// Makes `copy`, a copy of descriptor(), the node instead.
  void answerFor(int copy) noexcept;
  /// From now on each descriptor of this file acts as the node. @throws std::runtime_error if the
  /// file does not exist.
  void answerForNode(const std::string& file);

  std::string serial;  ///< answer to requests for string descriptors of any index

  /// The kind of request that the kernel gets next. Requests are counted from 0, so that a test can
  /// unplug at each.
  enum class Step { kClaim, kControl, kSubmitIn, kSubmitOut, kReapIn, kReapOut, kRelease };
  /// Called at each step; a nonzero result is the errno that the kernel answers (for a finished
  /// transfer, its status).
  std::function<int(Step)> fault;
  /// Acts as if the cable was pulled.
  void unplug() noexcept;
  /// The cable is plugged in again; the device has its own power, and has kept its firmware.
  void plugIn() noexcept;
  [[nodiscard]] int steps() const noexcept;           ///< number so far
  [[nodiscard]] std::uint64_t outs() const noexcept;  ///< number of packets sent to the device
  [[nodiscard]] int pending() const noexcept;         ///< number of transfers that the kernel holds
  [[nodiscard]] bool wasClaimed() const noexcept;

  class Kernel;

 private:
  std::unique_ptr<Kernel> kernel_;
  int descriptor_ = -1;
};

}  // namespace palpate::devices
