#include "keep/source_state.h"

#include <sys/stat.h>

#include <algorithm>

#include "keep/content_key.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {

SourceState::SourceState(const std::vector<std::string>& files) : is_known_(!files.empty()) {
  for (const std::string& path : files) files_.push_back(look(path));
}

SourceState::SourceState(const std::vector<std::string>& files, ContentKey& key,
                         const std::vector<std::string>& folders)
    : SourceState(folders) {
  is_known_ = !files.empty();
  key.add(files.size());
  for (const std::string& path : files) {
    files_.push_back(look(path));  // before the file is read, so that a change meanwhile is noticed
    if (files.size() > 1) key.add(fileName(path));
    is_known_ = is_known_ && key.addFile(path);
  }
}

SourceState::File SourceState::look(const std::string& path) {
  File file{path};
  struct stat about {};
  if (stat(path.c_str(), &about) != 0) return file;
  file.device = about.st_dev;
  file.node = about.st_ino;
  file.bytes = about.st_size;
  // The times of the last write and of the last change of its metadata: a process that replaces the
  // file may preserve the first of them.
  file.times = {about.st_mtim.tv_sec, about.st_mtim.tv_nsec, about.st_ctim.tv_sec,
                about.st_ctim.tv_nsec};
  return file;
}

bool SourceState::isUnchanged() const {
  return is_known_ && std::all_of(files_.begin(), files_.end(),
                                  [](const File& file) { return file == look(file.path); });
}

}  // namespace palpate::vdb
