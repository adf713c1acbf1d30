#include "grid/grid_cache.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <exception>
#include <filesystem>
#include <system_error>
#include <vector>

#include "palpate/vdb/certificate.h"
#include "palpate/vdb/io.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

/// Makes the folder if it is missing; false unless it is the user's own and nobody else may write to it.
bool isOwn(const std::string& folder) {
  std::error_code failure;
  if (fs::create_directories(folder, failure)) {
    fs::permissions(folder, fs::perms::owner_all, failure);
  }
  struct stat about {};
  if (lstat(folder.c_str(), &about) != 0 || !S_ISDIR(about.st_mode)) return false;
  return about.st_uid == geteuid() && (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

}  // namespace

std::string GridCache::pathOf(const std::string& key) const {
  return (fs::path(folder_) / (key + ".vdb")).string();
}

std::optional<LevelSet> GridCache::find(const std::string& key) const {
  if (folder_.empty()) return {};
  const std::string path = pathOf(key);
  std::error_code failure;
  if (!fs::is_regular_file(path, failure) || !isOwn(folder_)) return {};
  try {
    LevelSet grid = readVdb(path, "", "");
    if (!storedCertificate(grid)) return {};
    fs::last_write_time(path, fs::file_time_type::clock::now(), failure);
    return grid;
  } catch (const std::exception&) {
    return {};
  }
}

void GridCache::keep(const std::string& key, const LevelSet& grid) const {
  if (folder_.empty() || grid.info().active_voxels < kLeastVoxels || !isOwn(folder_)) return;
  if (grid.info().memory > kMostBytes / 4) return;
  try {
    const std::vector<LevelSet> one{grid};
    writeVdb(pathOf(key), one, true);
    makeRoom();
  } catch (const std::exception&) {
    // A full disk, say: the grid is made again next time.
  }
}

void GridCache::makeRoom() const {
  struct File {
    fs::path path;
    fs::file_time_type used;
    std::uintmax_t bytes;
  };
  std::vector<File> files;
  std::uintmax_t all = 0;
  std::error_code failure;
  for (const auto& entry : fs::directory_iterator(folder_, failure)) {
    if (!entry.is_regular_file(failure) || entry.path().extension() != ".vdb") continue;
    const File file{entry.path(), entry.last_write_time(failure), entry.file_size(failure)};
    if (failure) continue;
    files.push_back(file);
    all += file.bytes;
  }
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return a.used < b.used; });
  for (const File& file : files) {
    if (all <= kMostBytes) return;
    if (fs::remove(file.path, failure)) all -= file.bytes;
  }
}

}  // namespace palpate::vdb
