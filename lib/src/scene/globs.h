#pragma once
/// Lists of globs of region names, written "a, b".

#include <algorithm>
#include <string>
#include <vector>

#include "palpate/scene/scene_file.h"

namespace palpate {

[[nodiscard]] inline std::vector<std::string> globsIn(const std::string& list) {
  std::vector<std::string> globs;
  for (std::size_t at = 0; at < list.size();) {
    const std::size_t end = std::min(list.find(", ", at), list.size());
    globs.push_back(list.substr(at, end - at));
    at = end + 2;
  }
  return globs;
}

/// Whether any glob of the list matches `name`.
[[nodiscard]] inline bool matchesAnyOf(const std::string& list, const std::string& name) {
  const std::vector<std::string> globs = globsIn(list);
  return std::any_of(globs.begin(), globs.end(),
                     [&](const std::string& glob) { return matchesGlob(glob, name); });
}

}  // namespace palpate
