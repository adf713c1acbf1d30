#pragma once
/// `images:` of a scene: files that are looked at when the scene is read, and read when a layer
/// needs their voxels.

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

/// Says each note about a file once.
class Notes {
 public:
  explicit Notes(std::function<void(const std::string&)> tell) : tell_(std::move(tell)) {}
  void add(const std::string& path, const std::vector<std::string>& notes);

  /// What a note is about, and the note.
  using List = std::vector<std::pair<std::string, std::string>>;
  /// As long as it lives, all that is added goes to a list too, also what was said before.
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
  /// What stands for the file at `path` in a bundle.
  ImageFile(std::string path, std::string content_key, std::shared_ptr<Notes> notes);
  [[nodiscard]] const std::string& path() const noexcept { return path_; }
  /// @throws Error (kInput): what readImage() throws, and pack.no_scan if only a stand-in is there.
  [[nodiscard]] const Image& image();
  /// [m] The box around the voxels of these labels, as boxWhere() has it. The image is walked once
  /// for all calls.
  [[nodiscard]] Box3 boxOfLabels(const std::vector<int>& labels);

  /// Of the bytes of all its files, which are read once, and of how they are understood.
  [[nodiscard]] const std::string& contentKey();
  /// Those files as they were then.
  [[nodiscard]] const SourceState& state();

 private:
  /// In which a file more or less makes another image.
  [[nodiscard]] std::vector<std::string> folders() const;
  [[nodiscard]] std::vector<std::string> foldersAndFiles() const;

  std::string path_;
  ImageOptions options_;
  std::shared_ptr<Notes> notes_;
  std::optional<Image> image_;
  std::optional<std::map<float, Box3>> boxes_;
  std::string key_;
  SourceState state_;
  SourceState decoded_;  ///< what `image_` was read from, as it was before that
  bool has_voxels_ = true;
};

/// One entry of `images:`.
struct SceneImage {
  std::shared_ptr<ImageFile> file;
  LabelTable labels;       ///< of the table that is named, else of the image itself
  std::string names_path;  ///< empty if there is none
  /// The labels of each layer that comes from this image, as the scene is read; they share walls.
  std::vector<std::vector<int>> layers;

  /// Made when it is first asked for: by then all layers are known.
  [[nodiscard]] LabelSurfaces& surfaces();

 private:
  std::unique_ptr<LabelSurfaces> surfaces_;
  std::size_t layers_then_ = 0;
};

/// Makes SceneImages; a file that two entries name, and read alike, is shared.
class SceneImages {
 public:
  SceneImages(std::shared_ptr<Notes> notes, std::function<void(const ImageRecord&)> tell)
      : notes_(std::move(notes)), tell_(std::move(tell)) {}
  [[nodiscard]] std::shared_ptr<SceneImage> read(const MapReader& reader);

 private:
  std::shared_ptr<Notes> notes_;
  std::function<void(const ImageRecord&)> tell_;
  /// By path and by how it is read. Weak: voxels go when their scene goes.
  std::map<std::string, std::weak_ptr<ImageFile>> files_;
};

/// `space:` RAS or LPS; not given: as the file says.
[[nodiscard]] Space readSpace(const MapReader& reader);

/// `error`, met while the file named by `key` was looked at, told at that key of the scene.
[[nodiscard]] Error atKey(const MapReader& reader, std::string_view key, const Error& error);

}  // namespace palpate::vdb
