#pragma once
/// A field made of what a scene says, with the place where it says so.

#include "palpate/core/error.h"
#include "palpate/scene/description.h"

namespace palpate {

/// What `make` returns; a constructor's complaint, with the place it does not know.
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
