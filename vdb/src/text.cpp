#include "palpate/vdb/text.h"

#include <algorithm>
#include <array>
#include <cstdio>
#include <filesystem>

#include "palpate/core/text.h"

namespace palpate::vdb {

std::string inGigabytes(double bytes) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.3f GB", bytes * 1e-9);
  return text.data();
}

std::string inMillimeters(double meters, int digits) {
  return shortNumber(meters * 1e3, digits) + " mm";
}

std::string inMillimeters(const Vec3& meters, int digits) {
  const Vec3 p = meters * 1e3;
  return "(" + shortNumber(p.x, digits) + ", " + shortNumber(p.y, digits) + ", " +
         shortNumber(p.z, digits) + ") mm";
}

std::string eachInMillimeters(const Vec3& meters, int digits) {
  return "(" + inMillimeters(meters.x, digits) + ", " + inMillimeters(meters.y, digits) + ", " +
         inMillimeters(meters.z, digits) + ")";
}

std::string listOf(const std::vector<int>& labels) {
  std::string list;
  for (const int label : labels) list += (list.empty() ? "" : ", ") + std::to_string(label);
  return list;
}

std::string_view trimmed(std::string_view text) noexcept {
  constexpr std::string_view kBlanks = " \t\r\n\v\f";
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

std::string lowerCase(std::string_view text) {
  std::string out(text);
  std::transform(out.begin(), out.end(), out.begin(), [](char c) {
    return c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
  });
  return out;
}

bool hasExtension(std::string_view path, std::string_view extension) {
  return lowerCase(path).ends_with(lowerCase(extension));
}

std::string extensionOf(const std::string& path) {
  return lowerCase(std::filesystem::path(path).extension().string());
}

std::string fileName(const std::string& path) {
  return std::filesystem::path(path).filename().string();
}

}  // namespace palpate::vdb
