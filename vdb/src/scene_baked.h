#pragma once
/// `baked` in a scene: a field whose parts become grids.

#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Reads one; its grids are made when the field is first asked for.
[[nodiscard]] FieldSourcePtr readBaked(MapReader& reader, const RegisterOptions& options);

}  // namespace palpate::vdb
