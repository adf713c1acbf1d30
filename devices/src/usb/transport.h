#pragma once
// The connection to a device behind an FTDI chip: control requests, and one stream of bytes in each
// direction.

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>

#include "palpate/core/error.h"

namespace palpate::devices::usb {

enum class Status : std::uint8_t {
  kOk,
  kTimeout,
  kGone,      ///< unplugged
  kStall,     ///< the endpoint has stopped
  kOverflow,  ///< more came than was asked for
  kError,     ///< any other failure of a transfer
};

[[nodiscard]] std::string_view textOf(Status status) noexcept;

/// One opened device; the destructor closes it. For one thread, except that cut() may come from
/// another.
class Transport {
 public:
  static constexpr std::size_t kPacket = 64;  // [bytes] the longest packet at full speed

  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// A vendor's request without data (set-up only: may take long and allocate).
  [[nodiscard]] virtual Status control(std::uint8_t request, std::uint16_t value) noexcept = 0;

  /// Sends up to kPacket bytes; waits at most a few ms for the previous ones.
  [[nodiscard]] virtual Status send(std::span<const std::uint8_t> bytes) noexcept = 0;

  /// Receives one packet, waiting at most `wait` [ms]; the next one is requested at once. `into`
  /// has room for kPacket bytes.
  [[nodiscard]] virtual Status receive(std::span<std::uint8_t> into, std::size_t& got,
                                       int wait) noexcept = 0;

  /// Sends `bytes` at once, whatever the servo thread is doing.
  virtual void cut(std::span<const std::uint8_t> bytes) noexcept = 0;

 protected:
  Transport() = default;
};

/// Which device to open.
struct Choice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial = {};  ///< empty: the first device
  /// 0 or more: an open file descriptor of the device's node; the other members are then ignored
  int descriptor = -1;
};

/// A function that opens a device. @throws Error (kDevice).
using Opener = std::function<std::unique_ptr<Transport>()>;

/// Opens a device through libusb. @throws Error (kDevice) with a remedy: it is missing, cannot be
/// accessed, or is in use; or the build has no libusb.
[[nodiscard]] std::unique_ptr<Transport> openUsb(const Choice& choice);

/// The error of a set-up step that ended with `status`.
[[nodiscard]] Error failure(const std::string& step, Status status);

}  // namespace palpate::devices::usb
