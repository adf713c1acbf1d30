#include "usb/transport.h"

namespace palpate::devices::usb {

std::string_view textOf(Status status) noexcept {
  switch (status) {
    case Status::kOk:
      return "done";
    case Status::kTimeout:
      return "no answer in time";
    case Status::kGone:
      return "the device is gone";
    case Status::kStall:
      return "the device refused the transfer";
    case Status::kOverflow:
      return "the device sent too much";
    case Status::kError:
      break;
  }
  return "the transfer failed";
}

Error failure(const std::string& step, Status status) {
  std::string hint = "unplug the device, plug it in again, and check its cable and power supply";
  if (status == Status::kGone) hint = "plug the device in again";
  return {ErrorKind::kDevice,
          {status == Status::kGone ? "device.disconnected" : "device.usb",
           step + ": " + std::string(textOf(status)), hint}};
}

}  // namespace palpate::devices::usb
