#pragma once
/// Grids that scenes keep for the next time, and take along in bundles.

#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"
#include "palpate/vdb/register.h"

namespace palpate::vdb {

/// Grids that are made of images, meshes and masks are kept in RegisterOptions::cache_folder, by
/// what they were made of: the bytes of their files and all that counts in how they are made. The
/// metadata of one that was taken from there, or out of a bundle, say so in GridRecord::info.
/// vdb/README.md, "Kept grids", has the rules.
[[nodiscard]] PALPATE_EXPORT bool wasKept(const LevelSetInfo& info);

/// The bundle from which a scene takes its grids, or that is filled with them.
struct BundleOptions {
  /// Where the grids are that came with the scene; they go before those of the cache. Empty:
  /// nowhere.
  std::string folder = {};
  bool fills = false;  ///< all grids that may be kept go there, too
};

/// registerKinds() for a scene that is in a bundle, or that one is made of.
PALPATE_EXPORT void registerKinds(SceneRegistry& registry, const RegisterOptions& options,
                                  const BundleOptions& bundle);

/// The text of a file, NAME.scan.yaml, that stands for an image in a scene whose grids are in a
/// bundle: what the image is called, the hash of its content, and its table of labels. No voxel is
/// in it: layers for which the bundle has no grid cannot be made.
/// @throws Error (kInput) as readImageInfo() does, or if a file of the image cannot be read.
[[nodiscard]] PALPATE_EXPORT std::string scanStandIn(const std::string& file,
                                                     const ImageOptions& options);

/// Whether a file is one, by its name.
[[nodiscard]] PALPATE_EXPORT bool isStandIn(const std::string& path);

/// Every file that an image is read from. Empty if that is not known.
[[nodiscard]] PALPATE_EXPORT std::vector<std::string> imageFiles(const std::string& path,
                                                                 const ImageOptions& options);

}  // namespace palpate::vdb
