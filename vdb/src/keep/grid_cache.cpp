#include "keep/grid_cache.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <exception>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <system_error>
#include <vector>

#include "keep/seal.h"
#include "palpate/core/error.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/io.h"

namespace palpate::vdb {
namespace {

namespace fs = std::filesystem;

constexpr const char* kGrid = ".vdb";
constexpr const char* kText = ".txt";
constexpr const char* kPart = ".part";
/// Age from which a part of a file was abandoned by a killed process. Writing one takes seconds.
constexpr auto kAbandoned = std::chrono::hours(1);

/// A temporary file beside the final one, until it is complete.
class Part {
 public:
  explicit Part(const std::string& place) {
    static std::atomic<unsigned> count = 0;
    path_ = place + "." + std::to_string(getpid()) + "-" + std::to_string(count++) + kPart;
  }
  ~Part() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove(path_, ignored);
  }
  Part(const Part&) = delete;
  Part& operator=(const Part&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  [[nodiscard]] bool sealAs(const std::string& key, const std::string& place) {
    std::error_code failure;
    if (!seal(path_, key)) return false;
    fs::rename(path_, place, failure);
    if (failure) return false;
    path_.clear();
    return true;
  }

 private:
  std::string path_;
};

/// Whether a file has a name that this cache gives; no other file is ever removed.
bool isOurs(const fs::path& path) {
  std::string name = path.filename().string();
  const auto end = name.find_first_not_of("0123456789abcdef-");
  return end != std::string::npos && end >= 16 &&
         (name.compare(end, std::string::npos, kGrid) == 0 ||
          name.compare(end, std::string::npos, kText) == 0 || name.ends_with(kPart));
}

void touch(const std::string& path) {
  std::error_code ignored;
  fs::last_write_time(path, fs::file_time_type::clock::now(), ignored);
}

}  // namespace

bool GridCache::isUsable() const {
  if (folder_.empty()) return false;
  std::error_code failure;
  if (owner_ == Owner::kAnyone) return fs::is_directory(folder_, failure);
  fs::create_directories(fs::path(folder_).parent_path(), failure);
  static_cast<void>(mkdir(folder_.c_str(), S_IRWXU));
  // Another user may have chosen the target of a link, unless the link is the user's own.
  struct stat link {};
  struct stat about {};
  if (lstat(folder_.c_str(), &link) != 0 || link.st_uid != geteuid()) return false;
  if (stat(folder_.c_str(), &about) != 0 || !S_ISDIR(about.st_mode)) return false;
  return about.st_uid == geteuid() && (about.st_mode & (S_IWGRP | S_IWOTH)) == 0;
}

std::string GridCache::pathOf(const std::string& key, const char* extension) const {
  return (fs::path(folder_) / (key + extension)).string();
}

std::optional<LevelSet> GridCache::find(const std::string& key, Sampler sampler,
                                        std::uint64_t max_memory) const {
  if (folder_.empty()) return {};
  const std::string path = pathOf(key, kGrid);
  std::error_code failure;
  if (!fs::is_regular_file(path, failure) || !isUsable() || !isSealed(path, key)) return {};
  try {
    LevelSet grid = readVdb(path, "", "", UnknownClass::kRefuse, max_memory);
    if (!storedCertificate(grid, sampler)) return {};
    touch(path);
    return grid;
  } catch (const Error& error) {
    if (error.kind() == ErrorKind::kCancelled) throw;
    return {};
  } catch (const std::exception&) {
    return {};
  }
}

bool GridCache::keep(const std::string& key, const LevelSet& grid) const {
  if (!isUsable() || grid.info().memory > most_ / 4) return false;
  const std::string path = pathOf(key, kGrid);
  Part part(path);
  try {
    const std::vector<LevelSet> one{grid};
    writeVdb(part.path(), one, true);
    const bool is_kept = part.sealAs(key, path);
    makeRoom();
    return is_kept;
  } catch (const Error& error) {
    // A full disk, for example: the grid is then made again next time.
    if (error.kind() == ErrorKind::kCancelled) throw;
  } catch (const std::exception&) {  // nothing was kept, which is not an error
  }
  return false;
}

bool GridCache::mayHave(const std::string& key) const {
  std::error_code failure;
  return !folder_.empty() && fs::is_regular_file(pathOf(key, kGrid), failure) && isUsable();
}

std::optional<std::string> GridCache::findText(const std::string& key) const {
  if (folder_.empty()) return {};
  const std::string path = pathOf(key, kText);
  std::error_code failure;
  if (!fs::is_regular_file(path, failure) || !isUsable() || !isSealed(path, key)) return {};
  std::ifstream in(path, std::ios::binary);
  std::ostringstream all;
  all << in.rdbuf();
  std::string text = all.str();
  if (!in || text.size() < sealBytes(key)) return {};
  text.resize(text.size() - sealBytes(key));
  touch(path);
  return text;
}

bool GridCache::keepText(const std::string& key, const std::string& text) const {
  if (!isUsable()) return false;
  const std::string path = pathOf(key, kText);
  Part part(path);
  std::ofstream out(part.path(), std::ios::binary | std::ios::trunc);
  out << text;
  out.close();
  return out.good() && part.sealAs(key, path);
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
  const auto abandoned = fs::file_time_type::clock::now() - kAbandoned;
  for (fs::directory_iterator at(folder_, failure), end; at != end; at.increment(failure)) {
    // Another process may remove it meanwhile.
    std::error_code gone;
    if (!isOurs(at->path()) || !at->is_regular_file(gone)) continue;
    const fs::file_time_type used = at->last_write_time(gone);
    const std::uintmax_t bytes = gone ? 0 : at->file_size(gone);
    if (gone) continue;
    const bool is_part = at->path().extension() == kPart;
    if (is_part && used < abandoned && fs::remove(at->path(), gone)) continue;
    all += bytes;
    if (!is_part) files.push_back({at->path(), used, bytes});
  }
  std::sort(files.begin(), files.end(),
            [](const File& a, const File& b) { return a.used < b.used; });
  for (const File& file : files) {
    if (all <= most_) return;
    if (fs::remove(file.path, failure)) all -= file.bytes;
  }
}

}  // namespace palpate::vdb
