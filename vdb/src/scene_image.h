#pragma once
/// `images:` of a scene: their headers are read with the scene, and their voxels when a layer needs
/// them.

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "keep/source_state.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/register.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb {

/// Reports each note about a file once.
class Notes {
 public:
  explicit Notes(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
  void add(const std::string& path, const std::vector<std::string>& notes);

  /// The subject of a note, and the note.
  using List = std::vector<std::pair<std::string, std::string>>;
  /// While it exists, it collects all notes that are added, including those reported before.
  class Listener {
   public:
    Listener(Notes& notes, List& list) : notes_(notes) { notes.list_ = &list; }
    ~Listener() { notes_.list_ = nullptr; }
    Listener(const Listener&) = delete;
    Listener& operator=(const Listener&) = delete;

   private:
    Notes& notes_;
  };

 private:
  std::function<void(const std::string&)> tell_;
  std::set<std::string> told_;
  List* list_ = nullptr;
};

/// One image file, read at most once however many layers come from it.
class ImageFile {
 public:
  ImageFile(std::string path, ImageOptions options, std::shared_ptr<Notes> notes)
      : path_(std::move(path)), options_(std::move(options)), notes_(std::move(notes)) {}
  /// The stand-in for the image file at `path` in a bundle.
  ImageFile(std::string path, std::string content_key, std::shared_ptr<Notes> notes);
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// @throws Error (kInput): everything readImage() throws, and pack.no_scan if only a stand-in is
  /// there.
  [[nodiscard]] const Image& image();
  /// [m] The box around the voxels of these labels, as by boxWhere(). The image is scanned once for
  /// all calls.
  [[nodiscard]] Box3 boxOfLabels(const std::vector<int>& labels);

  /// Key of the bytes of all its files, which are read once, and of the options by which they are
  /// read.
  [[nodiscard]] const std::string& contentKey();
  /// The state of those files when they were read.
  [[nodiscard]] const SourceState& state();

 private:
  /// Folders in which adding or removing a file would change the image.
  [[nodiscard]] std::vector<std::string> folders() const;
  [[nodiscard]] std::vector<std::string> foldersAndFiles() const;

  std::string path_;
  ImageOptions options_;
  std::shared_ptr<Notes> notes_;
  std::optional<Image> image_;
  std::optional<std::map<float, Box3>> boxes_;
  std::string key_;
  SourceState state_;
  SourceState decoded_;  ///< state of the files before `image_` was read from them
  bool has_voxels_ = true;
};

/// One entry of `images:`.
struct SceneImage {
  std::shared_ptr<ImageFile> file;
  LabelTable labels;       ///< from the table that the scene names, else from the image itself
  std::string names_path;  ///< empty if there is none
  /// The labels of each layer that comes from this image, collected as the scene is read; these
  /// layers share walls.
  std::vector<std::vector<int>> layers;

  /// Made on first use: by then all layers are known.
  [[nodiscard]] LabelSurfaces& surfaces();

 private:
  std::unique_ptr<LabelSurfaces> surfaces_;
  std::size_t layers_then_ = 0;
};

/// Makes SceneImages; entries that name one file and read it alike share it.
class SceneImages {
 public:
  SceneImages(std::shared_ptr<Notes> notes, std::function<void(const ImageRecord&)> tell)
      : notes_(std::move(notes)), tell_(std::move(tell)) {}
  [[nodiscard]] std::shared_ptr<SceneImage> read(const MapReader& reader);

 private:
  std::shared_ptr<Notes> notes_;
  std::function<void(const ImageRecord&)> tell_;
  /// By path and options. Weak pointers: voxels are freed with their scene.
  std::map<std::string, std::weak_ptr<ImageFile>> files_;
};

/// `space:` RAS or LPS; not given: as the file says.
[[nodiscard]] Space readSpace(const MapReader& reader);

/// `error`, which occurred while reading the file named by `key`, placed at that key of the scene.
[[nodiscard]] Error atKey(const MapReader& reader, std::string_view key, const Error& error);

}  // namespace palpate::vdb
