#pragma once
/// The place of the voxels of a NRRD file.

#include <optional>
#include <vector>

#include "image/nrrd_fields.h"
#include "image/nrrd_header.h"

namespace palpate::vdb {

/// The vectors of `space directions`, which must be there: one for each of `axes`; nothing for an
/// axis that is not spatial. @throws Error (kInput, nrrd.directions)
[[nodiscard]] std::vector<std::optional<Vec3>> readNrrdDirections(const NrrdFields& fields,
                                                                  std::size_t axes);

/// Sets place and length unit of `out`, whose axes are sorted; `directions` is empty if the header
/// has none.
/// @throws Error (kInput) for a place that is not stated, contradicts itself or is not usable.
void placeNrrd(const NrrdFields& fields, const std::vector<std::optional<Vec3>>& directions,
               const ImageOptions& options, NrrdHeader& out);

}  // namespace palpate::vdb
