#pragma once
/// Where the threads that bake run.

#include <functional>

#include "palpate/export.h"

namespace palpate::vdb {

/// Calls `bake`, and does what it bakes on all processors but one, which a servo loop that is
/// pinned to it then has alone. The calling thread stays off it as well until `bake` returns. What
/// is baked is the same.
/// @throws Error (kUsage) for a processor that this thread may not run on, or where there is no
/// other; and what `bake` throws.
PALPATE_EXPORT void bakeOffProcessor(int processor, const std::function<void()>& bake);

}  // namespace palpate::vdb
