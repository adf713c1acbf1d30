#pragma once
/// The list of its own files that a bundle carries. It shows damaged files, and files that do not
/// belong to the bundle.

#include <filesystem>
#include <optional>
#include <string>

#include "report.h"

namespace palpate::tools {

/// "fnv1a64:..." of the bytes of a file. @throws Stopped if the user asks to stop.
[[nodiscard]] std::string hashOf(const std::filesystem::path& file);

/// Name, size and hash of each file below `bundle`, except its `pack.json`.
[[nodiscard]] Json contentsOf(const std::filesystem::path& bundle);

/// @throws Error (kInput, pack.damaged) for the first listed file that is missing or has changed
/// since it was packed. The scene itself may be edited.
void checkContents(const std::filesystem::path& bundle);

/// A file or folder below `bundle` that is not in its list, and would be deleted if the bundle were
/// replaced.
[[nodiscard]] std::optional<std::string> foreignIn(const std::filesystem::path& bundle);

}  // namespace palpate::tools
