#pragma once
// The requests of an FTDI FT232R, and the bytes that it puts before those of the device. Facts from
// libftdi and libnifalcon.

#include <algorithm>
#include <cstdint>
#include <initializer_list>
#include <span>

#include "usb/transport.h"

namespace palpate::devices::usb {

struct FtdiRequest {
  std::uint8_t request;
  std::uint16_t value;
};

namespace ftdi {
constexpr FtdiRequest kPurgeIn = {0, 1};
constexpr FtdiRequest kPurgeOut = {0, 2};
constexpr FtdiRequest kDtrHigh = {1, 0x0101};
constexpr FtdiRequest kDtrLow = {1, 0x0100};
constexpr FtdiRequest kRtsLow = {1, 0x0200};
constexpr FtdiRequest kFlowOff = {2, 0};
constexpr FtdiRequest kBaud9600 = {3, 0x4138};   // 3 MHz / 312.5
constexpr FtdiRequest kBaud143k = {3, 0x0015};   // 3 MHz / 21
constexpr FtdiRequest kBaud1500k = {3, 0x0002};  // 3 MHz / 2
constexpr FtdiRequest k8N1 = {4, 0x0008};
constexpr FtdiRequest kLatency16ms = {9, 16};
constexpr FtdiRequest kLatency1ms = {9, 1};

/// Each packet from the chip begins with the state of its modem lines.
constexpr std::size_t kStatusBytes = 2;
}  // namespace ftdi

/// Sends the requests one after the other until one fails.
[[nodiscard]] inline Status control(Transport& transport,
                                    std::initializer_list<FtdiRequest> requests) noexcept {
  for (const FtdiRequest& r : requests) {
    if (const Status s = transport.control(r.request, r.value); s != Status::kOk) return s;
  }
  return Status::kOk;
}

/// The device's bytes in one packet.
[[nodiscard]] inline std::span<const std::uint8_t> payload(
    std::span<const std::uint8_t> packet) noexcept {
  return packet.subspan(std::min(packet.size(), ftdi::kStatusBytes));
}

}  // namespace palpate::devices::usb
