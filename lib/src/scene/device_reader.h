#pragma once
/// The scene's `device`: how the device's space is placed in the world.

#include "palpate/scene/description.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// @throws Error (kInput) at the offending place.
[[nodiscard]] DeviceMapping readDevice(const MapReader& reader);

}  // namespace palpate
