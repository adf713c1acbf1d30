#pragma once
/// Shared by scene tests: the problem with which a text is refused.

#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>

#include "palpate/scene/scene_file.h"
#include "support/error_of.h"

namespace palpate {

/// A text, and the one error with which it must be refused.
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
Problem problemOf(const Read& read) {
  const Error error = errorOf(read);
  EXPECT_EQ(error.kind(), ErrorKind::kInput);
  return error.problem();
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

/// The refusal of `text`, at the place marked by an '@' in it.
inline Refusal marked(const char* name, std::string text, std::string code, std::string message,
                      std::string hint) {
  const std::size_t at = text.find('@');
  EXPECT_NE(at, std::string::npos) << name;
  text.erase(at, 1);
  const auto end = text.begin() + static_cast<std::ptrdiff_t>(at);
  const auto line = static_cast<int>(std::count(text.begin(), end, '\n')) + 1;
  const std::size_t start = at == 0 ? std::string::npos : text.rfind('\n', at - 1);
  const auto column = static_cast<int>(start == std::string::npos ? at + 1 : at - start);
  return {name,           std::move(text), line, column, std::move(code), std::move(message),
          std::move(hint)};
}

inline std::string refusalName(const ::testing::TestParamInfo<Refusal>& info) {
  return info.param.name;
}

}  // namespace palpate
