#pragma once
// What the Inverse Service says and wants to hear. Needs PALPATE_INVERSE3.

#include <optional>
#include <string>
#include <string_view>

#include "palpate/devices/device.h"

namespace palpate::devices::inverse3 {

struct Message {
  std::string id;     ///< of the device
  DeviceState state;  ///< its position and velocity
};

/// The device `id` (empty: the first) in a message of the service. None if the message is not of
/// its kind, or not sound.
[[nodiscard]] std::optional<Message> readMessage(std::string_view text, const std::string& id);

/// Asks for `force` [N] at the cursor.
[[nodiscard]] std::string forceMessage(const std::string& id, const Vec3& force);

}  // namespace palpate::devices::inverse3
