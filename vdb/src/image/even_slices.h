#pragma once
/// Resamples slices that are unevenly spaced, or not stacked straight, onto evenly spaced voxels.

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "image/place.h"

namespace palpate::vdb {

/// Where a slice lies, as seen from the first one.
struct SlicePlace {
  double height = 0.0;  ///< [mm] along the normal, rising
  double column = 0.0;  ///< [voxels] by which it is shifted along its rows
  double row = 0.0;     ///< [voxels] along its columns
};

/// The new voxels. Along the normal they are evenly spaced from the first slice to the last, about
/// as far apart as most slices are; across it they cover every slice.
struct EvenSlices {
  std::array<int, 3> size{};
  Place place;           ///< [unit of the `place` given]
  double step = 0.0;     ///< [mm] along the normal
  int first_column = 0;  ///< [voxels] of the first slice, at which the new ones begin; 0 or less
  int first_row = 0;
};

/// `place` has the first slice's axes and origin; its third axis is one mm along the normal. Two
/// slices or more.
[[nodiscard]] EvenSlices evenSlices(const std::vector<SlicePlace>& slices, double usual_gap,
                                    int columns, int rows, const Place& place);

/// The values of `even`: linear between two slices, bilinear within each. NaN where one of the two
/// does not reach. `values` are those of the slices, columns first.
[[nodiscard]] std::vector<float> resampled(const EvenSlices& even,
                                           const std::vector<SlicePlace>& slices, int columns,
                                           int rows, const std::vector<float>& values);

/// [values] RMS error of linear values between the two neighbors that are farthest apart, as the
/// slices themselves show it: where two slices with others between them are about as far apart,
/// these others are compared with the linear values at their places. For slices that are stacked
/// straight. Nothing if there are no two such slices.
[[nodiscard]] std::optional<double> linearError(const std::vector<SlicePlace>& slices,
                                                std::size_t slice_size,
                                                const std::vector<float>& values);

}  // namespace palpate::vdb
