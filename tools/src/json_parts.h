#pragma once
/// JSON values that several verbs print.

#include <cmath>

#include "palpate/core/math.h"
#include "palpate/materials/material.h"
#include "palpate/vdb/material_grid.h"
#include "report.h"

namespace palpate::tools {

[[nodiscard]] inline Json vectorJson(const Vec3& v) { return Json::array({v.x, v.y, v.z}); }

/// {"lo": [..], "hi": [..]}, or null if empty. Infinite ends become null, as JSON has no infinity.
[[nodiscard]] inline Json boxJson(const Box3& box) {
  if (box.isEmpty()) return {};
  return {{"lo", vectorJson(box.lo)}, {"hi", vectorJson(box.hi)}};
}

/// The number. If it varies from place to place: {"least": .., "most": ..}, or, if a point [m] is
/// given, its value there.
[[nodiscard]] inline Json parameterJson(const Parameter& parameter, const Vec3* at = nullptr) {
  if (at != nullptr) return parameter.at(*at);
  const MaterialMap::Range range = parameter.range();
  if (parameter.isConstant()) return range.least;
  return {{"least", range.least}, {"most", range.most}};
}

[[nodiscard]] inline Json shaftJson(const ShaftFriction::Way& way, const Vec3* at) {
  return {{"static_N_per_m", parameterJson(way.static_force, at)},
          {"kinetic_N_per_m", parameterJson(way.kinetic_force, at)},
          {"damping_Ns_per_m2", parameterJson(way.damping, at)}};
}

/// The source of a map of voxels, and how it is stored.
[[nodiscard]] inline Json mapJson(const vdb::MaterialGrid& grid) {
  const vdb::MaterialGridInfo& info = grid.info();
  return {{"source", info.source},           {"least", grid.range().least},
          {"most", grid.range().most},       {"size", info.size},
          {"voxel_size_m", info.voxel_size}, {"bounds_m", boxJson(info.bounds)},
          {"bits", info.quantisation.bits},  {"error", info.quantisation.error},
          {"memory_bytes", info.memory}};
}

[[nodiscard]] inline Json materialJson(const Material& m, const Vec3* at = nullptr) {
  return {
      {"name", m.name},
      {"stiffness_N_per_m", parameterJson(m.stiffness, at)},
      {"damping_Ns_per_m", parameterJson(m.damping, at)},
      {"friction",
       {{"static", parameterJson(m.friction.static_ratio, at)},
        {"kinetic", parameterJson(m.friction.kinetic_ratio, at)}}},
      {"texture",
       {{"amplitude_m", parameterJson(m.texture.amplitude, at)},
        {"wavelength_m", m.texture.wavelength}}},
      {"composite", {{"radius_m", m.composite.radius}, {"depth_m", m.composite.depth}}},
      {"shading_m", m.shading},
      {"viscosity_Ns_per_m", parameterJson(m.viscosity, at)},
      {"flow_m_per_s",
       {parameterJson(m.flow.x, at), parameterJson(m.flow.y, at), parameterJson(m.flow.z, at)}},
      {"curve",
       {{"stiffening_N_per_m2", parameterJson(m.curve.stiffening, at)},
        {"exponent", m.curve.exponent},
        {"reference_m", m.curve.reference}}},
      {"maxwell",
       {{"stiffness_N_per_m", parameterJson(m.maxwell.stiffness, at)}, {"time_s", m.maxwell.time}}},
      {"lattice",
       {{"force_N", parameterJson(m.lattice.force, at)},
        {"wavelength_m", vectorJson(m.lattice.wavelength)},
        {"origin_m", vectorJson(m.lattice.origin)}}},
      {"cutting_N", parameterJson(m.cutting, at)},
      {"shaft",
       {{"stiffness_N_per_m2", m.shaft.stiffness},
        {"stick_speed_m_per_s", m.shaft.stick_speed},
        {"in", shaftJson(m.shaft.in, at)},
        {"out", shaftJson(m.shaft.out, at)},
        {"lateral_stiffness_N_per_m2", m.shaft.lateral.stiffness},
        {"lateral_strength_N_per_m",
         std::isfinite(m.shaft.lateral.strength) ? Json(m.shaft.lateral.strength) : Json()}}}};
}

}  // namespace palpate::tools
