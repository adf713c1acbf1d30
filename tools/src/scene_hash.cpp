#include "scene_hash.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <system_error>
#include <vector>

#include "console.h"
#include "palpate/core/error.h"
#include "palpate/devices/record.h"
#include "palpate/scene/scene_file.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

std::uint64_t hashOfFile(const fs::path& file, std::uint64_t hash) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 20U);
  while (in) {
    checkStop();
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash = devices::checksum({buffer.data(), static_cast<std::size_t>(in.gcount())}, hash);
  }
  return hash;
}

std::uint64_t hashOfPath(const fs::path& path, std::uint64_t hash) {
  std::error_code failed;
  if (fs::is_regular_file(path, failed)) return hashOfFile(path, hash);
  if (!fs::is_directory(path, failed)) return hash;
  std::vector<fs::path> files;
  for (const auto& entry : fs::directory_iterator(path, failed)) {
    if (entry.is_regular_file(failed)) files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  for (const fs::path& file : files) hash = hashOfFile(file, hash);
  return hash;
}

std::uint64_t hashOfNode(const Node& node, const fs::path& folder, std::uint64_t hash) {
  if (node.kind == Node::Kind::kScalar) {
    // File names contain a dot, a separator or quotes; for numbers and plain words the disk need
    // not be accessed.
    const bool may_be = node.quoted || node.text.find_first_of("./") != std::string::npos;
    if (may_be && !node.text.empty()) hash = hashOfPath(folder / node.text, hash);
  }
  for (const Node& item : node.items) hash = hashOfNode(item, folder, hash);
  for (const Node::Entry& entry : node.entries) hash = hashOfNode(entry.value, folder, hash);
  return hash;
}

}  // namespace

std::string sceneHash(const std::string& file, const std::string& text) {
  const auto document = text.empty() ? readDocument(file) : parseDocument(text, file);
  std::uint64_t hash = devices::checksum({});
  for (const std::string& line : document->lines) {
    hash = devices::checksum("\n", devices::checksum(line, hash));
  }
  hash = hashOfNode(document->root, fs::path(file).parent_path(), hash);
  constexpr std::array kDigits = {'0', '1', '2', '3', '4', '5', '6', '7',
                                  '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string digits(16, '0');
  for (std::size_t i = digits.size(); i-- > 0; hash >>= 4U) digits[i] = kDigits[hash & 15U];
  return "fnv1a64:" + digits;
}

}  // namespace palpate::tools
