#pragma once
/// Numbers, places and lists as messages show them, and words of files and paths as readers take
/// them.

#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::vdb {

/// "1.234 GB"
[[nodiscard]] std::string inGigabytes(double bytes);
/// "1.5 mm"
[[nodiscard]] std::string inMillimeters(double meters, int digits = 6);
/// "(1.5, 2, 0) mm"
[[nodiscard]] std::string inMillimeters(const Vec3& meters, int digits = 6);
/// "(1.5 mm, 2 mm, 0 mm)"
[[nodiscard]] std::string eachInMillimeters(const Vec3& meters, int digits = 6);
/// "1, 5, 7"
[[nodiscard]] std::string listOf(const std::vector<int>& labels);

/// Without the blanks around it.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;
/// With small letters for A to Z.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// Whether `path` ends so, in whatever case.
[[nodiscard]] bool hasExtension(std::string_view path, std::string_view extension);
/// ".stl", in small letters; nothing if it has none.
[[nodiscard]] std::string extensionOf(const std::string& path);
/// Without its folders.
[[nodiscard]] std::string fileName(const std::string& path);

}  // namespace palpate::vdb
