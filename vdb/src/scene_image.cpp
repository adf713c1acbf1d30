#include "scene_image.h"

namespace palpate::vdb {

void Notes::add(const std::string& path, const std::vector<std::string>& notes) {
  for (const std::string& note : notes) {
    std::string whole = path + ": " + note;
    if (told_.insert(whole).second && tell_) tell_(whole);
  }
}

const Image& ImageFile::image() {
  if (!image_) {
    image_ = readNifti(path_);
    notes_->add(path_, image_->notes);
  }
  return *image_;
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

std::shared_ptr<SceneImage> SceneImages::read(MapReader& reader) {
  auto made = std::make_shared<SceneImage>();
  const std::string path = reader.loader().resolvePath(reader.requireText("file"));
  try {
    notes_->add(path, readNiftiInfo(path).notes);
  } catch (const Error& error) {
    throw atKey(reader, "file", error);
  }
  made->file = files_[path].lock();
  if (!made->file) {
    made->file = std::make_shared<ImageFile>(path, notes_);
    files_[path] = made->file;
  }
  if (const std::string names = reader.textOr("names", ""); !names.empty()) {
    made->names_path = reader.loader().resolvePath(names);
    try {
      made->names = readNameTable(made->names_path);
    } catch (const Error& error) {
      throw atKey(reader, "names", error);
    }
  }
  return made;
}

}  // namespace palpate::vdb
