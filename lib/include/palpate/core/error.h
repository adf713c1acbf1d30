#pragma once
/// Errors of set-up. Nothing in the servo loop throws.

#include <stdexcept>
#include <string>
#include <utility>

#include "palpate/export.h"

namespace palpate {

/// Who or what is at fault. The command maps these to its exit codes.
enum class ErrorKind {
  kUsage,      ///< the call or the command line is wrong (exit 2)
  kInput,      ///< a file or value that was given is bad (exit 3)
  kOperation,  ///< the operation could not be done: disk full, out of memory, ... (exit 1)
  kDevice,     ///< the device failed (exit 4)
  kCancelled,  ///< the user asked to stop (exit 130)
};

/// One problem, described so that the reader can mend it: where, what, and the remedy.
struct Problem {
  std::string code;          ///< stable, for scripts: "scene.unknown_key", "mesh.open", ...
  std::string message;       ///< what is wrong, with the offending value
  std::string hint = {};     ///< what to do about it; may be empty
  std::string file = {};     ///< may be empty
  int line = 0;              ///< from 1; 0 if unknown
  int column = 0;            ///< from 1; 0 if unknown
  std::string excerpt = {};  ///< the offending source line, if there is one
};

/// "file:line:column: error: message" with the excerpt, a caret and the hint on lines of their own.
[[nodiscard]] PALPATE_EXPORT std::string formatProblem(const Problem& problem);

/// The one exception type that the library throws on purpose.
class PALPATE_EXPORT Error : public std::runtime_error {
 public:
  /// what() is formatProblem() of `problem`.
  Error(ErrorKind kind, Problem problem)
      : std::runtime_error(formatProblem(problem)), kind_(kind), problem_(std::move(problem)) {}

  /// Who or what is at fault.
  [[nodiscard]] ErrorKind kind() const noexcept { return kind_; }
  /// Place, value and remedy, each on its own.
  [[nodiscard]] const Problem& problem() const noexcept { return problem_; }

 private:
  ErrorKind kind_;
  Problem problem_;
};

/// Shorthand for the most frequent error: bad input.
[[nodiscard]] inline Error inputError(std::string code, std::string message, std::string hint = {},
                                      std::string file = {}) {
  return Error(ErrorKind::kInput,
               {std::move(code), std::move(message), std::move(hint), std::move(file)});
}

}  // namespace palpate
