#pragma once
/// Pieces of JSON that several verbs print.

#include "palpate/core/math.h"
#include "palpate/materials/material.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] inline Json vectorJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// {"lo": [..], "hi": [..]}, or null if empty. Infinite ends become null, as JSON has no infinity.
[[nodiscard]] inline Json boxJson(const Box3& box) {
  if (box.isEmpty()) return {};
  return {{"lo", vectorJson(box.lo)}, {"hi", vectorJson(box.hi)}};
}

/// The number, or {"least": .., "most": ..} of one that differs from place to place.
[[nodiscard]] inline Json parameterJson(const Parameter& parameter) {
  const MaterialMap::Range range = parameter.range();
  if (parameter.isConstant()) return range.least;
  return {{"least", range.least}, {"most", range.most}};
}

[[nodiscard]] inline Json shaftJson(const ShaftFriction::Way& way) {
  return {{"static_N_per_m", parameterJson(way.static_force)},
          {"kinetic_N_per_m", parameterJson(way.kinetic_force)},
          {"damping_Ns_per_m2", parameterJson(way.damping)}};
}

[[nodiscard]] inline Json materialJson(const Material& m) {
  return {{"name", m.name},
          {"stiffness_N_per_m", parameterJson(m.stiffness)},
          {"damping_Ns_per_m", parameterJson(m.damping)},
          {"friction",
           {{"static", parameterJson(m.friction.static_ratio)},
            {"kinetic", parameterJson(m.friction.kinetic_ratio)}}},
          {"texture",
           {{"amplitude_m", parameterJson(m.texture.amplitude)},
            {"wavelength_m", m.texture.wavelength}}},
          {"shading_m", m.shading},
          {"viscosity_Ns_per_m", parameterJson(m.viscosity)},
          {"flow_m_per_s", vectorJson(m.flow)},
          {"curve",
           {{"stiffening_N_per_m2", parameterJson(m.curve.stiffening)},
            {"exponent", m.curve.exponent},
            {"reference_m", m.curve.reference}}},
          {"maxwell",
           {{"stiffness_N_per_m", parameterJson(m.maxwell.stiffness)}, {"time_s", m.maxwell.time}}},
          {"lattice",
           {{"force_N", parameterJson(m.lattice.force)},
            {"wavelength_m", vectorJson(m.lattice.wavelength)},
            {"origin_m", vectorJson(m.lattice.origin)}}},
          {"cutting_N", parameterJson(m.cutting)},
          {"shaft",
           {{"stiffness_N_per_m2", m.shaft.stiffness},
            {"stick_speed_m_per_s", m.shaft.stick_speed},
            {"in", shaftJson(m.shaft.in)},
            {"out", shaftJson(m.shaft.out)}}}};
}

}  // namespace palpate::tools
