#include <dirent.h>

#include <algorithm>
#include <cerrno>
#include <charconv>

#include "evdev/event_node.h"
#include "palpate/devices/evdev.h"

namespace palpate::devices {
namespace {

constexpr const char* kFolder = "/dev/input";

/// The numbers of the event nodes, ascending.
std::vector<int> eventNumbers() {
  std::vector<int> out;
  DIR* folder = opendir(kFolder);
  if (folder == nullptr) return out;
  constexpr std::string_view kPrefix = "event";
  while (const dirent* entry = ::readdir(folder)) {
    const std::string_view name(entry->d_name);
    if (name.substr(0, kPrefix.size()) != kPrefix) continue;
    int number = 0;
    const char* const end = name.data() + name.size();
    const auto read = std::from_chars(name.data() + kPrefix.size(), end, number);
    if (read.ec == std::errc() && read.ptr == end) out.push_back(number);
  }
  closedir(folder);
  std::sort(out.begin(), out.end());
  return out;
}

}  // namespace

std::string_view nameOf(InputKind kind) noexcept {
  if (kind == InputKind::kSpaceMouse) return "SpaceMouse";
  return kind == InputKind::kGamepad ? "gamepad" : "mouse";
}

std::vector<InputDevice> listInputDevices() {
  std::vector<InputDevice> out;
  for (const int number : eventNumbers()) {
    InputDevice device;
    device.node = std::string(kFolder) + "/event" + std::to_string(number);
    evdev::EventNode node;
    const int error = node.open(device.node);
    // Other errors mean that it was unplugged since the folder was read.
    if (error != 0 && error != EACCES && error != EPERM) continue;
    device.is_accessible = error == 0;
    if (device.is_accessible) {
      device.name = node.name();
      if (const auto has = node.capabilities()) {
        if (const auto map = evdev::mapOf(*has)) device.kind = map->kind;
      }
    }
    out.push_back(std::move(device));
  }
  return out;
}

std::string inputAccessRemedy() {
  return "join the group input (usermod -aG input USER) and log in anew; or write to "
         "/etc/udev/rules.d/70-haptics.rules:\n"
         "    SUBSYSTEM==\"input\", KERNEL==\"event*\", ENV{ID_INPUT_KEYBOARD}!=\"1\", "
         "TAG+=\"uaccess\"\n"
         "  then: udevadm control --reload, and plug the device in again. The group lets programs "
         "see every key that anybody presses; the rule leaves out keyboards";
}

}  // namespace palpate::devices
