#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <utility>

#include "grid/vdb_archive.h"
#include "material/material_file.h"
#include "palpate/core/error.h"
#include "palpate/vdb/io.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

Error writeError(const std::string& path, const std::string& what) {
  return Error(ErrorKind::kOperation, {"vdb.write", what, "", path});
}

/// A new file beside the target; the destructor removes it unless it was put in place.
class TemporaryFile {
 public:
  explicit TemporaryFile(const std::string& path) : target_(path) {
    int file = -1;
    for (int n = 0; file < 0; ++n) {
      path_ = path + "." + std::to_string(getpid()) + "-" + std::to_string(n) + ".part";
      file = open(path_.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0666);
      if (file < 0 && errno != EEXIST) {
        throw writeError(target_, std::string("cannot be written: ") + strerror(errno));
      }
    }
    // A file that is replaced keeps its mode.
    struct stat old = {};
    if (stat(target_.c_str(), &old) == 0 && S_ISREG(old.st_mode)) {
      static_cast<void>(!fchmod(file, old.st_mode & 0777U));
    }
    close(file);
  }
  ~TemporaryFile() {
    if (!path_.empty()) unlink(path_.c_str());
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  [[nodiscard]] const std::string& path() const noexcept { return path_; }

  void putInPlace(bool overwrite) {
    synchronize(path_);
    // link() fails where rename() would replace a file.
    const int failed =
        overwrite ? rename(path_.c_str(), target_.c_str()) : link(path_.c_str(), target_.c_str());
    if (failed != 0)
      throw writeError(target_, std::string("cannot be written: ") + strerror(errno));
    if (overwrite) path_.clear();
    const std::string folder = std::filesystem::path(target_).parent_path().string();
    synchronize(folder.empty() ? "." : folder);
  }

 private:
  void synchronize(const std::string& what) const {
    const int file = open(what.c_str(), O_RDONLY | O_CLOEXEC);
    const bool failed = file < 0 || (fsync(file) != 0 && errno != EINVAL);
    const int reason = errno;
    if (file >= 0) close(file);
    if (failed) throw writeError(target_, std::string("cannot be written: ") + strerror(reason));
  }

  std::string target_;
  std::string path_;
};

}  // namespace

void writeVdb(const std::string& path, std::span<const LevelSet> grids, bool overwrite,
              std::span<const NamedMaterialGrid> materials) {
  std::error_code error;
  if (!overwrite && std::filesystem::exists(path, error)) {
    throw Error(ErrorKind::kOperation, {"file.exists", "the file exists already",
                                        "allow overwriting, or name another", path});
  }
  // Renaming over a device or a pipe would destroy it, and a .vdb file cannot be streamed into one.
  if (std::filesystem::exists(path, error) && !std::filesystem::is_regular_file(path, error)) {
    throw writeError(path, "this is not a file; a .vdb file cannot be written to it");
  }
  openvdb::GridCPtrVec pointers;
  for (const LevelSet& grid : grids) pointers.push_back(grid.impl().grid);
  for (const NamedMaterialGrid& material : materials) pointers.push_back(toOpenVdb(material));
  TemporaryFile file(path);
  try {
    std::ofstream stream(file.path(), std::ios::binary | std::ios::trunc);
    stream.exceptions(std::ios::failbit | std::ios::badbit);
    VdbArchive().writeTo(stream, pointers);
    stream.close();
  } catch (const std::ios_base::failure&) {
    throw writeError(path, std::string("writing failed: ") + strerror(errno));
  } catch (const openvdb::Exception& failure) {
    throw writeError(path, std::string("writing failed: ") + failure.what());
  }
  file.putInPlace(overwrite);
}

}  // namespace palpate::vdb
