#pragma once
/// Where the voxels of a NRRD file lie.

#include <optional>
#include <vector>

#include "image/nrrd_fields.h"
#include "image/nrrd_header.h"

namespace palpate::vdb {

/// The vectors of `space directions`, which must be there: one for each of `axes`, nothing for an
/// axis that is not in space. @throws Error (kInput, nrrd.directions)
[[nodiscard]] std::vector<std::optional<Vec3>> readNrrdDirections(const NrrdFields& fields,
                                                                  std::size_t axes);

/// Sets place and length unit of `out`, whose axes are sorted; `directions` are empty if the header
/// has none.
/// @throws Error (kInput) for a place that is not said, contradicts itself or is none.
void placeNrrd(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
               const ImageOptions& options, NrrdHeader& out);

}  // namespace palpate::vdb
