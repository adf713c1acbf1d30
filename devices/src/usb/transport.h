#pragma once
// The way to a device behind an FTDI chip: control requests, one stream of bytes each way.

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

/// One device, opened; the destructor closes it. One thread, but cut() may come from another.
class Transport {
 public:
  static constexpr std::size_t kPacket = 64;  // [bytes] the longest there is at full speed

  virtual ~Transport() = default;
  Transport(const Transport&) = delete;
  Transport& operator=(const Transport&) = delete;

  /// A vendor's request without data (set-up only: may take long and allocate).
  [[nodiscard]] virtual Status control(std::uint8_t request, std::uint16_t value) noexcept = 0;

  /// Sends up to kPacket bytes; waits at most a few ms for those before them.
  [[nodiscard]] virtual Status send(std::span<const std::uint8_t> bytes) noexcept = 0;

  /// One packet as it came, at most `wait` [ms] from now; the next is asked for at once. `into` has
  /// room for kPacket bytes.
  [[nodiscard]] virtual Status receive(std::span<std::uint8_t> into, std::size_t& got,
                                       int wait) noexcept = 0;

  /// Sends `bytes` past whatever the servo thread is doing.
  virtual void cut(std::span<const std::uint8_t> bytes) noexcept = 0;

 protected:
  Transport() = default;
};

/// Which device to open.
struct Choice {
  std::uint16_t vendor = 0;
  std::uint16_t product = 0;
  std::string serial = {};  ///< empty: the first there is
  int descriptor =
      -1;  ///< 0 or more: an open file descriptor of the device's node; the rest is not used
};

/// Opens a device anew. @throws Error (kDevice).
using Opener = std::function<std::unique_ptr<Transport>()>;

/// Through libusb. @throws Error (kDevice) with a remedy: none there, no access, in use; or built
/// without libusb.
[[nodiscard]] std::unique_ptr<Transport> openUsb(const Choice& choice);

/// The error of a set-up step that ended with `status`.
[[nodiscard]] Error failure(const std::string& step, Status status);

}  // namespace palpate::devices::usb
