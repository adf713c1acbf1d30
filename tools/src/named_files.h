#pragma once
/// Files that a scene names.

#include <filesystem>
#include <vector>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// The values of `root` that may be the name of a file or a folder, as seen from `folder`, in the
/// order of the text. Does not check whether they exist.
[[nodiscard]] std::vector<std::filesystem::path> namedPaths(const Node& root,
                                                            const std::filesystem::path& folder);

/// The file at `path`, or the files in the folder `path`, sorted; empty if there is neither.
[[nodiscard]] std::vector<std::filesystem::path> filesAt(const std::filesystem::path& path);

}  // namespace palpate::tools
