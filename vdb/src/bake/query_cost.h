#pragma once
/// Measures the cost of a query of a field on this machine.

#include "palpate/fields/field.h"

namespace palpate::vdb {

/// [ns] of one sample() near the surface of `field` within `box` [m], which is bounded: the least
/// time of several passes, about a millisecond in all. Each query waits for the one before, as in a
/// loop.
[[nodiscard]] double queryNanoseconds(const Field& field, const Box3& box);

}  // namespace palpate::vdb
