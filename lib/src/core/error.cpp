#include "palpate/core/error.h"

namespace palpate {

std::string formatProblem(const Problem& problem) {
  std::string text;
  if (!problem.file.empty()) {
    text += problem.file;
    if (problem.line > 0) text += ':' + std::to_string(problem.line);
    if (problem.line > 0 && problem.column > 0) text += ':' + std::to_string(problem.column);
    text += ": ";
  }
  text += "error: " + problem.message;
  if (!problem.excerpt.empty()) {
    text += "\n  " + problem.excerpt;
    if (problem.column > 0) {
      text += "\n  ";
      // Tabs of the source line are repeated, so that the caret stands under the column in any
      // terminal.
      for (int i = 0; i + 1 < problem.column; ++i) {
        const auto at = static_cast<std::size_t>(i);
        text += at < problem.excerpt.size() && problem.excerpt[at] == '\t' ? '\t' : ' ';
      }
      text += '^';
    }
  }
  if (!problem.hint.empty()) text += "\nhint: " + problem.hint;
  return text;
}

}  // namespace palpate
