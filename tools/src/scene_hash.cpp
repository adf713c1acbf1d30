#include "scene_hash.h"

#include <array>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <vector>

#include "console.h"
#include "named_files.h"
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

}  // namespace

std::string sceneHash(const std::string& file, const std::string& text) {
  const auto document = text.empty() ? readDocument(file) : parseDocument(text, file);
  std::uint64_t hash = devices::checksum({});
  for (const std::string& line : document->lines) {
    hash = devices::checksum("\n", devices::checksum(line, hash));
  }
  for (const fs::path& path : namedPaths(document->root, fs::path(file).parent_path())) {
    for (const fs::path& named : filesAt(path)) hash = hashOfFile(named, hash);
  }
  constexpr std::array kDigits = {'0', '1', '2', '3', '4', '5', '6', '7',
                                  '8', '9', 'a', 'b', 'c', 'd', 'e', 'f'};
  std::string digits(16, '0');
  for (std::size_t i = digits.size(); i-- > 0; hash >>= 4U) digits[i] = kDigits[hash & 15U];
  return "fnv1a64:" + digits;
}

}  // namespace palpate::tools
