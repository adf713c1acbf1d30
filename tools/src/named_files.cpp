#include "named_files.h"

#include <algorithm>
#include <string>
#include <system_error>

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

void addNamed(const Node& node, const fs::path& folder, std::vector<fs::path>& paths) {
  if (node.kind == Node::Kind::kScalar) {
    // File names contain a dot, a separator or quotes. Numbers and plain words are not looked up on
    // the disk.
    const bool may_be = node.quoted || node.text.find_first_of("./") != std::string::npos;
    if (may_be && !node.text.empty()) paths.push_back(folder / node.text);
  }
  for (const Node& item : node.items) addNamed(item, folder, paths);
  for (const Node::Entry& entry : node.entries) addNamed(entry.value, folder, paths);
}

}  // namespace

std::vector<fs::path> namedPaths(const Node& root, const fs::path& folder) {
  std::vector<fs::path> paths;
  addNamed(root, folder, paths);
  return paths;
}

std::vector<fs::path> filesAt(const fs::path& path) {
  std::error_code failed;
  if (fs::is_regular_file(path, failed)) return {path};
  std::vector<fs::path> files;
  if (!fs::is_directory(path, failed)) return files;
  // Not a range-based loop, whose increment throws if something disappears meanwhile.
  const fs::directory_iterator end;
  for (fs::directory_iterator at(path, failed); !failed && at != end; at.increment(failed)) {
    std::error_code ignored;
    if (at->is_regular_file(ignored)) files.push_back(at->path());
  }
  std::sort(files.begin(), files.end());
  return files;
}

}  // namespace palpate::tools
