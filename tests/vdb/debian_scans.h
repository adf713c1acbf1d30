#pragma once
/// Scans that Debian packages carry: mricron-data (heads and atlases as NIfTI) and
/// invesalius-examples (a head's CT). tools/setup.sh installs both; a test that does not find them
/// fails.

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

/// The project file of InVesalius with its voxels, and what that program made of them itself.
struct HeadCt {
  std::array<int, 3> size{};
  std::array<double, 3> spacing{};   ///< [mm]
  std::vector<std::int16_t> values;  ///< Hounsfield units
  std::vector<std::uint8_t> mask;    ///< a voxel each: what InVesalius took for bone is not 0
  double lowest = 0.0;               ///< and from which number on
  double surface_volume = 0.0;       ///< [mm^3] of the surface that it drew around it

  [[nodiscard]] std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i + size[0] * (j + size[1] * k));
  }
};

/// @throws std::runtime_error if the package is not installed, or holds something else.
[[nodiscard]] HeadCt readHeadCt();

/// The voxels from `lo` to `hi` as MetaImage, that of `lo` at the origin, axes along L, P, S; the
/// path of the .mhd.
std::string writePart(const HeadCt& ct, const std::array<int, 3>& lo, const std::array<int, 3>& hi,
                      const palpate::testing::TempFolder& folder);

/// The voxels from `lo` to `hi`, where they are.
[[nodiscard]] Image cropped(const Image& image, const std::array<int, 3>& lo,
                            const std::array<int, 3>& hi);

/// Of mricron's aal, the voxels around the nuclei of the left half of the brain: thalamus, putamen,
/// pallidum, and the parts of their neighbors that are larger than 100 voxels there.
[[nodiscard]] Image deepBrain();

/// Triangles around one of its labels: 73 putamen, 75 pallidum, 77 thalamus.
[[nodiscard]] Mesh nucleusMesh(int label);

}  // namespace palpate::vdb::test
