#include "keep/seal.h"

#include <fstream>

#include "keep/content_key.h"

namespace palpate::vdb {
namespace {

constexpr const char* kBegin = "\npalpate kept 1 ";
constexpr std::size_t kHashDigits = 32;

std::string lineOf(const std::string& key, const std::string& hash) {
  return kBegin + key + " " + hash + "\n";
}

}  // namespace

std::size_t sealBytes(const std::string& key) {
  return lineOf(key, std::string(kHashDigits, '0')).size();
}

bool seal(const std::string& path, const std::string& key) {
  ContentKey hash;
  if (!hash.addFile(path)) return false;
  std::ofstream out(path, std::ios::binary | std::ios::app);
  out << lineOf(key, hash.text());
  out.close();
  return out.good();
}

bool isSealed(const std::string& path, const std::string& key) {
  const std::size_t bytes = sealBytes(key);
  ContentKey hash;
  if (!hash.addFile(path, bytes)) return false;
  std::ifstream in(path, std::ios::binary);
  std::string end(bytes, '\0');
  in.seekg(-static_cast<std::streamoff>(bytes), std::ios::end);
  in.read(end.data(), static_cast<std::streamsize>(bytes));
  return in.good() && end == lineOf(key, hash.text());
}

}  // namespace palpate::vdb
