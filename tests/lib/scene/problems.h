#pragma once
/// What scene tests share: the problem that a text is refused with.

#include <gtest/gtest.h>

#include <ostream>
#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate {

/// A text, and the one error it must be refused with.
struct Refusal {
  const char* name;
  std::string text;
  int line;
  int column;
  std::string code;
  std::string message;  ///< part of it
  std::string hint;     ///< part of it
};

inline std::ostream& operator<<(std::ostream& out, const Refusal& refusal) {
  return out << refusal.name;
}

/// Runs `read` and returns what it threw; an empty problem, and a failure, if it did not.
template <typename Read>
Problem problemOf(Read&& read) {
  try {
    read();
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    return error.problem();
  }
  ADD_FAILURE() << "it was accepted";
  return {};
}

inline void expectRefusal(const Refusal& refusal, const Problem& problem) {
  const std::string shown = formatProblem(problem);
  EXPECT_EQ(problem.code, refusal.code) << shown;
  EXPECT_EQ(problem.file, "test.yaml") << shown;
  EXPECT_EQ(problem.line, refusal.line) << shown;
  EXPECT_EQ(problem.column, refusal.column) << shown;
  EXPECT_NE(problem.message.find(refusal.message), std::string::npos) << shown;
  EXPECT_NE(problem.hint.find(refusal.hint), std::string::npos) << shown;
}

inline std::string refusalName(const testing::TestParamInfo<Refusal>& info) {
  return info.param.name;
}

}  // namespace palpate
