#pragma once
/// Adds grids, meshes and scans to the kinds that scene files can name.

#include <functional>
#include <string>

#include "palpate/export.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// A report on a heavy field of a scene: one record for each grid that was made or read.
struct GridRecord {
  std::string what;      ///< layer or field, and its source
  LevelSetInfo info;     ///< as it was read or baked, before a band that is too narrow is widened
  double seconds = 0.0;  ///< [s] time it took, reading its file included
};

/// An entry of `images:`, as it is read.
struct ImageRecord {
  std::string file;        ///< as this process can open it
  ImageOptions options;    ///< as the scene states them
  bool is_labels = false;  ///< it has names, or its file says that it holds labels
};

/// Reports and limits of the readers. All functions are called by the thread that reads or compiles
/// the scene, and may be empty.
struct RegisterOptions {
  std::function<void(const GridRecord&)> on_grid = {};  ///< called with each grid when it is ready
  std::function<void(const std::string&)> on_note =
      {};  ///< called with each assumption or decision, once
  /// Called with each layer of labels that has a color in its table of names, as the scene is read.
  std::function<void(const std::string& layer, const LabelColor&)> on_color = {};
  std::function<void(const ImageRecord&)> on_image =
      {};  ///< called with each image as the scene is read
  /// [bytes] of each grid that is made or read, its bricks included; 0: 80 % of the machine's
  std::uint64_t max_memory = 0;
  /// Where grids read from files are kept if they took long to widen or rebuild (CertifyOptions);
  /// empty: nowhere.
  std::string cache_folder = {};
};

/// `of`, and the keys that a scene may have for meshes, grids and images.
[[nodiscard]] PALPATE_EXPORT VocabularyPtr vocabulary(const Vocabulary& of = *sceneVocabulary());

/// Adds vocabulary() and the makers of its kinds: fields `mesh`, `grid`, `mask` and `baked`;
/// images; layers `labels` and `threshold`; maps of parameters `grid` and `image`; `grids`.
/// `palpate help scene` tells their keys. Paths are relative to the scene file, lengths in its
/// unit. Notes tell of a band too narrow for the cubic sampler, and of thin parts that a grid has
/// lost. Reading a scene makes only quick checks of files: that they exist, image headers, name
/// tables. Grids are made when their field is first asked for; an image is then read once for all
/// its layers. Errors of both stages point at the scene's file, line and column. The functions in
/// `options` must stay callable as long as the registry and the fields it made are used.
PALPATE_EXPORT void registerKinds(SceneRegistry& registry, const RegisterOptions& options = {});

}  // namespace palpate::vdb
