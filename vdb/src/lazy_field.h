#pragma once
/// Fields of a scene that are grids, made when they are first asked for and kept for the next run.

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "keep/content_key.h"
#include "keep/source_state.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/register.h"
#include "scene_image.h"

namespace palpate::vdb {

/// Objects that the makers need after the scene file is read and its readers are gone.
struct Common {
  RegisterOptions options;
  BundleOptions bundle;
  std::shared_ptr<Notes> notes;
  SceneImages images;
};
using CommonPtr = std::shared_ptr<Common>;

/// Keys of a grid's content.
struct GridContent {
  SourceState files;  ///< if these change while the grid is made, it is not kept
  ContentKey grid;    ///< depends on the source and on everything that affects the grid
  ContentKey box;     ///< depends on everything that affects the grid's box
};

/// Ways to use a mesh other than as a grid alone.
struct MeshWays {
  std::function<FieldPtr(const Progress&)> instead =
      {};  ///< tried first; returns null where a grid is needed
  /// Makes the final field from the grid's field
  std::function<FieldPtr(FieldPtr, const LevelSet&)> finish = {};
};

struct GridSource {
  std::string what;  ///< names the grid in progress and records
  std::string summary;
  SourcePlace place;  ///< in the scene: errors of the maker are reported there
  Sampler sampler = Sampler::kCubic;
  std::function<LevelSet(const Progress&)> make;
  std::function<Box3(const Progress&)> measure;
  MeshWays ways = {};
  CertifyOptions certify = {};

  /// Not given: the grid is made each time.
  std::function<GridContent(const Progress&)> content = {};
  std::string name = {};                             ///< for a grid that was kept
  std::map<std::string, std::string> metadata = {};  ///< for a grid that was kept, beside its own
  std::string file = {};  ///< the file that notes are about, if not `what`
};

/// A field that makes its grid when it is first asked for, or takes one that was kept with the same
/// content. If several processes need it, one makes it, and the others wait.
[[nodiscard]] FieldSourcePtr lazyField(const CommonPtr& common, GridSource source);

}  // namespace palpate::vdb
