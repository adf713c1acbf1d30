#pragma once
/// Material parameters of a scene that come from grids and images.

#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Reads `{grid: {file, name, unit, units, tolerance}}`.
[[nodiscard]] MaterialMapPtr readGridMap(const MapReader& reader, const ParameterKind& of,
                                         const RegisterOptions& options);

/// Reads `{image: NAME, transfer: [[value, quantity], ...], tolerance}`.
[[nodiscard]] MaterialMapPtr readImageMap(const MapReader& reader, const ParameterKind& of,
                                          const RegisterOptions& options);

}  // namespace palpate::vdb
