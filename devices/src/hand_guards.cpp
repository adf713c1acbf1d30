#include "palpate/devices/hand_guards.h"

#include "palpate/core/error.h"
#include "palpate/devices/coupling_design.h"

namespace palpate::devices {
namespace {

PassivitySettings passivityOf(const PassivityRequest& asked, const std::optional<LoopModel>& loop,
                              double period) {
  if (!asked.mass && !loop) {
    throw Error(ErrorKind::kUsage, {"passivity.mass", "'passivity' needs the mass of the device",
                                    "say which device it is, or give 'mass' in 'passivity'"});
  }
  const DeviceModel known = loop ? loop->device : DeviceModel{};
  PassivitySettings out;
  out.mass = asked.mass.value_or(known.mass);
  out.damping = asked.damping.value_or(known.damping);
  out.friction = asked.friction.value_or(known.friction);
  out.encoder = asked.encoder.value_or(known.encoder);
  out.max_force = known.max_force;
  out.period = period;
  out.delay = loop ? loop->delay : 0;
  out.controls = asked.controls;
  out.hand_force = asked.hand_force;
  return out;
}

CouplingSettings couplingOf(const CouplingRequest& asked, const std::optional<LoopModel>& loop,
                            double period) {
  if (asked.stiffness) return {*asked.stiffness, asked.damping};
  if (!loop) {
    throw Error(ErrorKind::kUsage,
                {"coupling.device", "a coupling without a 'stiffness' is designed for a device",
                 "say which device it is, or give 'stiffness' in 'coupling'"});
  }
  LoopModel now = *loop;
  now.period = period;
  return asked.design == CouplingRequest::For::kAnyScene ? couplingForAnyScene(now)
                                                         : couplingForSprings(now);
}

}  // namespace

HandGuards guardsOf(const DeviceMapping& asked, const std::optional<LoopModel>& loop,
                    double period) {
  HandGuards out;
  if (asked.passivity) out.passivity = passivityOf(*asked.passivity, loop, period);
  if (asked.coupling) out.coupling = couplingOf(*asked.coupling, loop, period);
  return out;
}

}  // namespace palpate::devices
