// Which files beside a glTF file belong to it.

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <system_error>

#include "mesh/builder.h"
#include "mesh/gltf_guard.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/kept_grids.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

constexpr std::size_t kJsonBegins = 20;  ///< of a GLB file, whose first part is its JSON text

/// Finds the values at buffers[*].uri in JSON text, however deep the rest of it is nested.
class Buffers {
 public:
  explicit Buffers(std::string_view json) : json_(json) {}

  [[nodiscard]] std::vector<std::string> names() {
    while (at_ < json_.size()) {
      if (at_ % (std::size_t{1} << 16U) == 0) pollStop();
      const char c = json_[at_];
      if (c == '"') {
        text();
        continue;
      }
      if (c == '{' || c == '[') ++depth_;
      ++at_;
      // In a GLB file any bytes may follow the JSON text.
      if ((c == '}' || c == ']') && --depth_ <= 0) break;
    }
    return std::move(names_);
  }

 private:
  /// Reads a text in quotes; it is a key if a colon follows.
  void text() {
    const std::size_t begin = ++at_;
    while (at_ < json_.size() && json_[at_] != '"') at_ += json_[at_] == '\\' ? 2 : 1;
    at_ = std::min(at_, json_.size());
    const std::string_view found = json_.substr(begin, at_ - begin);
    at_ = std::min(json_.find_first_not_of(" \t\r\n", at_ + 1), json_.size());
    const bool is_key = at_ < json_.size() && json_[at_] == ':';
    // Depth 1 is the outermost object, 2 the list of buffers, 3 an object in that list.
    if (is_key && depth_ == 1) is_in_buffers_ = found == "buffers";
    if (!is_key && depth_ == 3 && is_in_buffers_ && key_ == "uri" && !found.starts_with("data:")) {
      names_.push_back(plain(found));
    }
    if (is_key) key_ = found;
  }

  /// Removes the backslashes of JSON. A character that is written by its number stays as it is;
  /// then no file has that name.
  static std::string plain(std::string_view text) {
    std::string out;
    for (std::size_t i = 0; i < text.size(); ++i) {
      if (text[i] == '\\' && i + 1 < text.size() && text[i + 1] != 'u') ++i;
      out += text[i];
    }
    return out;
  }

  std::string_view json_;
  std::size_t at_ = 0;
  int depth_ = 0;
  bool is_in_buffers_ = false;
  std::string_view key_;
  std::vector<std::string> names_;
};

}  // namespace

std::vector<std::string> gltfBuffers(std::string_view bytes) {
  if (bytes.starts_with("glTF")) bytes.remove_prefix(std::min(kJsonBegins, bytes.size()));
  return Buffers(bytes).names();
}

std::vector<std::string> meshFiles(const std::string& path) {
  std::vector<std::string> all = {path};
  if (!hasExtension(path, ".gltf") && !hasExtension(path, ".glb")) return all;
  const std::filesystem::path folder = std::filesystem::path(path).parent_path();
  for (const std::string& name : gltfBuffers(readBytes(path))) {
    std::string file = (folder / name).string();
    std::error_code failed;
    if (!std::filesystem::is_regular_file(file, failed)) return {};
    if (std::find(all.begin(), all.end(), file) == all.end()) all.push_back(std::move(file));
  }
  return all;
}

}  // namespace palpate::vdb
