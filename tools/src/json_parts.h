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

[[nodiscard]] inline Json materialJson(const Material& m) {
  return {
      {"name", m.name},
      {"stiffness_N_per_m", m.stiffness},
      {"damping_Ns_per_m", m.damping},
      {"friction", {{"static", m.friction.static_ratio}, {"kinetic", m.friction.kinetic_ratio}}},
      {"texture", {{"amplitude_m", m.texture.amplitude}, {"wavelength_m", m.texture.wavelength}}},
      {"shading_m", m.shading},
      {"viscosity_Ns_per_m", m.viscosity},
      {"flow_m_per_s", vectorJson(m.flow)}};
}

}  // namespace palpate::tools
