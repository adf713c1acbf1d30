#pragma once
/// Computes the rows of a picture on all cores.

#include <functional>

#include "palpate/core/progress.h"

namespace palpate::tools {

/// Calls `row(y, worker)` once for every y in [0, rows); `worker` is from 0 to workerCount() - 1,
/// and no worker runs two rows at once. Reports progress on the calling thread. `row` must not
/// throw.
void parallelRows(int rows, const Progress& progress, const char* what,
                  const std::function<void(int y, std::size_t worker)>& row);

[[nodiscard]] std::size_t workerCount();

}  // namespace palpate::tools
