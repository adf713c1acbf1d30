#pragma once
/// The text of a scene whose files are in a bundle.

#include <functional>
#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// What a value of a scene names.
enum class Named {
  kFile,  ///< a mesh, a grid, a mask, a table of names
  kScan,  ///< the file of an image
  kMore   ///< a further file of an image
};

/// The name of a file within the bundle, for one as the scene names it; `image` is the entry of
/// `images:` that it is of.
using NameInBundle =
    std::function<std::string(Named what, const std::string& name, const std::string& image)>;

/// The text of `document` with other names of files, and all else, comments as well, as it was.
/// Absolute names in comments are changed too. @throws Error (kInput) for a name that does not
/// stand in one line.
[[nodiscard]] std::string packedText(const Document& document, const NameInBundle& name);

/// Whether a material of the scene is made of the image.
[[nodiscard]] bool isReadByMaterials(const Node& root, const std::string& image);

}  // namespace palpate::tools
