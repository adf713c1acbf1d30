#include "output_files.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <system_error>

#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

Error operationError(std::string code, std::string message, std::string hint, std::string file) {
  return Error(ErrorKind::kOperation,
               {std::move(code), std::move(message), std::move(hint), std::move(file)});
}

}  // namespace

OutputFiles::~OutputFiles() {
  for (const File& file : files_) {
    std::error_code ignored;
    fs::remove(file.temporary, ignored);
  }
}

void OutputFiles::announce(const std::string& path, const std::vector<std::string>& inputs) {
  std::error_code failed;
  for (const std::string& input : inputs) {
    if (!input.empty() && fs::equivalent(path, input, failed)) {
      throw Error(ErrorKind::kUsage,
                  {"usage.output_is_input", "the output would replace the input " + input,
                   "choose another name", path});
    }
  }
  for (const File& other : files_) {
    if (fs::path(path).lexically_normal() == fs::path(other.path).lexically_normal()) {
      throw Error(ErrorKind::kUsage, {"usage.output_twice", "two outputs have the same name",
                                      "choose another name", path});
    }
  }
  const fs::path folder = fs::path(path).has_parent_path() ? fs::path(path).parent_path() : ".";
  if (!fs::is_directory(folder, failed)) {
    throw operationError("output.no_folder", "there is no folder " + folder.string(),
                         "make it first: mkdir -p " + folder.string(), path);
  }
  if (fs::is_directory(path, failed)) {
    throw operationError("output.is_folder", "this is a folder, not a file to write",
                         "name a file in it", path);
  }
  if (!overwrite_ && fs::exists(fs::symlink_status(path, failed))) {
    throw operationError("output.exists", "the file exists already",
                         "choose another name, or say --force to replace it", path);
  }
  if (access(folder.c_str(), W_OK | X_OK) != 0) {
    throw operationError(
        "output.not_writable",
        "cannot write to the folder " + folder.string() + ": " + std::strerror(errno),
        "choose a folder of yours", path);
  }
  files_.push_back({path, path + "." + std::to_string(getpid()) + ".tmp"});
}

const std::string& OutputFiles::temporary(const std::string& path) const {
  for (const File& file : files_) {
    if (file.path == path) return file.temporary;
  }
  throw std::logic_error("output was not announced: " + path);
}

void OutputFiles::write(const std::string& path, std::string_view text) const {
  const std::string& name = temporary(path);
  std::FILE* file = std::fopen(name.c_str(), "wb");
  bool good = file != nullptr && std::fwrite(text.data(), 1, text.size(), file) == text.size();
  int why = errno;
  if (file != nullptr && std::fclose(file) != 0) {
    why = errno;
    good = false;
  }
  if (!good) {
    throw operationError("output.write", std::string("cannot write: ") + std::strerror(why),
                         "look for room on the disk", path);
  }
}

void OutputFiles::commit() {
  std::vector<std::string>
      fresh;  // what this call brought into being, to be undone if a later one fails
  for (const File& file : files_) {
    std::error_code failed;
    const bool existed = fs::exists(fs::symlink_status(file.path, failed));
    if (existed && !overwrite_) {
      failed = std::make_error_code(std::errc::file_exists);  // it came while we worked
    } else {
      fs::rename(file.temporary, file.path, failed);
    }
    if (failed) {
      std::error_code ignored;
      for (const std::string& name : fresh) fs::remove(name, ignored);
      throw operationError("output.rename", "cannot give the file its name: " + failed.message(),
                           "", file.path);
    }
    if (!existed) fresh.push_back(file.path);
  }
  files_.clear();
}

}  // namespace palpate::tools
