#pragma once
/// Finds a grid of a .vdb file by the name that a user gives.

#include <string>

namespace palpate::tools {

/// `name` itself, or `<name>/surface` if `name` is a layer whose surface is in the file. An empty
/// name stays empty.
[[nodiscard]] std::string gridName(const std::string& file, const std::string& name);

}  // namespace palpate::tools
