#pragma once
/// Which of a scene's grids need not be made again.

#include <set>
#include <string>

namespace palpate::tools {

/// The names of those layers of the scene `text`, which is or will be the file `file`, whose grids
/// were kept before. Makes nothing. Empty if the scene's files are not there yet.
[[nodiscard]] std::set<std::string> keptLayers(const std::string& text, const std::string& file);

}  // namespace palpate::tools
