#pragma once
/// Formats numbers, places and lists for messages, and takes words of files and paths apart for
/// readers.

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

/// `text` without the blanks at its ends.
[[nodiscard]] std::string_view trimmed(std::string_view text) noexcept;
/// `text` with A to Z turned to lower case.
[[nodiscard]] std::string lowerCase(std::string_view text);

/// Whether `path` ends with `extension`, in upper or lower case.
[[nodiscard]] bool hasExtension(std::string_view path, std::string_view extension);
/// ".stl", in lower case; nothing if it has none.
[[nodiscard]] std::string extensionOf(const std::string& path);
/// The file's name without its folders.
[[nodiscard]] std::string fileName(const std::string& path);

}  // namespace palpate::vdb
