#pragma once
// The kernel's side of a USB device, for the libusb that everybody uses.

#include <functional>
#include <memory>
#include <string>

#include "devices/falcon_emulator.h"

namespace palpate::devices {

/// While it lives, `descriptor()` is what the device's node would be when opened: the test
/// executable defines ioctl(), which libusb then calls, and answers for it. Everything between the
/// driver and the kernel is the real thing. Transfers end when they are reaped; libusb asks again
/// and again meanwhile, as the descriptor is always ready.
class UsbfsEmulation {
 public:
  explicit UsbfsEmulation(FalconEmulator& falcon);
  ~UsbfsEmulation();
  UsbfsEmulation(const UsbfsEmulation&) = delete;
  UsbfsEmulation& operator=(const UsbfsEmulation&) = delete;

  [[nodiscard]] int descriptor() const noexcept;
  /// A copy of descriptor() that is to be the node instead.
  void answerFor(int copy) noexcept;
  /// From now on each descriptor of this file is the node. @throws std::runtime_error if it is not
  /// there.
  void answerForNode(const std::string& file);

  std::string serial;  ///< that string descriptors of any index give

  /// Which request of the kernel's comes next: counted from 0, for unplugging at each.
  enum class Step { kClaim, kControl, kSubmitIn, kSubmitOut, kReapIn, kReapOut, kRelease };
  /// Asked at each step; what is not 0 is the errno that the kernel answers (a finished transfer's
  /// status).
  std::function<int(Step)> fault;
  /// As if the cable was pulled.
  void unplug() noexcept;
  /// The cable is in again; the device has power of its own, and kept its firmware.
  void plugIn() noexcept;
  [[nodiscard]] int steps() const noexcept;           ///< so far
  [[nodiscard]] std::uint64_t outs() const noexcept;  ///< packets that the device got
  [[nodiscard]] int pending() const noexcept;         ///< transfers that the kernel holds
  [[nodiscard]] bool wasClaimed() const noexcept;

  class Kernel;

 private:
  std::unique_ptr<Kernel> kernel_;
  int descriptor_ = -1;
};

}  // namespace palpate::devices
