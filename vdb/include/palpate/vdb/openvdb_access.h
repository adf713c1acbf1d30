#pragma once
/// The OpenVDB grid behind a LevelSet, for code that knows OpenVDB. This header includes
/// openvdb/openvdb.h, with its compile time; palpate/vdb/level_set.h does not.

#include <openvdb/openvdb.h>

#include <map>
#include <string>

#include "palpate/export.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// What a LevelSet refers to. Immutable once the LevelSet is made.
struct LevelSet::Impl {
  openvdb::FloatGrid::ConstPtr grid;  ///< never null; world coordinates and values in length_unit
  LevelSetInfo info;                  ///< of `grid`
  Vec3 origin{0.0, 0.0, 0.0};         ///< [m] center of voxel (0, 0, 0)
};

/// openvdb::initialize(), once in a process and from any thread.
PALPATE_EXPORT void initializeOpenVdb();

/// Takes over `grid`: marks it as a level set, writes `length_unit`, the version of palpate and
/// `metadata` into it, and checks it once. Values and world coordinates must be in `length_unit`;
/// inactive voxels must hold +background outside and -background inside. Afterwards nobody else may
/// write to the grid's tree.
/// @throws Error (kInput): unknown unit, background not positive, a transform that is not a
/// positive uniform scale and a translation.
[[nodiscard]] PALPATE_EXPORT LevelSet
makeLevelSet(openvdb::FloatGrid::Ptr grid, const std::string& length_unit,
             const std::map<std::string, std::string>& metadata = {});

}  // namespace palpate::vdb
