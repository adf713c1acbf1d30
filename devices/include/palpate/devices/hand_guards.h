#pragma once
/// The guards that a scene asks for in its device's loop, completed with the numbers of the actual
/// device.

#include <optional>

#include "palpate/devices/passivity.h"
#include "palpate/devices/stability.h"
#include "palpate/devices/virtual_coupling.h"
#include "palpate/export.h"
#include "palpate/scene/description.h"

namespace palpate::devices {

/// What guardsOf() returns, to be put into SessionSettings.
struct HandGuards {
  std::optional<PassivitySettings> passivity = {};  ///< no value: the scene asks for none
  std::optional<CouplingSettings> coupling = {};    ///< no value: the scene asks for none
};

/// The settings of passivity and coupling that `asked` means in a loop of `period` [s]. Numbers
/// that it does not give come from the device and the delay of `loop`. @throws Error (kUsage,
/// passivity.mass, coupling.device) if a number that is needed is not given by either.
[[nodiscard]] PALPATE_EXPORT HandGuards guardsOf(const DeviceMapping& asked,
                                                 const std::optional<LoopModel>& loop,
                                                 double period);

}  // namespace palpate::devices
