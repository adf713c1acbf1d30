#pragma once
/// MaterialGrid: a parameter of a material that differs from voxel to voxel; from a .vdb file, or
/// from an image behind a transfer function.

#include <array>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/export.h"
#include "palpate/materials/material.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// How voxels were quantized to fewer bits: a voxel is least + step * count, count from 0 to 2^bits
/// - 1.
struct Quantisation {
  int bits = 32;       ///< 8 or 16; 32: floats, as they were given
  double least = 0.0;  ///< [SI unit]
  double step = 0.0;   ///< [SI unit]
  double error = 0.0;  ///< [SI unit] no voxel is off by more than this, nor is the spline anywhere
};

/// How a material grid is stored, for reports.
struct MaterialGridInfo {
  std::string source;         ///< the file or image it was made from, for reports
  std::array<int, 3> size{};  ///< voxels
  double voxel_size = 0.0;    ///< [m] the shortest step from voxel to voxel
  Box3 bounds;                ///< [m] of the voxels' centers
  Quantisation quantisation;  ///< how voxels are stored, and the error of that
  std::uint64_t memory = 0;   ///< [bytes]
};

/// A map from voxels: a quadratic B-spline whose coefficients are the voxels themselves, so that
/// its values stay between those of the nearest 27 voxels, value and gradient are continuous
/// everywhere, and values that are linear from voxel to voxel are reproduced exactly. It does not
/// pass through the voxels: where values curve, it is off by up to an eighth of the second
/// difference. Beyond half a voxel outside the outermost centers it is constant. Reading allocates
/// nothing and takes some 90 ns.
class PALPATE_EXPORT MaterialGrid final : public MaterialMap {
 public:
  /// Values in an image's order and place [SI unit]. A NaN voxel takes the mean of its neighbors,
  /// from the known voxels outwards. Stored in the fewest bits that put no voxel off by more than
  /// `tolerance` [SI unit]; 0: as floats. `max_memory` [bytes], 0: no limit.
  /// @throws Error (kInput) for no voxel that is a number; kOperation for memory.
  MaterialGrid(Image voxels, double tolerance, std::uint64_t max_memory = 0);
  /// With the quantization of an earlier run: if every voxel is exactly one of the steps of
  /// `known`, voxels are stored in these steps again.
  MaterialGrid(Image voxels, double tolerance, const Quantisation& known,
               std::uint64_t max_memory = 0);
  ~MaterialGrid() override;

  [[nodiscard]] Sample sample(const Vec3& p) const noexcept override;
  [[nodiscard]] double value(const Vec3& p) const noexcept override;
  [[nodiscard]] Range range() const noexcept override { return range_; }

  /// Constant after construction.
  [[nodiscard]] const MaterialGridInfo& info() const noexcept { return info_; }
  /// The voxels as they are stored, in an image's order and place.
  [[nodiscard]] Image voxels() const;

 private:
  struct Blocks;
  struct Place;

  [[nodiscard]] Place placeOf(const Vec3& p) const noexcept;
  template <typename OfData>
  [[nodiscard]] auto read(const OfData& of) const noexcept;
  void store(Image voxels, double tolerance, const Quantisation* known, std::uint64_t max_memory);

  MaterialGridInfo info_;
  Range range_;
  Mat3 axes_{1.0};            // the image's
  Vec3 origin_{0.0};          // [m]
  Mat3 to_index_{1.0};        // [1/m]
  Mat3 to_world_slope_{1.0};  // turns the gradient per voxel into the gradient per meter
  std::unique_ptr<const Blocks> blocks_;
};
using MaterialGridPtr = std::shared_ptr<const MaterialGrid>;  ///< shared and unchanging

/// Piecewise linear, constant beyond its ends: pairs of an image value and a parameter value [SI
/// unit], by rising image value.
using Transfer = std::vector<std::pair<double, double>>;

/// The image's voxels behind `transfer`, at the image's place.
/// @throws Error (kInput) for a transfer without points or that does not rise; as MaterialGrid().
[[nodiscard]] PALPATE_EXPORT MaterialGridPtr materialFromImage(const Image& image,
                                                               const Transfer& transfer,
                                                               double tolerance,
                                                               std::uint64_t max_memory = 0);

/// Which material grid of a file to read, and how.
struct MaterialGridRequest {
  std::string name;                    ///< may be empty if the file holds just one grid
  std::optional<Dimension> dimension;  ///< of the parameter; none: a ratio
  std::string unit_if_missing;         ///< of the values, where the file has no `unit`
  std::string length_unit_if_missing;  ///< of the coordinates, where the file names none
  double tolerance = 0.0;              ///< [SI unit]
  std::uint64_t max_memory = 0;        ///< [bytes]
};

/// Reads a fog volume of floats, with any linear transform. Where the grid has no active voxel the
/// nearest active ones count.
/// @throws Error (kInput, "vdb.*"): no such grid, another type or class, no unit or one of another
/// dimension, values that are not numbers, a transform that is not linear, ...
[[nodiscard]] PALPATE_EXPORT MaterialGridPtr readMaterialGrid(const std::string& path,
                                                              const MaterialGridRequest& request);

/// A material grid on its way into a file.
struct NamedMaterialGrid {
  std::string name;                             ///< `<layer>/<parameter>`
  MaterialGridPtr grid;                         ///< must not be null
  std::string unit;                             ///< of its values: an SI unit, or "1" for a ratio
  std::string length_unit;                      ///< of the file's coordinates
  std::map<std::string, std::string> metadata;  ///< layer, source, ...
};

}  // namespace palpate::vdb
