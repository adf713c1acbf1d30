#include "doctor/device_findings.h"

#include "palpate/core/error.h"
#include "palpate/devices/device_access.h"
#include "palpate/devices/evdev.h"
#include "palpate/devices/falcon.h"
#include "palpate/devices/inverse3.h"
#include "palpate/devices/plugins.h"
#include "palpate/devices/usb_devices.h"

namespace palpate::tools {
namespace {

std::string ruleText(std::uint16_t vendor, std::uint16_t product) {
  return "write to /etc/udev/rules.d/70-haptics.rules:\n    " + devices::udevRule(vendor, product) +
         "\n  then: udevadm control --reload, and plug the device in again";
}

std::vector<DeviceFinding> falcons() {
  DeviceFinding none{"falcon", "Novint Falcon, USB 0403:cb48", "", false, ""};
  if (!devices::hasLibusb()) {
    none.found = "not in this build";
    none.remedy = "install libusb-1.0-0-dev and build palpate again";
    return {none};
  }
  std::vector<DeviceFinding> out;
  try {
    for (const devices::UsbDevice& usb : devices::listUsbDevices()) {
      if (usb.vendor != devices::kFalconVendor || usb.product != devices::kFalconProduct) continue;
      DeviceFinding one = none;
      one.found = "bus " + std::to_string(usb.bus) + ", address " + std::to_string(usb.address) +
                  (usb.serial.empty() ? "" : ", serial " + usb.serial);
      one.is_ready = usb.is_accessible;
      if (!usb.is_accessible) {
        one.found += ", access denied";
        one.remedy = ruleText(usb.vendor, usb.product);
      }
      out.push_back(std::move(one));
    }
  } catch (const Error& error) {
    none.found = error.problem().message;
    none.remedy = error.problem().hint;
    return {none};
  }
  if (!out.empty()) return out;
  none.found = "none plugged in";
  return {none};
}

/// The usable input devices, and one finding for all those that this user may not open.
std::vector<DeviceFinding> inputs() {
  const DeviceFinding none{"evdev", "SpaceMouse, gamepad or mouse, /dev/input/event*",
                           "",      false,
                           "",      devices::kEvdevNotice};
  std::vector<DeviceFinding> out;
  int denied = 0;
  for (const devices::InputDevice& each : devices::listInputDevices()) {
    if (!each.is_accessible) ++denied;
    if (!each.kind) continue;
    DeviceFinding one = none;
    one.name = "evdev:" + each.node;
    one.title = std::string(devices::nameOf(*each.kind)) + ", " + each.name;
    one.found = each.node;
    one.is_ready = true;
    out.push_back(std::move(one));
  }
  if (denied > 0) {
    DeviceFinding one = none;
    one.found = std::to_string(denied) + " input devices of any kind, access denied";
    one.remedy = devices::inputAccessRemedy();
    out.push_back(std::move(one));
  }
  if (!out.empty()) return out;
  out.push_back(none);
  out.back().found = "none plugged in";
  return out;
}

}  // namespace

std::vector<DeviceFinding> deviceFindings() {
  std::vector<DeviceFinding> out = falcons();
  const bool has_service = devices::hasInverseService({});
  out.push_back({"inverse3", "Haply Inverse3, service at 127.0.0.1:10001",
                 has_service ? "something listens there" : "nothing listens there", has_service,
                 has_service ? "" : "install and start Haply's Inverse Service"});
  const auto library = [&](const char* name, const char* title, bool is_there, const char* remedy) {
    out.push_back({name, title, is_there ? "library found" : "library not found", is_there,
                   is_there ? "" : remedy});
  };
  library("hd", "3D Systems Touch, Phantom; OpenHaptics, libHD.so", devices::hasOpenHaptics({}),
          "install OpenHaptics from 3D Systems, or give --library FILE");
  library("dhd", "Force Dimension; libdhd.so", devices::hasForceDimension({}),
          "install Force Dimension's SDK, or give --library FILE");
  for (DeviceFinding& each : inputs()) out.push_back(std::move(each));
  return out;
}

Json findingsJson(const std::vector<DeviceFinding>& findings) {
  Json out = Json::array();
  for (const DeviceFinding& f : findings) {
    out.push_back({{"name", f.name},
                   {"title", f.title},
                   {"found", f.found},
                   {"ready", f.is_ready},
                   {"remedy", f.remedy.empty() ? Json() : Json(f.remedy)},
                   {"notice", f.notice}});
  }
  return out;
}

std::string findingsText(const std::vector<DeviceFinding>& findings) {
  std::string text;
  for (const DeviceFinding& f : findings) {
    text += f.name + std::string(f.name.size() < 12 ? 12 - f.name.size() : 1, ' ') + f.title +
            "\n" + "            " + f.found + (f.is_ready ? ": ready" : "") + "\n" +
            "            " + f.notice + "\n";
    if (!f.remedy.empty()) text += "  " + f.remedy + "\n";
  }
  return text;
}

}  // namespace palpate::tools
