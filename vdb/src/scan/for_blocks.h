#pragma once
/// Runs work on all blocks of a band, in parallel.

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>

#include <cstddef>

namespace palpate::vdb {

/// Calls body(b) for each b below `count`, in any order and on any thread.
template <typename Body>
void forBlocks(std::size_t count, const Body& body) {
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, count),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t b = range.begin(); b != range.end(); ++b) body(b);
                    });
}

}  // namespace palpate::vdb
