#pragma once
/// A scene's tree of nodes, as the text of a scene file again.

#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// One line for each entry of a section, values in the flow style; what was quoted still is. Comments
/// are not part of the tree.
[[nodiscard]] std::string sceneText(const Node& root);

/// `root`, read from `from`, with the paths of its files as seen from the folder of `to`.
[[nodiscard]] Node withPathsSeenFrom(Node root, const std::string& from, const std::string& to);

}  // namespace palpate::tools
