#pragma once
/// The kind `baked` of a scene: a field whose parts become grids.

#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Reads one such field; its grids are made when the field is first asked for.
[[nodiscard]] FieldSourcePtr readBaked(const MapReader& reader, const RegisterOptions& options);

/// Applies the scene's `grids` to one layer. An unbounded field stays as it is, with a note.
[[nodiscard]] FieldSourcePtr chooseGrids(const FieldSourcePtr& field,
                                         const SceneRegistry::GridChoice& choice,
                                         const RegisterOptions& options);

}  // namespace palpate::vdb
