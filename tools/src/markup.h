#pragma once
/// Any text as text of an SVG or HTML file.

#include <string>
#include <string_view>

namespace palpate::tools {

/// `text` with <, >, &, " and ' written as references, safe between tags and between quotes. Bytes
/// that are not UTF-8, and control characters that XML forbids, become U+FFFD.
[[nodiscard]] std::string markupText(std::string_view text);

/// `bytes` in base 64.
[[nodiscard]] std::string base64(std::string_view bytes);

}  // namespace palpate::tools
