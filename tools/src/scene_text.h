#pragma once
/// Writes a scene's tree of nodes as the text of a scene file.

#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// `text` in double quotes. @throws Error (kUsage) if it is not UTF-8: scene files are, but a
/// file's name need not be.
[[nodiscard]] std::string sceneWord(const std::string& text);

/// One line for each entry of a section, values in flow style; quoted texts stay quoted. Comments
/// are lost, as they are not part of the tree.
[[nodiscard]] std::string sceneText(const Node& root);

/// `root`, which was read from `from`, with the paths of its files made relative to the folder of
/// `to`.
[[nodiscard]] Node withPathsSeenFrom(Node root, const std::string& from, const std::string& to);

}  // namespace palpate::tools
