#pragma once
/// Grids of a .vdb file, as they are asked for.

#include <string>

namespace palpate::tools {

/// `name` itself, or `<name>/surface` if `name` is a layer whose surface is in the file. Empty
/// stays empty.
[[nodiscard]] std::string gridName(const std::string& file, const std::string& name);

}  // namespace palpate::tools
