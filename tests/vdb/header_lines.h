#pragma once
/// Image files made by hand: a header of lines, and voxels with the values 0, 1, 2, ...

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "palpate/vdb/image.h"

namespace palpate::vdb::test {

/// Keys and values of a header; "-" means that the line is left out.
using Lines = std::vector<std::pair<std::string, std::string>>;

inline void set(Lines& lines, const std::string& key, const std::string& value) {
  for (auto& line : lines) {
    if (line.first == key) {
      line.second = value;
      return;
    }
  }
  lines.emplace_back(key, value);
}

/// 0, 1, 2, ... as shorts, low byte first or, if `big`, high byte first.
inline std::string counting(int count, bool big = false) {
  std::string bytes;
  for (int i = 0; i < count; ++i) {
    const char low = static_cast<char>(i & 0xFF);
    const char high = static_cast<char>(i >> 8);
    bytes += big ? high : low;
    bytes += big ? low : high;
  }
  return bytes;
}

inline void expectCounting(const Image& image) {
  for (std::size_t i = 0; i < image.values.size(); ++i) {
    ASSERT_EQ(image.values[i], static_cast<float>(i));
  }
}

inline double apartMm(const Vec3& a, const Vec3& b) { return glm::length(a - b) * 1e3; }

}  // namespace palpate::vdb::test
