#pragma once
/// The inside of a band whose voxels beyond it do not tell.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <string>

namespace palpate::vdb {

/// How many voxels that are not active changed sides.
/// @throws Error (kInput, vdb.torn) where a hole in the band joins inside and outside; `path` is
/// the file to name. `grid` is then of no use.
std::uint64_t markInside(openvdb::FloatGrid& grid, double meters_per_unit, const std::string& path);

}  // namespace palpate::vdb
