#pragma once
/// Chooses the processors on which baking threads run.

#include <functional>

#include "palpate/export.h"

namespace palpate::vdb {

/// Calls `bake` and keeps its threads off `processor`, so that a servo loop pinned to that
/// processor has it alone. The calling thread stays off it as well until `bake` returns. The result
/// of the bake is the same.
/// @throws Error (kUsage) for a processor that this thread may not run on, or where there is no
/// other; and whatever `bake` throws.
PALPATE_EXPORT void bakeOffProcessor(int processor, const std::function<void()>& bake);

}  // namespace palpate::vdb
