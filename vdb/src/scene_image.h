#pragma once
/// `images:` of a scene: files that are looked at when the scene is read, and read when a layer
/// needs their voxels.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>

#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb {

/// Says each note about a file once.
class Notes {
 public:
  explicit Notes(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
  void add(const std::string& path, const std::vector<std::string>& notes);

 private:
  std::function<void(const std::string&)> tell_;
  std::set<std::string> told_;
};

/// One image file, read at most once however many layers come from it.
class ImageFile {
 public:
  ImageFile(std::string path, std::shared_ptr<Notes> notes)
      : path_(std::move(path)), notes_(std::move(notes)) {}
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  [[nodiscard]] const Image& image();

 private:
  std::string path_;
  std::shared_ptr<Notes> notes_;
  std::optional<Image> image_;
};

/// One entry of `images:`.
struct SceneImage {
  std::shared_ptr<ImageFile> file;
  NameTable names;
  std::string names_path;  ///< empty if there is no table
  /// The labels of each layer that comes from this image, as the scene is read; they share walls.
  std::vector<std::vector<int>> layers;

  /// Made when it is first asked for: by then all layers are known.
  [[nodiscard]] LabelSurfaces& surfaces();

 private:
  std::unique_ptr<LabelSurfaces> surfaces_;
  std::size_t layers_then_ = 0;
};

/// Makes SceneImages; a file that two entries name is shared.
class SceneImages {
 public:
  explicit SceneImages(std::shared_ptr<Notes> notes) : notes_(std::move(notes)) {}
  [[nodiscard]] std::shared_ptr<SceneImage> read(MapReader& reader);

 private:
  std::shared_ptr<Notes> notes_;
  std::map<std::string, std::weak_ptr<ImageFile>>
      files_;  ///< weak: voxels go when their scene goes
};

/// `error`, met while the file named by `key` was looked at, told at that key of the scene.
[[nodiscard]] Error atKey(const MapReader& reader, std::string_view key, const Error& error);

}  // namespace palpate::vdb
