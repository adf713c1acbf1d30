#pragma once
/// Sets the signs of voxels beyond a band, where the file did not mark the inside.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>

namespace palpate::vdb {

/// Returns how many voxels that are not active changed sides.
/// @throws Error (kInput, vdb.torn) where a hole in the band joins inside and outside; `path` is
/// the file to name. `grid` is then unusable.
std::uint64_t markInside(openvdb::FloatGrid& grid, double meters_per_unit, const std::string& path);

}  // namespace palpate::vdb
