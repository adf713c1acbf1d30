#pragma once
/// Catches the error with which a piece of work is refused.

#include <gtest/gtest.h>

#include "palpate/core/error.h"

namespace palpate {

/// Runs `work` and returns the Error that it throws; if it throws none, an empty one, and the test
/// fails.
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
