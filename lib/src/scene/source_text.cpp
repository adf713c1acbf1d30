#include "scene/source_text.h"

#include <array>
#include <cstdint>
#include <cstdio>

namespace palpate {
namespace {

constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";

// Length in bytes of the UTF-8 character at `at`, 0 if there is none: no overlong forms, surrogates
// or code points beyond U+10FFFF (Unicode 15.0, table 3-7).
std::size_t utf8Length(std::string_view text, std::size_t at) noexcept {
  const auto byte = [&](std::size_t i) -> unsigned {
    return at + i < text.size() ? static_cast<unsigned char>(text[at + i]) : 0U;
  };
  const unsigned first = byte(0);
  if (first < 0x80) return 1;
  if (first < 0xC2 || first > 0xF4) return 0;
  const std::size_t length = first < 0xE0 ? 2 : first < 0xF0 ? 3 : 4;
  unsigned lowest = 0x80;
  unsigned highest = 0xBF;
  if (first == 0xE0) lowest = 0xA0;
  if (first == 0xED) highest = 0x9F;
  if (first == 0xF0) lowest = 0x90;
  if (first == 0xF4) highest = 0x8F;
  if (byte(1) < lowest || byte(1) > highest) return 0;
  for (std::size_t i = 2; i < length; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  }
  return length;
}

std::string hexadecimal(char c) {
  std::array<char, 8> text{};
  std::snprintf(text.data(), text.size(), "0x%02X", static_cast<unsigned>(static_cast<uint8_t>(c)));
  return text.data();
}

void splitLines(const std::string& text, std::vector<std::string>& lines) {
  std::size_t start = 0;
  for (std::size_t end = text.find('\n'); end != std::string::npos; end = text.find('\n', start)) {
    lines.push_back(text.substr(start, end - start));
    start = end + 1;
  }
  lines.push_back(text.substr(start));
}

// An error without the excerpt, since the line cannot be printed.
Error unprintable(const Document& document, Mark mark, std::string code, std::string message) {
  return errorAt(
      {document.file, mark.line, mark.column}, std::move(code), std::move(message),
      "a scene is YAML in UTF-8; a mesh, grid or scan is named in a scene, not given as one");
}

}  // namespace

std::string acceptText(std::string_view text, Document& document) {
  if (text.size() > kLargestDocument) {
    throw errorAt({document.file}, "document.too_big", "more than 16 MB of text",
                  "a scene names its meshes, grids and scans; it does not hold them");
  }
  if (text.substr(0, kByteOrderMark.size()) == kByteOrderMark) {
    text.remove_prefix(kByteOrderMark.size());
  }
  std::string accepted;
  accepted.reserve(text.size());
  Mark mark{1, 1};
  for (std::size_t at = 0; at < text.size();) {
    const char c = text[at];
    if (c == '\n' || (c == '\r' && at + 1 < text.size() && text[at + 1] == '\n')) {
      accepted += '\n';
      at += c == '\n' ? 1 : 2;
      mark = {mark.line + 1, 1};
      continue;
    }
    const std::size_t length = utf8Length(text, at);
    if (length == 0) {
      throw unprintable(document, mark, "document.encoding",
                        "not UTF-8: byte " + hexadecimal(c) + " cannot begin a character");
    }
    if ((static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7F) {
      throw unprintable(document, mark, "document.binary",
                        "not text: the control character " + hexadecimal(c));
    }
    accepted.append(text.substr(at, length));
    at += length;
    ++mark.column;
  }
  splitLines(accepted, document.lines);

  // JSON may be laid out with tabs, which mean nothing there.
  const std::size_t first = accepted.find_first_not_of(" \t\n");
  if (first != std::string::npos && accepted[first] == '{') return accepted;
  for (std::size_t i = 0; i < document.lines.size(); ++i) {
    const std::string& line = document.lines[i];
    const std::size_t tab = line.find('\t');
    if (tab == std::string::npos) continue;
    const std::size_t comment = line[0] == '#' ? 0 : line.find(" #");
    if (comment < tab) continue;
    throw document.error({static_cast<int>(i) + 1, static_cast<int>(tab) + 1}, "document.tab",
                         "a tab", "lay out with spaces; editors can replace tabs");
  }
  return accepted;
}

}  // namespace palpate
