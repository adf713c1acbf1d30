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
  std::string file;  ///< as this process can open it
  ImageOptions options;
  bool is_labels = false;  ///< it has names, or says that it holds labels
};

struct RegisterOptions {
  std::function<void(const GridRecord&)> on_grid = {};  ///< told of each grid when it is ready
  std::function<void(const std::string&)> on_note =
      {};  ///< told what was assumed or decided, once each
  /// Told of each layer of labels that has a colour in its table of names, as the scene is read.
  std::function<void(const std::string& layer, const LabelColor&)> on_color = {};
  std::function<void(const ImageRecord&)> on_image =
      {};  ///< told of each image as the scene is read
  /// [bytes] of each grid that is made or read, its bricks included; 0: 80 % of the machine's
  std::uint64_t max_memory = 0;
  /// Where grids of files are kept that took long to widen or rebuild (CertifyOptions); empty: nowhere.
  std::string cache_folder = {};
};

/// Adds to a scene's vocabulary (paths are relative to the scene file, lengths in its unit):
///   fields  mesh: {file, units, space, voxel, half_width, edges: sharp | rounded, sharp, sampler}  units: the
///                  scene's, of glTF metres; voxel: longest side / 128; edges: see mesh.h; sharp: [degrees] see mesh.h
///           grid: {file, name, units, sampler}               units: only if the file does not say
///           baked: {field, voxel, half_width, sampler, parts, tolerance}   parts: auto | operands | whole,
///                  see bake.h
///   images  NAME: {file, names, affine, space, frame, series}
///   layers  labels: {image, match: [..], voxel, sampler}      its label group is the image's name
///           threshold: {image, above, keep: largest | all, fill, voxel, sampler}
///   parameters of materials and opening forces (material_grid.h); made when the scene is read
///           grid: {file, name, unit, units, tolerance}        unit, units: only if the file does not say
///           image, transfer: [[value, quantity], ..], tolerance    of the image; stored in 16 or 8 bits
///   sampler: cubic (the default) | trilinear | accessor. Notes tell of a band too narrow for cubic, and of
///   thin parts that a grid has lost.
/// Reading a scene looks at files only as far as it is quick: that they are there, image headers,
/// name tables. Grids are made when their field is first asked for; an image is then read once for
/// all its layers. Errors of either point at the scene's file, line and column. The functions in
/// `options` must stay callable as long as the registry and the fields it made are used.
PALPATE_EXPORT void registerKinds(SceneRegistry& registry, const RegisterOptions& options = {});

}  // namespace palpate::vdb
