#pragma once
/// What a piece of work is refused with.

#include <gtest/gtest.h>

#include "palpate/core/error.h"

namespace palpate {

/// Runs `work` and returns the Error that it throws; an empty one, and a failure, if it does not.
template <typename Work>
Error errorOf(Work&& work) {
  try {
    work();
  } catch (const Error& error) {
    return error;
  }
  ADD_FAILURE() << "it was accepted";
  return Error(ErrorKind::kInput, Problem{});
}

}  // namespace palpate
