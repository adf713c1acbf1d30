#include <algorithm>
#include <filesystem>
#include <fstream>
#include <system_error>

#include "palpate/scene/scene_file.h"
#include "scene/source_text.h"

namespace palpate {

const Node* Node::find(std::string_view key) const noexcept {
  for (const Entry& entry : entries) {
    if (entry.key == key) return &entry.value;
  }
  return nullptr;
}

SourcePlace Document::place(Mark mark) const {
  constexpr std::size_t kLongestExcerpt = 200;  // [characters] a longer line helps nobody
  SourcePlace place{file, mark.line, mark.column};
  if (mark.line < 1 || static_cast<std::size_t>(mark.line) > lines.size()) return place;
  const std::string& line = lines[static_cast<std::size_t>(mark.line) - 1];
  // Marks count bytes; people, editors and the caret below the excerpt count characters.
  const std::size_t bytes = std::min(line.size(), static_cast<std::size_t>(mark.column) - 1);
  const auto continues = [](char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; };
  const auto end = line.begin() + static_cast<std::ptrdiff_t>(bytes);
  place.column = mark.column - static_cast<int>(std::count_if(line.begin(), end, continues));
  if (static_cast<std::size_t>(place.column) > kLongestExcerpt) return place;
  if (line.size() <= kLongestExcerpt) {
    place.excerpt = line;
  } else {
    std::size_t cut = std::max(kLongestExcerpt, bytes);
    while (cut < line.size() && continues(line[cut])) ++cut;
    place.excerpt = line.substr(0, cut) + " ...";
  }
  return place;
}

Error Document::error(Mark mark, std::string code, std::string message, std::string hint) const {
  return errorAt(place(mark), std::move(code), std::move(message), std::move(hint));
}

std::shared_ptr<const Document> parseDocument(std::string_view text, std::string file) {
  auto document = std::make_shared<Document>();
  document->file = std::move(file);
  readYaml(acceptText(text, *document), *document);
  return document;
}

std::shared_ptr<const Document> readDocument(const std::string& path) {
  const auto fail = [&](std::string message, std::string hint = {}) {
    return inputError("document.open", std::move(message), std::move(hint), path);
  };
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (status.type() == std::filesystem::file_type::not_found) throw fail("there is no such file");
  if (status.type() == std::filesystem::file_type::directory) {
    throw fail("this is a folder", "name the scene file in it");
  }
  std::ifstream stream(path, std::ios::binary);
  if (!stream) throw fail("cannot be opened", "check its permissions");
  // Read one byte more than is allowed: that detects a longer text even if its size is not known (a
  // pipe).
  std::string text(kLargestDocument + 1, '\0');
  stream.read(text.data(), static_cast<std::streamsize>(text.size()));
  if (stream.bad()) throw fail("cannot be read");
  text.resize(static_cast<std::size_t>(stream.gcount()));
  return parseDocument(text, path);
}

}  // namespace palpate
