#pragma once
/// Material grids as OpenVDB's: fog volumes with the unit of their values in the metadata.

#include <openvdb/openvdb.h>

#include "palpate/vdb/material_grid.h"

namespace palpate::vdb {

/// Its voxels are those of the map, bit for bit; the metadata says how they are stored.
[[nodiscard]] openvdb::FloatGrid::Ptr toOpenVdb(const NamedMaterialGrid& named);

}  // namespace palpate::vdb
