#ifdef PALPATE_LIBUSB

#include "usb/libusb_list.h"

#include <libusb.h>

#include <array>
#include <cstdio>
#include <span>

#include "palpate/devices/usb_devices.h"

namespace palpate::devices::usb {
namespace {

std::string serialOf(libusb_device_handle* handle, const libusb_device_descriptor& about) {
  std::array<unsigned char, 128> text{};
  if (about.iSerialNumber == 0) return "";
  const int n = libusb_get_string_descriptor_ascii(handle, about.iSerialNumber, text.data(),
                                                   static_cast<int>(text.size()));
  return n > 0 ? std::string(text.begin(), text.begin() + n) : "";
}

std::string hex(std::uint16_t vendor, std::uint16_t product) {
  std::array<char, 16> text{};
  (void)std::snprintf(text.data(), text.size(), "%04x:%04x", vendor, product);
  return text.data();
}

/// Owns a list made by libusb.
class List {
 public:
  explicit List(libusb_context* context) : size_(libusb_get_device_list(context, &devices_)) {}
  ~List() {
    if (devices_ != nullptr) libusb_free_device_list(devices_, 1);
  }
  List(const List&) = delete;
  List& operator=(const List&) = delete;
  [[nodiscard]] std::span<libusb_device* const> devices() const noexcept {
    return {devices_, size_ > 0 ? static_cast<std::size_t>(size_) : 0};
  }

 private:
  libusb_device** devices_ = nullptr;
  ssize_t size_;
};

}  // namespace

Context::Context(bool is_blind) {
  // libusb offers this option only for all later contexts together.
  if (is_blind) (void)libusb_set_option(nullptr, LIBUSB_OPTION_NO_DEVICE_DISCOVERY);
  if (const int error = libusb_init(&context_); error != 0) {
    throw openError(error, "start libusb");
  }
}

Context::~Context() { libusb_exit(context_); }

Error openError(int error, const std::string& step) {
  std::string code = "device.usb";
  std::string hint = "plug the device in";
  if (error == LIBUSB_ERROR_ACCESS) {
    code = "device.access";
    hint = "`palpate devices` prints the udev rule that permits it";
  } else if (error == LIBUSB_ERROR_BUSY) {
    code = "device.busy";
    hint = "another program uses it: close that";
  } else if (error == LIBUSB_ERROR_NO_DEVICE) {
    code = "device.disconnected";
    hint = "plug the device in again";
  }
  return {
      ErrorKind::kDevice,
      {code, "cannot " + step + ": " + libusb_strerror(static_cast<libusb_error>(error)), hint}};
}

libusb_device_handle* openHandle(libusb_context* context, const Choice& choice) {
  libusb_device_handle* handle = nullptr;
  if (choice.descriptor >= 0) {
    const int error = libusb_wrap_sys_device(context, choice.descriptor, &handle);
    if (error != 0) throw openError(error, "use the descriptor of the device");
    return handle;
  }
  int refused = 0;
  const List list(context);
  for (libusb_device* device : list.devices()) {
    libusb_device_descriptor about{};
    if (libusb_get_device_descriptor(device, &about) != 0) continue;
    if (about.idVendor != choice.vendor || about.idProduct != choice.product) continue;
    if (const int error = libusb_open(device, &handle); error != 0) {
      refused = error;
      continue;
    }
    if (choice.serial.empty() || serialOf(handle, about) == choice.serial) return handle;
    libusb_close(handle);
  }
  if (refused != 0) throw openError(refused, "open the device");
  throw Error(ErrorKind::kDevice,
              {"device.none",
               "there is no device " + hex(choice.vendor, choice.product) +
                   (choice.serial.empty() ? "" : " with the serial number " + choice.serial),
               "plug it in"});
}

}  // namespace palpate::devices::usb

namespace palpate::devices {

std::vector<UsbDevice> listUsbDevices() {
  std::vector<UsbDevice> out;
  const usb::Context context(false);
  const usb::List list(context.get());
  for (libusb_device* device : list.devices()) {
    libusb_device_descriptor about{};
    if (libusb_get_device_descriptor(device, &about) != 0) continue;
    UsbDevice one;
    one.vendor = about.idVendor;
    one.product = about.idProduct;
    one.bus = libusb_get_bus_number(device);
    one.address = libusb_get_device_address(device);
    libusb_device_handle* handle = nullptr;
    const int error = libusb_open(device, &handle);
    if (error == 0) {
      one.serial = usb::serialOf(handle, about);
      libusb_close(handle);
    }
    one.is_accessible = error == 0;
    out.push_back(std::move(one));
  }
  return out;
}

bool hasLibusb() noexcept { return true; }

}  // namespace palpate::devices

#else

#include "palpate/devices/usb_devices.h"

namespace palpate::devices {

std::vector<UsbDevice> listUsbDevices() { return {}; }
bool hasLibusb() noexcept { return false; }

}  // namespace palpate::devices

#endif
