#include <algorithm>
#include <filesystem>
#include <set>
#include <system_error>

#include "image/meta_image_header.h"
#include "image/nrrd_header.h"
#include "image/readers.h"
#include "palpate/core/error.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

std::set<std::string> filesIn(const fs::path& folder) {
  std::set<std::string> files;
  for (const auto& entry : fs::directory_iterator(folder)) {
    if (entry.is_regular_file()) files.insert(entry.path().string());
  }
  return files;
}

bool hasOneOf(const std::string& path, std::initializer_list<const char*> extensions) {
  return std::any_of(extensions.begin(), extensions.end(),
                     [&](const char* extension) { return hasExtension(path, extension); });
}

/// The file itself, and the one that its header names.
std::set<std::string> withVoxels(const std::string& path, const ImageOptions& options) {
  if (hasOneOf(path, {".nrrd", ".nhdr"})) return {path, readNrrdHeader(path, options).data_path};
  if (hasOneOf(path, {".mha", ".mhd"})) {
    return {path, readMetaImageHeader(path, options).data_path};
  }
  if (hasOneOf(path, {".nii", ".nii.gz"})) return {path};
  if (!isDicomFile(path)) return {path};
  const std::string folder = fs::path(path).parent_path().string();
  return filesIn(folder.empty() ? "." : folder);
}

}  // namespace

std::vector<std::string> imageFiles(const std::string& path, const ImageOptions& options) try {
  ImageOptions one = options;
  one.with.clear();
  one.priority.clear();
  std::vector<std::string> listed = options.with;
  listed.insert(listed.begin(), path);
  std::set<std::string> all;
  for (const std::string& each : listed) {
    if (fs::is_directory(each)) {
      const bool is_series = isDicomFolder(each);
      for (const std::string& file : filesIn(each)) {
        all.insert(file);
        // Masks may have their voxels in other files.
        if (!is_series && isImageFile(file)) all.merge(withVoxels(file, one));
      }
    } else {
      all.merge(withVoxels(each, one));
    }
  }
  return {all.begin(), all.end()};
} catch (const Error&) {
  return {};
} catch (const fs::filesystem_error&) {
  return {};
}

}  // namespace palpate::vdb
