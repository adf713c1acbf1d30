#pragma once
/// What is written from the declarations of verbs and options, besides --help: the manual page and completion.

#include <string>
#include <vector>

#include "command_line/verb.h"

namespace palpate::tools {

/// palpate(1), in the man macros of roff.
[[nodiscard]] std::string manPage(const std::vector<Verb>& all);

/// A script that completes verbs, options, their words and files in `shell`, one of bash, zsh and fish; behind
/// `palpate help scene` also `scene_words`.
[[nodiscard]] std::string completion(const std::string& shell, const std::vector<Verb>& all,
                                     const std::vector<std::string>& scene_words);

}  // namespace palpate::tools
