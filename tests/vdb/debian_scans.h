#pragma once
/// Scans from Debian packages: mricron-data (heads and atlases as NIfTI) and invesalius-examples
/// (CT of a head). tools/setup.sh installs both; a test that does not find them fails.

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "palpate/vdb/mesh.h"
#include "support/temp_file.h"

namespace palpate::vdb::test {

/// `name` of mricron-data's templates: "aal.nii.gz".
[[nodiscard]] std::string mricron(const std::string& name);

/// The project file of InVesalius with its voxels, and that program's own results.
struct HeadCt {
  std::array<int, 3> size{};
  std::array<double, 3> spacing{};   ///< [mm]
  std::vector<std::int16_t> values;  ///< Hounsfield units
  std::vector<std::uint8_t> mask;    ///< for each voxel: not 0 where InVesalius found bone
  double lowest = 0.0;               ///< the number at which bone begins
  double surface_volume = 0.0;       ///< [mm^3] volume inside the surface that InVesalius made

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i + size[0] * (j + size[1] * k));
  }
};

/// @throws std::runtime_error if the package is not installed, or has other contents.
[[nodiscard]] HeadCt readHeadCt();

/// Writes the voxels from `lo` to `hi` as MetaImage, with that at `lo` at the origin and axes along
/// L, P, S; returns the path of the .mhd.
std::string writePart(const HeadCt& ct, const std::array<int, 3>& lo, const std::array<int, 3>& hi,
                      const palpate::testing::TempFolder& folder);

/// The voxels from `lo` to `hi`, at their place in the image.
[[nodiscard]] Image cropped(const Image& image, const std::array<int, 3>& lo,
                            const std::array<int, 3>& hi);

/// The part of mricron's aal around the nuclei of the left half of the brain: thalamus, putamen,
/// pallidum, and the parts of their neighbors that have more than 100 voxels there.
[[nodiscard]] Image deepBrain();

/// Triangles around one of its labels: 73 putamen, 75 pallidum, 77 thalamus.
[[nodiscard]] Mesh nucleusMesh(int label);

}  // namespace palpate::vdb::test
