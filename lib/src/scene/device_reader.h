#pragma once
/// The scene's `device`: how a device's space lies in the world.

#include "palpate/scene/description.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// @throws Error (kInput) at the offending place.
[[nodiscard]] DeviceMapping readDevice(const MapReader& reader);

}  // namespace palpate
