#pragma once
// The devices that libusb finds, and how one of them is opened. Needs PALPATE_LIBUSB.

#include <string>

#include "palpate/core/error.h"
#include "usb/transport.h"

struct libusb_context;
struct libusb_device_handle;

namespace palpate::devices::usb {

/// Owns a context of libusb.
class Context {
 public:
  /// `is_blind`: it does not search for devices, which suits a device opened by its descriptor.
  /// @throws Error (kDevice).
  explicit Context(bool is_blind);
  ~Context();
  Context(const Context&) = delete;
  Context& operator=(const Context&) = delete;
  [[nodiscard]] libusb_context* get() const noexcept { return context_; }

 private:
  libusb_context* context_ = nullptr;
};

/// @throws Error (kDevice).
[[nodiscard]] libusb_device_handle* openHandle(libusb_context* context, const Choice& choice);

/// The message for an error of libusb at set-up, with a remedy.
[[nodiscard]] Error openError(int error, const std::string& step);

}  // namespace palpate::devices::usb
