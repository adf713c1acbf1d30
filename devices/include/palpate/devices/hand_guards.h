#pragma once
/// What a scene asks of the loop that holds its device, with the numbers of the device that is
/// there.

#include <optional>

#include "palpate/devices/passivity.h"
#include "palpate/devices/stability.h"
#include "palpate/devices/virtual_coupling.h"
#include "palpate/export.h"
#include "palpate/scene/description.h"

namespace palpate::devices {

/// For SessionSettings.
struct HandGuards {
  std::optional<PassivitySettings> passivity = {};
  std::optional<CouplingSettings> coupling = {};
};

/// What `asked` of passivity and a coupling comes to in a loop of `period` [s]. What it does not
/// say comes from the device and the delay of `loop`. @throws Error (kUsage, passivity.mass,
/// coupling.device) if that is not given and needed.
[[nodiscard]] PALPATE_EXPORT HandGuards guardsOf(const DeviceMapping& asked,
                                                 const std::optional<LoopModel>& loop,
                                                 double period);

}  // namespace palpate::devices
