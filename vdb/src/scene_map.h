#pragma once
/// Parameters of materials in a scene that come from grids and images.

#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// `{grid: {file, name, unit, units, tolerance}}`.
[[nodiscard]] MaterialMapPtr readGridMap(const MapReader& reader, const ParameterKind& of,
                                         const RegisterOptions& options);

/// `{image: NAME, transfer: [[value, quantity], ...], tolerance}`.
[[nodiscard]] MaterialMapPtr readImageMap(const MapReader& reader, const ParameterKind& of,
                                          const RegisterOptions& options);

}  // namespace palpate::vdb
