#pragma once
/// Fields of a scene that are grids, made when they are first asked for and kept for the next time.

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

/// What the makers need after the scene file is read and its readers are gone.
struct Common {
  RegisterOptions options;
  BundleOptions bundle;
  std::shared_ptr<Notes> notes;
  SceneImages images;
};
using CommonPtr = std::shared_ptr<Common>;

/// What a grid is made of.
struct GridContent {
  SourceState files;  ///< what was made while they changed is not kept
  ContentKey grid;    ///< of the source and of all that counts in how it is made
  ContentKey box;     ///< of what counts where only its place is asked for
};

/// Other ways than a grid alone.
struct MeshWays {
  std::function<FieldPtr(const Progress&)> instead =
      {};  ///< tried first; null where a grid is needed
  std::function<FieldPtr(FieldPtr, const LevelSet&)> finish = {};  ///< of the grid's whole field
};

struct GridSource {
  std::string what;  ///< names the grid in progress and records
  std::string summary;
  SourcePlace place;  ///< of the scene: what the maker finds wrong is reported there
  Sampler sampler = Sampler::kCubic;
  std::function<LevelSet(const Progress&)> make;
  std::function<Box3(const Progress&)> measure;
  MeshWays ways = {};
  CertifyOptions certify = {};

  /// Not given: the grid is made each time.
  std::function<GridContent(const Progress&)> content = {};
  std::string name = {};                             ///< of a grid that was kept
  std::map<std::string, std::string> metadata = {};  ///< of a grid that was kept, beside its own
  std::string file = {};                             ///< that notes are about, if not `what`
};

/// A field that makes its grid when it is first asked for it, or takes the one that was kept of the
/// same content; of several processes one makes it, and the others wait.
[[nodiscard]] FieldSourcePtr lazyField(const CommonPtr& common, GridSource source);

}  // namespace palpate::vdb
