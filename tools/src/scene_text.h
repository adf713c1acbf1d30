#pragma once
/// A scene's tree of nodes, as the text of a scene file again.

#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// `text` in double quotes. Scene files are UTF-8. @throws Error (kUsage): what a file is called
/// need not be.
[[nodiscard]] std::string sceneWord(const std::string& text);

/// One line for each entry of a section, values in the flow style; what was quoted still is.
/// Comments are not part of the tree.
[[nodiscard]] std::string sceneText(const Node& root);

/// `root`, read from `from`, with the paths of its files as seen from the folder of `to`.
[[nodiscard]] Node withPathsSeenFrom(Node root, const std::string& from, const std::string& to);

}  // namespace palpate::tools
