#pragma once
/// Identifies a scene: a hash of its text and of every file that it names.

#include <string>

namespace palpate::tools {

/// "fnv1a64:" and 16 digits: a hash of the text, and of the content of each file (or each file in a
/// folder) that a value in the text names, relative to the scene's folder. `text`: that of the
/// scene, if `file` does not hold it itself. @throws Error (kInput).
[[nodiscard]] std::string sceneHash(const std::string& file, const std::string& text = {});

}  // namespace palpate::tools
