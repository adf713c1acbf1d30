#include "scene_image.h"

#include <algorithm>
#include <filesystem>

#include "image/readers.h"
#include "keep/content_key.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"
#include "stand_in.h"
#include "voxel_box.h"

namespace palpate::vdb {

void Notes::add(const std::string& path, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    if (list_ != nullptr) list_->emplace_back(path, note);
    std::string whole = path + ": " + note;
    if (told_.insert(whole).second && tell_) tell_(whole);
  }
}

ImageFile::ImageFile(std::string path, std::string content_key, std::shared_ptr<Notes> notes)
    : path_(std::move(path)),
      notes_(std::move(notes)),
      key_(std::move(content_key)),
      has_voxels_(false) {
  state_ = SourceState({path_});
}

std::vector<std::string> ImageFile::folders() const {
  std::vector<std::string> all = options_.with;
  all.push_back(path_);
  std::erase_if(all, [](const std::string& each) { return !std::filesystem::is_directory(each); });
  if (std::filesystem::is_regular_file(path_) && isDicomFile(path_)) {
    const std::string series = std::filesystem::path(path_).parent_path().string();
    all.push_back(series.empty() ? "." : series);
  }
  return all;
}

std::vector<std::string> ImageFile::foldersAndFiles() const {
  std::vector<std::string> all = folders();
  for (const std::string& file : imageFiles(path_, options_)) all.push_back(file);
  return all;
}

const Image& ImageFile::image() {
  if (!has_voxels_) {
    throw inputError(
        "pack.no_scan",
        "the scan is not in the bundle, so only the layers that were packed can be made",
        "undo changes to the layers of this image, or name the scan itself", path_);
  }
  if (!image_) {
    decoded_ = SourceState(foldersAndFiles());
    image_ = readImage(path_, options_);
  }
  notes_->add(path_, image_->notes);
  return *image_;
}

const std::string& ImageFile::contentKey() {
  if (key_.empty()) {
    ContentKey key;
    state_ = SourceState(imageFiles(path_, options_), key, folders());
    // The known voxels may come from an earlier version of the file.
    if (image_ && !state_.isOfTheSame(decoded_)) state_ = {};
    key.add(static_cast<int>(options_.affine)).add(static_cast<int>(options_.space));
    key.add(options_.frame.value_or(-1)).add(options_.series);
    if (options_.resample) key.add("resample");
    // Their order is the order of the labels.
    for (const std::string& file : options_.with) key.add(fileName(file));
    key.add("priority");
    for (const std::string& name : options_.priority) key.add(name);
    key_ = key.text();
  }
  return key_;
}

const SourceState& ImageFile::state() {
  static_cast<void>(contentKey());
  return state_;
}

Box3 ImageFile::boxOfLabels(const std::vector<int>& labels) {
  if (!boxes_) boxes_ = boxesOfValues(image());
  Box3 all;
  for (const int label : labels) {
    const auto box = boxes_->find(static_cast<float>(label));
    if (box == boxes_->end()) continue;
    all.include(box->second.lo);
    all.include(box->second.hi);
  }
  return all.grownBy(1.5 * longestStep(image()));
}

LabelSurfaces& SceneImage::surfaces() {
  if (!surfaces_ || layers_then_ != layers.size()) {
    surfaces_ = std::make_unique<LabelSurfaces>(file->image(), layers);
    layers_then_ = layers.size();
  }
  return *surfaces_;
}

Error atKey(const MapReader& reader, std::string_view key, const Error& error) {
  const Problem& problem = error.problem();
  std::string where = problem.file;
  if (problem.line > 0) where += ':' + std::to_string(problem.line);
  return reader.errorAt(key, problem.code, (where.empty() ? "" : where + ": ") + problem.message,
                        problem.hint);
}

namespace {

/// The texts of a list.
std::vector<std::string> readTexts(const MapReader& reader, std::string_view key) {
  std::vector<std::string> texts;
  if (!reader.has(key)) return texts;
  const Node& list = *reader.find(key);
  const auto is_text = [](const Node& item) {
    return item.kind == Node::Kind::kScalar && !item.text.empty();
  };
  if (list.kind != Node::Kind::kSequence || list.items.empty() ||
      !std::all_of(list.items.begin(), list.items.end(), is_text)) {
    throw reader.errorAt(key, "scene.kind", "'" + std::string(key) + "' must be a list of texts",
                         "write " + std::string(key) + ": [one, another]");
  }
  for (const Node& item : list.items) texts.push_back(item.text);
  return texts;
}

ImageOptions readImageOptions(const MapReader& reader) {
  constexpr AffineChoice kAffines[] = {AffineChoice::kSform, AffineChoice::kQform,
                                       AffineChoice::kSpacing};
  ImageOptions options;
  if (reader.has("affine")) options.affine = kAffines[reader.choice("affine")];
  options.space = readSpace(reader);
  if (reader.has("frame")) options.frame = static_cast<int>(reader.value("frame"));
  options.series = reader.text("series");
  options.resample = reader.flag("resample");
  for (const std::string& file : readTexts(reader, "with")) {
    options.with.push_back(reader.loader().resolvePath(file));
  }
  options.priority = readTexts(reader, "priority");
  return options;
}

/// A key that distinguishes ways to read a file.
std::string keyOf(const std::string& path, const ImageOptions& options) {
  std::string key = path + '\n' + std::to_string(static_cast<int>(options.affine)) + '\n' +
                    std::to_string(static_cast<int>(options.space)) + '\n' +
                    std::to_string(options.frame.value_or(-1)) + '\n' + options.series +
                    (options.resample ? "\nresample" : "");
  for (const std::string& file : options.with) key += '\n' + file;
  key += '\n';
  for (const std::string& name : options.priority) key += '\n' + name;
  return key;
}

}  // namespace

Space readSpace(const MapReader& reader) {
  if (!reader.has("space")) return Space::kStated;
  return reader.choice("space") == 0 ? Space::kRas : Space::kLps;
}

std::shared_ptr<SceneImage> SceneImages::read(const MapReader& reader) {
  auto made = std::make_shared<SceneImage>();
  const std::string path = reader.loader().resolvePath(reader.text("file"));
  const ImageOptions options = readImageOptions(reader);
  ImageRecord record{path, options, reader.has("names")};
  std::string stand_in_key;
  if (isStandIn(path)) {
    StandIn stand_in = readStandIn(path);
    stand_in_key = std::move(stand_in.content_key);
    record.is_labels = record.is_labels || stand_in.is_labels;
    made->labels = std::move(stand_in.labels);
    made->names_path = path;
  } else {
    try {
      ImageInfo info = readImageInfo(path, options);
      notes_->add(path, info.notes);
      record.is_labels = record.is_labels || info.is_labels;
      if (!info.labels.names.empty()) {
        made->labels = std::move(info.labels);
        made->names_path = path;
      }
    } catch (const Error& error) {
      throw atKey(reader, "file", error);
    }
  }
  std::weak_ptr<ImageFile>& known = files_[keyOf(path, options)];
  made->file = known.lock();
  if (!made->file) {
    made->file = stand_in_key.empty()
                     ? std::make_shared<ImageFile>(path, options, notes_)
                     : std::make_shared<ImageFile>(path, std::move(stand_in_key), notes_);
    known = made->file;
  }
  if (reader.has("names")) {
    made->names_path = reader.loader().resolvePath(reader.text("names"));
    try {
      made->labels = readLabelTable(made->names_path);
    } catch (const Error& error) {
      throw atKey(reader, "names", error);
    }
  }
  if (tell_) tell_(record);
  return made;
}

}  // namespace palpate::vdb
