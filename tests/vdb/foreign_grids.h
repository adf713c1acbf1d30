#pragma once
// Grids as others make them, and damaged ones, each from a seed.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>

#include "palpate/fields/field.h"

namespace palpate::vdb::test {

struct ForeignGrid {
  std::string how;               ///< shape, maker and damage
  openvdb::FloatGrid::Ptr grid;  ///< in mm
  FieldPtr truth;                ///< what it is of [m]
  Vec3 damage{0.0};              ///< [m] where it is damaged, if it is
  bool is_damaged = false;
};

/// The same for the same number: a ball, a ring, a box, two balls in one; by our bake or by
/// OpenVDB's tools; half of them damaged in one of a dozen ways, from a single value to the whole
/// band.
[[nodiscard]] ForeignGrid foreignGrid(std::uint64_t seed);

/// Writes it as OpenVDB does, with `length_unit: mm`.
void writeAsOthers(const std::string& path, const openvdb::FloatGrid::Ptr& grid);

}  // namespace palpate::vdb::test
