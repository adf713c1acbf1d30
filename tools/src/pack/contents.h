#pragma once
/// The list of its own files that a bundle carries: what was damaged since, and what is not of it,
/// is found by that.

#include <filesystem>
#include <optional>
#include <string>

#include "report.h"

namespace palpate::tools {

/// "fnv1a64:..." of the bytes of a file. @throws Stopped if the run is asked to stop.
[[nodiscard]] std::string hashOf(const std::filesystem::path& file);

/// Name, bytes and hash of each file below `bundle`, but for its `pack.json`.
[[nodiscard]] Json contentsOf(const std::filesystem::path& bundle);

/// @throws Error (kInput, pack.damaged) for the first file of the list that is missing or not as it
/// was packed. The scene may be edited.
void checkContents(const std::filesystem::path& bundle);

/// A file or folder below `bundle` that its list does not have, and that replacing it would lose.
[[nodiscard]] std::optional<std::string> foreignIn(const std::filesystem::path& bundle);

}  // namespace palpate::tools
