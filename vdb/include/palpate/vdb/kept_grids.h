#pragma once
/// Grids that scenes keep for the next run, and carry along in bundles.

#include <functional>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Grids that are made of images, meshes and masks are kept in RegisterOptions::cache_folder, under
/// a key made from the bytes of their files and every option that affects the result. The metadata
/// in GridRecord::info say so if a grid was taken from there, or from a bundle. vdb/README.md,
/// "Kept grids", has the rules.
[[nodiscard]] PALPATE_EXPORT bool wasKept(const LevelSetInfo& info);

/// The bundle from which a scene takes its grids, or that is filled with them.
struct BundleOptions {
  /// Folder of the grids that came with the scene; they take precedence over those of the cache.
  /// Empty: nowhere.
  std::string folder = {};
  bool fills = false;  ///< all grids that may be kept go there, too
  /// Called with the name of each grid that may be kept, while the scene is read, and with a
  /// function that says, once all of it is read, whether the grid was kept before.
  std::function<void(const std::string& what, std::function<bool()> is_kept)> on_source = {};
};

/// registerKinds() for a scene that is in a bundle, or that one is made of, or that is asked what
/// of it is kept.
PALPATE_EXPORT void registerKinds(SceneRegistry& registry, const RegisterOptions& options,
                                  const BundleOptions& bundle);

/// The text of a file, NAME.scan.yaml, that stands for an image in a scene whose grids are in a
/// bundle: the image's name, the hash of its content, and its table of labels. It holds no voxels:
/// layers for which the bundle has no grid cannot be made.
/// @throws Error (kInput) as readImageInfo() does, or if a file of the image cannot be read.
[[nodiscard]] PALPATE_EXPORT std::string scanStandIn(const std::string& file,
                                                     const ImageOptions& options);

/// Whether `path` names such a stand-in.
[[nodiscard]] PALPATE_EXPORT bool isStandIn(const std::string& path);

/// Every file that an image is read from. Empty if they are not known.
[[nodiscard]] PALPATE_EXPORT std::vector<std::string> imageFiles(const std::string& path,
                                                                 const ImageOptions& options);

/// Every file that a mesh is read from: its own first, then those that the buffers of glTF lie in.
/// Empty if one of them is not there, or named in a way that we do not follow.
/// @throws Error (kInput) if a glTF file cannot be read.
[[nodiscard]] PALPATE_EXPORT std::vector<std::string> meshFiles(const std::string& path);

}  // namespace palpate::vdb
