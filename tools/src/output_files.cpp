#include "output_files.h"

#include <fcntl.h>
#include <sys/random.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <random>
#include <system_error>
#include <utility>

#include "console.h"
#include "palpate/core/error.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kStandardOutput = "-";

bool standard_output_is_taken = false;

Error operationError(std::string code, std::string message, std::string hint, std::string file) {
  return Error(ErrorKind::kOperation,
               {std::move(code), std::move(message), std::move(hint), std::move(file)});
}

/// Owns a file descriptor, and closes it.
class Descriptor {
 public:
  explicit Descriptor(int number) noexcept : number_(number) {}
  ~Descriptor() {
    if (number_ >= 0) close(number_);
  }
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;
  [[nodiscard]] int number() const noexcept { return number_; }
  /// False if the data could not all be written.
  [[nodiscard]] bool finish() noexcept { return close(std::exchange(number_, -1)) == 0; }

 private:
  int number_;
};

/// Writes all of `text`; returns false, with errno set, if it cannot. A stop ends the wait for a
/// slow reader.
bool writeAll(int to, std::string_view text) {
  while (!text.empty()) {
    const ssize_t done = ::write(to, text.data(), text.size());
    if (done < 0 && errno == EINTR) {
      checkStop();
      continue;
    }
    if (done <= 0) return false;
    text.remove_prefix(static_cast<std::size_t>(done));
  }
  return true;
}

/// Sixty-four random bits, as letters.
std::string randomWord() {
  std::uint64_t bits = 0;
  if (getrandom(&bits, sizeof bits, 0) != static_cast<ssize_t>(sizeof bits)) {
    bits = (std::uint64_t{std::random_device{}()} << 32U) ^ std::random_device{}();
  }
  std::string word;
  for (int i = 0; i < 13; ++i, bits >>= 5U) word += "abcdefghijklmnopqrstuvwxyz234567"[bits & 31U];
  return word;
}

/// Makes a new empty file whose name begins with `begin`, and returns its name; an empty name if it
/// cannot.
std::string makeTemporary(const std::string& begin) {
  for (int attempt = 0; attempt < 100; ++attempt) {
    std::string name = begin + "." + randomWord() + ".tmp";
    const Descriptor file(open(name.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC,
                               S_IRUSR | S_IWUSR | S_IRGRP | S_IWGRP | S_IROTH | S_IWOTH));
    if (file.number() >= 0) return name;
    if (errno != EEXIST) break;
  }
  return {};
}

/// The file that a symbolic link points to: that file is replaced, and the link stays.
std::string behindLink(const std::string& path) {
  std::error_code failed;
  if (!fs::is_symlink(fs::symlink_status(path, failed))) return path;
  const fs::path target = fs::weakly_canonical(path, failed);
  return failed ? path : target.string();
}

/// Whether two names mean the same file, existing or not: links and folders are resolved.
bool isSameFile(const std::string& a, const std::string& b) {
  std::error_code failed;
  const auto real = [&](const std::string& path) {
    const fs::path whole = fs::absolute(path, failed).lexically_normal();
    const fs::path out = fs::weakly_canonical(whole, failed);
    return failed ? whole : out;
  };
  return real(a) == real(b);
}

/// Gives `file` the mode of the file that it will replace, and that file's owner where this process
/// may.
void keepMode(const std::string& file, const std::string& replaced) {
  struct stat old = {};
  struct stat own = {};
  if (stat(replaced.c_str(), &old) != 0 || !S_ISREG(old.st_mode)) return;
  const Descriptor opened(open(file.c_str(), O_RDONLY | O_NOFOLLOW | O_CLOEXEC));
  if (opened.number() < 0 || fstat(opened.number(), &own) != 0) return;
  if (own.st_uid != old.st_uid || own.st_gid != old.st_gid) {
    static_cast<void>(!fchown(opened.number(), old.st_uid, old.st_gid));
  }
  constexpr mode_t kAll = S_ISUID | S_ISGID | S_ISVTX | S_IRWXU | S_IRWXG | S_IRWXO;
  static_cast<void>(!fchmod(opened.number(), old.st_mode & kAll));
}

/// Copies the data written for `path` to the pipe or device that `path` is.
void stream(const std::string& from, const std::string& path) {
  const bool is_standard = path == kStandardOutput;
  if (is_standard) std::fflush(stdout);
  int opened = -1;
  do {
    checkStop();  // writing to a pipe waits for its reader
    opened = is_standard ? dup(STDOUT_FILENO) : open(path.c_str(), O_WRONLY | O_NOCTTY | O_CLOEXEC);
  } while (opened < 0 && errno == EINTR);
  Descriptor to(opened);
  const Descriptor source(open(from.c_str(), O_RDONLY | O_CLOEXEC));
  bool good = to.number() >= 0 && source.number() >= 0;
  std::array<char, std::size_t{1} << 16U> buffer{};
  while (good) {
    const ssize_t got = read(source.number(), buffer.data(), buffer.size());
    good = got >= 0;
    if (got <= 0) break;
    good = writeAll(to.number(), {buffer.data(), static_cast<std::size_t>(got)});
  }
  good = good && to.finish();
  if (!good) {
    throw operationError("output.write", std::string("cannot write: ") + std::strerror(errno), "",
                         is_standard ? "standard output" : path);
  }
}

/// Renames a file; replaces an existing one only if `overwrite`.
bool rename(const std::string& from, const std::string& to, bool overwrite) {
  if (overwrite) return ::rename(from.c_str(), to.c_str()) == 0;
  if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0) return true;
  if (errno != EINVAL && errno != ENOSYS) return false;
  // For file systems without this kind of rename: link() fails as well if the target exists.
  return link(from.c_str(), to.c_str()) == 0 && unlink(from.c_str()) == 0;
}

}  // namespace

bool standardOutputIsTaken() noexcept { return standard_output_is_taken; }

std::string inputName(const std::string& path) { return path == "-" ? "/dev/stdin" : path; }

OutputFiles::~OutputFiles() {
  for (const File& file : files_) {
    std::error_code ignored;
    fs::remove(file.temporary, ignored);
  }
}

void OutputFiles::announce(const std::string& path, const std::vector<std::string>& inputs,
                           Streams streams) {
  std::error_code failed;
  const bool is_standard = path == kStandardOutput;
  if (is_standard && streams == Streams::kNo) {
    throw Error(ErrorKind::kUsage,
                {"usage.output_stream", "this output cannot go to standard output", "name a file"});
  }
  if (is_standard && json_) {
    throw Error(ErrorKind::kUsage,
                {"usage.output_stream", "- and --json both want standard output", "name a file"});
  }
  const fs::file_status status = is_standard ? fs::file_status() : fs::status(path, failed);
  const bool is_direct = is_standard || fs::is_fifo(status) || fs::is_character_file(status);
  for (const std::string& input : inputs) {
    if (!is_direct && !input.empty() && fs::equivalent(path, input, failed)) {
      throw Error(ErrorKind::kUsage,
                  {"usage.output_is_input", "the output would replace the input " + input,
                   "choose another name", path});
    }
  }
  for (const File& other : files_) {
    const bool is_other_standard = other.path == kStandardOutput;
    const bool is_same = is_standard || is_other_standard ? is_standard && is_other_standard
                                                          : isSameFile(path, other.path);
    if (is_same && (is_standard || !fs::is_character_file(status))) {
      throw Error(ErrorKind::kUsage, {"usage.output_twice", "two outputs are the same file",
                                      "choose another name", path});
    }
  }
  if (is_direct) {
    if (!is_standard && access(path.c_str(), W_OK) != 0) {
      throw operationError("output.not_writable",
                           std::string("cannot be written to: ") + std::strerror(errno), "", path);
    }
    const fs::path folder = fs::temp_directory_path(failed);
    const std::string beside = makeTemporary((failed ? fs::path("/tmp") : folder) / "palpate");
    if (beside.empty()) {
      throw operationError(
          "output.not_writable",
          "cannot write to the folder for temporary files: " + std::string(std::strerror(errno)),
          "set TMPDIR to a folder of yours", path);
    }
    standard_output_is_taken = standard_output_is_taken || is_standard;
    files_.push_back({path, beside, path, true});
    return;
  }
  const std::string target = behindLink(path);
  const fs::path folder = fs::path(target).has_parent_path() ? fs::path(target).parent_path() : ".";
  if (!fs::is_directory(folder, failed)) {
    throw operationError("output.no_folder", "there is no folder " + folder.string(),
                         "make it first: mkdir -p " + folder.string(), path);
  }
  if (fs::is_directory(status)) {
    throw operationError("output.is_folder", "this is a folder, not a file to write",
                         "name a file in it", path);
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    throw operationError("output.not_a_file", "this is not a file, a pipe or a character device",
                         "choose another name", path);
  }
  if (!overwrite_ && fs::exists(fs::symlink_status(path, failed))) {
    throw operationError("output.exists", "the file exists already",
                         "choose another name, or say --force to replace it", path);
  }
  const std::string beside = makeTemporary(target);
  if (beside.empty()) {
    throw operationError(
        "output.not_writable",
        "cannot write to the folder " + folder.string() + ": " + std::strerror(errno),
        "choose a folder of yours", path);
  }
  files_.push_back({path, beside, target, false});
}

const std::string& OutputFiles::temporary(const std::string& path) const {
  for (const File& file : files_) {
    if (file.path == path) return file.temporary;
  }
  throw std::logic_error("output was not announced: " + path);
}

void OutputFiles::write(const std::string& path, std::string_view text) const {
  Descriptor file(open(temporary(path).c_str(), O_WRONLY | O_TRUNC | O_NOFOLLOW | O_CLOEXEC));
  const bool good = file.number() >= 0 && writeAll(file.number(), text) && file.finish();
  if (!good) {
    throw operationError("output.write", std::string("cannot write: ") + std::strerror(errno),
                         "look for room on the disk", path);
  }
}

void OutputFiles::place(const std::string& path) {
  const auto at = std::find_if(files_.begin(), files_.end(),
                               [&](const File& file) { return file.path == path; });
  if (at == files_.end()) throw std::logic_error("output was not announced: " + path);
  if (at->is_direct) {
    throw Error(ErrorKind::kUsage, {"usage.output_stream", "this output must be a regular file",
                                    "choose another name", path});
  }
  keepMode(at->temporary, at->target);
  if (!rename(at->temporary, at->target, overwrite_)) {
    throw operationError("output.rename",
                         std::string("cannot give the file its name: ") + std::strerror(errno), "",
                         at->target);
  }
  files_.erase(at);
}

void OutputFiles::keep(const std::string& path) {
  const auto at = std::find_if(files_.begin(), files_.end(),
                               [&](const File& file) { return file.path == path; });
  if (at != files_.end() && !at->is_direct) place(path);
}

void OutputFiles::commit() {
  std::vector<std::string> fresh;  // files created by this call, to be removed if a later one fails
  const auto undo = [&] {
    std::error_code ignored;
    for (const std::string& name : fresh) fs::remove(name, ignored);
  };
  for (const File& file : files_) {
    if (file.is_direct) continue;
    std::error_code failed;
    const bool existed = fs::exists(fs::symlink_status(file.target, failed));
    keepMode(file.temporary, file.target);
    if (!rename(file.temporary, file.target,
                overwrite_)) {  // without --force, this fails if the file appeared during the run
      const int why = errno;
      undo();
      throw operationError("output.rename",
                           std::string("cannot give the file its name: ") + std::strerror(why), "",
                           file.target);
    }
    if (!existed) fresh.push_back(file.target);
  }
  // Data sent through a pipe cannot be taken back, so that pipes come last.
  for (const File& file : files_) {
    if (!file.is_direct) continue;
    try {
      stream(file.temporary, file.path);
    } catch (const Error&) {
      undo();
      throw;
    }
    std::error_code ignored;
    fs::remove(file.temporary, ignored);
  }
  files_.clear();
}

}  // namespace palpate::tools
