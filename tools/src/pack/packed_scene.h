#pragma once
/// The text of a scene whose files are in a bundle.

#include <functional>
#include <string>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

/// The kind of file that a value of a scene names.
enum class Named {
  kFile,  ///< a mesh, a grid, a mask, a table of names
  kScan,  ///< the file of an image
  kMore   ///< a further file of an image
};

/// The name within the bundle for a file as the scene names it; `image` is the entry of `images:`
/// that it belongs to.
using NameInBundle =
    std::function<std::string(Named what, const std::string& name, const std::string& image)>;

/// The text of `document` with new file names, and everything else, comments too, unchanged.
/// Absolute names in comments are replaced as well. @throws Error (kInput) for a name that spans
/// several lines.
[[nodiscard]] std::string packedText(const Document& document, const NameInBundle& name);

/// Whether a material of the scene uses the image.
[[nodiscard]] bool isReadByMaterials(const Node& root, const std::string& image);

}  // namespace palpate::tools
