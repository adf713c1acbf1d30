#pragma once
/// Teaches scene files to read grids, meshes and scans.

#include <functional>
#include <string>

#include "palpate/export.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// What a scene's heavy fields came to, for reports: one record for each grid that was made or
/// read.
struct GridRecord {
  std::string what;      ///< layer or field, and its source
  LevelSetInfo info;     ///< as it was read or baked, before a band that is too narrow is widened
  double seconds = 0.0;  ///< [s] it took, reading its file included
};

/// An entry of `images:`, as it is read.
struct ImageRecord {
  std::string file;        ///< as this process can open it
  ImageOptions options;    ///< as the scene states them
  bool is_labels = false;  ///< it has names, or says that it holds labels
};

/// Reports and limits of the readers. All functions are called by the thread that reads or compiles
/// the scene, and may be empty.
struct RegisterOptions {
  std::function<void(const GridRecord&)> on_grid = {};  ///< told of each grid when it is ready
  std::function<void(const std::string&)> on_note =
      {};  ///< told what was assumed or decided, once each
  /// Told of each layer of labels that has a color in its table of names, as the scene is read.
  std::function<void(const std::string& layer, const LabelColor&)> on_color = {};
  std::function<void(const ImageRecord&)> on_image =
      {};  ///< told of each image as the scene is read
  /// [bytes] of each grid that is made or read, its bricks included; 0: 80 % of the machine's
  std::uint64_t max_memory = 0;
  /// Where grids of files are kept that took long to widen or rebuild (CertifyOptions); empty:
  /// nowhere.
  std::string cache_folder = {};
};

/// `of`, and what a scene may say of meshes, grids and images.
[[nodiscard]] PALPATE_EXPORT VocabularyPtr vocabulary(const Vocabulary& of = *sceneVocabulary());

/// Adds vocabulary() and what makes it: fields `mesh`, `grid`, `mask` and `baked`; images; layers
/// `labels` and `threshold`; maps of parameters `grid` and `image`; `grids`. `palpate help scene`
/// tells their keys. Paths are relative to the scene file, lengths in its unit. Notes tell of a
/// band too narrow for the cubic sampler, and of thin parts that a grid has lost. Reading a scene
/// looks at files only as far as it is quick: that they are there, image headers, name tables.
/// Grids are made when their field is first asked for; an image is then read once for all its
/// layers. Errors of either point at the scene's file, line and column. The functions in `options`
/// must stay callable as long as the registry and the fields it made are used.
PALPATE_EXPORT void registerKinds(SceneRegistry& registry, const RegisterOptions& options = {});

}  // namespace palpate::vdb
