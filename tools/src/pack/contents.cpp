#include "pack/contents.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <fstream>
#include <set>
#include <vector>

#include "console.h"
#include "pack/bundle.h"
#include "palpate/core/error.h"
#include "palpate/devices/record.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

constexpr const char* kContents = "contents";

Error damaged(const std::string& message, const fs::path& file) {
  return inputError("pack.damaged", message, "copy the bundle again, or pack the scene anew",
                    file.string());
}

/// Reads the list of a bundle, and checks its form.
Json listOf(const fs::path& bundle) {
  const fs::path about = bundle / kBundleAbout;
  std::ifstream in(about, std::ios::binary);
  const Json all = Json::parse(in, nullptr, false);
  if (!all.is_object() || !all.contains(kContents) || !all[kContents].is_array()) {
    throw damaged("it has no list of the bundle's files", about);
  }
  for (const Json& file : all[kContents]) {
    if (!file.is_object() || !file.contains("name") || !file["name"].is_string() ||
        !file.contains("hash") || !file["hash"].is_string()) {
      throw damaged("its list of the bundle's files is damaged", about);
    }
  }
  return all[kContents];
}

std::string nameIn(const fs::path& bundle, const fs::path& file) {
  return file.lexically_relative(bundle).generic_string();
}

}  // namespace

std::string hashOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::vector<char> buffer(std::size_t{1} << 20U);
  std::uint64_t hash = devices::checksum({});
  while (in) {
    checkStop();
    in.read(buffer.data(), static_cast<std::streamsize>(buffer.size()));
    hash = devices::checksum({buffer.data(), static_cast<std::size_t>(in.gcount())}, hash);
  }
  std::array<char, 32> text{};
  std::snprintf(text.data(), text.size(), "fnv1a64:%016llx", static_cast<unsigned long long>(hash));
  return text.data();
}

Json contentsOf(const fs::path& bundle) {
  std::set<std::string> names;
  for (const auto& entry : fs::recursive_directory_iterator(bundle)) {
    if (entry.is_regular_file()) names.insert(nameIn(bundle, entry.path()));
  }
  names.erase(kBundleAbout);
  Json list = Json::array();
  for (const std::string& name : names) {
    list.push_back(
        {{"name", name}, {"bytes", fs::file_size(bundle / name)}, {"hash", hashOf(bundle / name)}});
  }
  return list;
}

void checkContents(const fs::path& bundle) {
  for (const Json& file : listOf(bundle)) {
    const auto name = file["name"].get<std::string>();
    if (name == kBundleScene) continue;
    const fs::path path = bundle / name;
    std::error_code failed;
    if (!fs::is_regular_file(path, failed)) throw damaged("this file of the bundle is gone", path);
    if (hashOf(path) != file["hash"].get<std::string>()) {
      throw damaged("this file of the bundle has changed since it was packed", path);
    }
  }
}

std::optional<std::string> foreignIn(const fs::path& bundle) {
  std::set<std::string> own = {kBundleAbout, kBundleGrids, kBundleFiles};
  for (const Json& file : listOf(bundle)) {
    for (fs::path name = file["name"].get<std::string>(); !name.empty();
         name = name.parent_path()) {
      if (!own.insert(name.generic_string()).second || !name.has_relative_path()) break;
    }
  }
  for (const auto& entry : fs::recursive_directory_iterator(bundle)) {
    const std::string name = nameIn(bundle, entry.path());
    if (!own.contains(name)) return name;
  }
  return {};
}

}  // namespace palpate::tools
