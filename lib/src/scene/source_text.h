#pragma once
/// The text of a document before it is parsed.

#include <string>
#include <string_view>

#include "palpate/scene/scene_file.h"

namespace palpate {

inline constexpr std::size_t kLargestDocument = std::size_t{16} << 20U;  ///< [bytes]
/// Values, lists and maps: a byte of a file may become a hundred bytes in the tree.
inline constexpr std::size_t kMostNodes = 250'000;
inline constexpr int kDeepestNesting = 64;  ///< of lists and maps; more is a mistake or an attack

/// `text` without byte order mark and with "\n" line ends; fills document.lines.
/// @throws Error at the first byte that is not UTF-8 text, or a tab where YAML could take it for
/// layout.
[[nodiscard]] std::string acceptText(std::string_view text, Document& document);

/// Reads `text` (from acceptText) into document.root. The only user of yaml-cpp.
void readYaml(const std::string& text, Document& document);

}  // namespace palpate
