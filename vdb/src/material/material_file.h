#pragma once
/// Material grids as OpenVDB stores them: fog volumes with the unit of their values in the
/// metadata.

#include <openvdb/openvdb.h>

#include "palpate/vdb/material_grid.h"

namespace palpate::vdb {

/// A grid with the voxels of the map, bit for bit; its metadata says how they are quantized.
[[nodiscard]] openvdb::FloatGrid::Ptr toOpenVdb(const NamedMaterialGrid& named);

}  // namespace palpate::vdb
