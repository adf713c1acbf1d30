#include "view/scene_watch.h"

#include <sys/stat.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string_view>
#include <system_error>
#include <utility>

#include "named_files.h"
#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

std::optional<std::string> textOf(const std::string& file) {
  std::error_code failed;
  // Opening a pipe would wait for its writer.
  if (!fs::is_regular_file(file, failed)) return std::nullopt;
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  std::ostringstream text;
  text << in.rdbuf();
  return text.str();
}

FileStamp stampOf(const fs::path& file) {
  struct stat status = {};
  if (stat(file.c_str(), &status) != 0) return {};
  const auto nanoseconds = [](const timespec& time) {
    return static_cast<std::int64_t>(time.tv_sec) * 1'000'000'000 + time.tv_nsec;
  };
  return {status.st_dev, status.st_ino, status.st_size, nanoseconds(status.st_mtim),
          nanoseconds(status.st_ctim)};
}

/// A text that begins like a number, such as "1500 N/m", counts only if a file has that name.
bool isWorthALook(const fs::path& path, const fs::path& folder) {
  constexpr std::string_view kNumbers = "+-.0123456789";
  const std::string text = path.lexically_relative(folder).string();
  const bool is_up = text.starts_with("..") || text.starts_with("./");
  if (is_up || text.empty() || kNumbers.find(text.front()) == std::string_view::npos) return true;
  std::error_code failed;
  return fs::exists(path, failed);
}

}  // namespace

SceneWatch::SceneWatch(std::string file) : file_(std::move(file)) {
  first_.text = textOf(file_);
  if (first_.text) follow(*first_.text);
  first_.named = stamps();
  told_ = last_ = first_;
}

std::optional<SceneSight> SceneWatch::look() {
  SceneSight now{textOf(file_), stamps()};
  gone_ = now.text ? 0 : gone_ + 1;
  if (!now.text && gone_ < kGone) return std::nullopt;
  const bool is_settled = !now.text || now == last_;
  last_ = std::move(now);
  if (!is_settled || last_ == told_) return std::nullopt;
  if (last_.text && last_.text != told_.text) {
    follow(*last_.text);
    last_.named = stamps();
  }
  told_ = last_;
  return told_;
}

std::vector<FileStamp> SceneWatch::stamps() const {
  std::vector<FileStamp> all;
  for (const fs::path& path : named_) {
    const std::vector<fs::path> files = filesAt(path);
    if (files.empty()) all.emplace_back();
    for (const fs::path& file : files) all.push_back(stampOf(file));
  }
  return all;
}

void SceneWatch::follow(const std::string& text) {
  try {
    const fs::path folder = fs::path(file_).parent_path();
    std::vector<fs::path> named = namedPaths(parseDocument(text, file_)->root, folder);
    std::erase_if(named, [&](const fs::path& path) { return !isWorthALook(path, folder); });
    named_ = std::move(named);
  } catch (const Error&) {
    // A text that is not YAML names no files. Files named before still belong to the felt scene.
  }
}

}  // namespace palpate::tools
