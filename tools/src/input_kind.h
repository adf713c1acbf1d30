#pragma once
/// The kind of a file, judged by its name.

#include <string>

namespace palpate::tools {

enum class InputKind { kScene, kGrid, kMesh, kImage };

/// Decides by the extension; a folder with DICOM files is an image. @throws Error: kInput if the
/// file is missing, is not a regular file or has an extension that nothing here reads.
[[nodiscard]] InputKind inputKind(const std::string& path);

/// `path` without folder and extensions: "ch2" for "a/ch2.nii.gz".
[[nodiscard]] std::string stemOf(const std::string& path);

/// True if `path` ends with `extension` (".png"), in upper or lower case.

}  // namespace palpate::tools
