#pragma once
// The messages from and to the Inverse Service. Needs PALPATE_INVERSE3.

#include <optional>
#include <string>
#include <string_view>

#include "palpate/devices/device.h"

namespace palpate::devices::inverse3 {

struct Message {
  std::string id;     ///< of the device
  DeviceState state;  ///< its position and velocity
};

/// Reads the device `id` (empty: the first) from a message of the service. No value if the message
/// is of another kind, or not sound.
[[nodiscard]] std::optional<Message> readMessage(std::string_view text, const std::string& id);

/// The message that requests `force` [N] at the cursor.
[[nodiscard]] std::string forceMessage(const std::string& id, const Vec3& force);

}  // namespace palpate::devices::inverse3
