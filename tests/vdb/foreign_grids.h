#pragma once
// Grids as other tools make them, and damaged ones, each from a seed.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>

#include "palpate/fields/field.h"

namespace palpate::vdb::test {

struct ForeignGrid {
  std::string how;               ///< shape, maker and damage
  openvdb::FloatGrid::Ptr grid;  ///< in mm
  FieldPtr truth;                ///< [m] the field that the grid represents
  Vec3 damage{0.0};              ///< [m] place of the damage, if there is any
  bool is_damaged = false;
};

/// The same number gives the same grid: a ball, a ring, a box, or two balls in one, made by our
/// bake or by OpenVDB's tools; half of them have one of a dozen kinds of damage, from a single
/// value to the whole band.
[[nodiscard]] ForeignGrid foreignGrid(std::uint64_t seed);

/// Writes the grid with OpenVDB, with `length_unit: mm`.
void writeAsOthers(const std::string& path, const openvdb::FloatGrid::Ptr& grid);

}  // namespace palpate::vdb::test
