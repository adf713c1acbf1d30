#pragma once
/// `baked` in a scene: a field whose parts become grids.

#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Reads one; its grids are made when the field is first asked for.
[[nodiscard]] FieldSourcePtr readBaked(const MapReader& reader, const RegisterOptions& options);

/// The scene's `grids`, for one layer. A field without end stays as it is, with a note.
[[nodiscard]] FieldSourcePtr chooseGrids(const FieldSourcePtr& field,
                                         const SceneRegistry::GridChoice& choice,
                                         const RegisterOptions& options);

}  // namespace palpate::vdb
