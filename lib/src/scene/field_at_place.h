#pragma once
/// Makes a field from what a scene states, with the place of the statement in error messages.

#include "palpate/core/error.h"
#include "palpate/scene/description.h"

namespace palpate {

/// Calls `make`; if a constructor throws an input error without a place, adds the place.
template <typename Make>
FieldPtr madeAt(const SourcePlace& place, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    const Problem& problem = error.problem();
    if (!problem.file.empty() || error.kind() != ErrorKind::kInput) throw;
    throw errorAt(place, problem.code, problem.message, problem.hint);
  }
}

}  // namespace palpate
