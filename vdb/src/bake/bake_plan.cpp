#include "bake/bake_plan.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>

#include "palpate/core/text.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/openvdb_access.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

/// The larger the size, the fewer digits.
std::string roughlyInGigabytes(double bytes) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1f GB", bytes * 1e-9);
  return bytes < 1e8 ? inGigabytes(bytes) : text;
}

/// Rounded up to two significant digits: a number that a person would type.
double roundedUp(double value) {
  const double unit = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return std::ceil(value / unit) * unit;
}

bool hasNegativeVoxel(const openvdb::FloatGrid& grid) {
  for (auto value = grid.cbeginValueAll(); value; ++value) {
    if (*value < 0.0F) return true;
  }
  return false;
}

}  // namespace

std::uint64_t memoryLimit(std::uint64_t max_memory) {
  if (max_memory > 0) return max_memory;
  const auto bytes =
      static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGESIZE));
  return static_cast<std::uint64_t>(0.8 * bytes);
}

BakePlan checkOptions(const BakeOptions& options) {
  if (!(options.voxel_size > 0.0) || !std::isfinite(options.voxel_size)) {
    throw inputError("bake.voxel_size", "the voxel size is " + inMillimeters(options.voxel_size) +
                                            "; it must be a positive length");
  }
  if (!(options.half_width >= 2.0 && options.half_width <= 1000.0)) {
    throw inputError("bake.half_width", "the band's half width is " +
                                            shortNumber(options.half_width, 6) +
                                            " voxels; it must be from 2 to 1000");
  }
  if (options.box && !options.box->isBounded()) {
    throw inputError("bake.box", "the box to bake in is empty or infinite",
                     "give it two finite corners, the lower one first");
  }
  const std::optional<double> meters = metersPer(options.length_unit);
  if (!meters) {
    throw inputError("unit.unknown", "unknown length unit '" + options.length_unit + "'",
                     "use m, cm, mm or um");
  }
  // OpenVDB rejects a transform whose determinant is below 3e-15 as singular.
  constexpr double kLeastVoxel = 1.5e-5;  // [units]
  if (options.voxel_size < kLeastVoxel * *meters) {
    throw inputError("bake.voxel_size",
                     "the voxel size is " + inMillimeters(options.voxel_size) + "; a grid in " +
                         options.length_unit + " holds voxels of " +
                         inMillimeters(kLeastVoxel * *meters) + " and more",
                     "check the length unit; or write the grid in a smaller unit");
  }
  BakePlan plan;
  plan.voxel = options.voxel_size;
  plan.half_width = options.half_width;
  plan.band = options.half_width * options.voxel_size;
  plan.meters_per_unit = *meters;
  plan.background = static_cast<float>(plan.band / *meters);
  plan.max_memory = memoryLimit(options.max_memory);
  return plan;
}

openvdb::CoordBBox voxelRange(const Box3& bounds, const BakePlan& plan, const std::string& name) {
  openvdb::CoordBBox range;
  for (int axis = 0; axis < 3; ++axis) {
    const double lo = std::floor((bounds.lo[axis] - plan.band) / plan.voxel);
    const double hi = std::ceil((bounds.hi[axis] + plan.band) / plan.voxel);
    constexpr double kMost = 1 << 29;
    if (!(std::max(std::abs(lo), std::abs(hi)) < kMost)) {
      throw Error(ErrorKind::kOperation,
                  {"bake.too_fine",
                   "'" + name + "' reaches more than 2^29 voxels of " + inMillimeters(plan.voxel) +
                       " from the origin",
                   "use larger voxels; also check that the shape has the length unit it should"});
    }
    range.min()[axis] = static_cast<int>(lo);
    range.max()[axis] = static_cast<int>(hi);
  }
  return range;
}

openvdb::FloatGrid::Ptr emptyGrid(const BakePlan& plan, const BakeOptions& options) {
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(plan.background);
  grid->setTransform(
      openvdb::math::Transform::createLinearTransform(plan.voxel / plan.meters_per_unit));
  grid->setName(options.name);
  return grid;
}

LevelSet finishGrid(openvdb::FloatGrid::Ptr grid, const BakePlan& plan,
                    const BakeOptions& options) {
  if (!hasNegativeVoxel(*grid)) {
    throw inputError("bake.empty",
                     "no voxel of '" + options.name +
                         "' lies inside: the shape is empty, or thinner "
                         "than voxels of " +
                         inMillimeters(plan.voxel) + " can hold",
                     "use voxels smaller than a third of the thinnest part; a shape far too small "
                     "may have been read in the wrong length unit");
  }
  auto metadata = options.metadata;
  metadata.try_emplace("frame", "world");
  return makeLevelSet(std::move(grid), options.length_unit, metadata);
}

LevelSet withLostParts(const LevelSet& grid, const std::string& lost) {
  return lost.empty() ? grid : grid.named(grid.info().name, {{"lost_parts", lost}});
}

void requireMemory(double area, double margin, const BakePlan& plan) {
  using Tree = openvdb::FloatTree;
  using Leaf = Tree::LeafNodeType;
  using Lower = Tree::RootNodeType::ChildNodeType::ChildNodeType;
  using Upper = Tree::RootNodeType::ChildNodeType;
  // The number of cubes of a given side that touch the band: cubes whose half diagonal reaches it,
  // on both sides of the surface.
  const auto touched = [&](double side) {
    return area * (std::sqrt(3.0) * (side - 1.0) + 2.0 * plan.half_width) / std::pow(side, 3.0);
  };
  // However small the grid is, it has a few of the upper nodes: the eight around the origin.
  const double fixed = 8.0 * sizeof(Upper);
  const double growing = touched(Leaf::DIM) * (sizeof(Leaf) + Leaf::SIZE * sizeof(float)) +
                         touched(Lower::DIM) * sizeof(Lower) + touched(Upper::DIM) * sizeof(Upper);
  const auto limit = static_cast<double>(plan.max_memory);
  if (growing + fixed <= margin * limit) return;
  std::string hint = "allow more than " + roughlyInGigabytes(2.0 * fixed);
  if (limit > 2.0 * fixed) {
    const double fits = 1.1 * plan.voxel * std::sqrt(growing / (limit - fixed));
    hint = "voxels of " + inMillimeters(roundedUp(fits)) +
           " should fit; also check that the shape has the length unit it should";
  }
  throw Error(ErrorKind::kOperation, {"bake.memory",
                                      "voxels of " + inMillimeters(plan.voxel) + " need about " +
                                          roughlyInGigabytes(growing + fixed) + "; " +
                                          roughlyInGigabytes(limit) + " are allowed",
                                      hint});
}

}  // namespace palpate::vdb
