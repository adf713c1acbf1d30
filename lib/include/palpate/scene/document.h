#pragma once
/// A strict YAML subset as an immutable tree with places. No yaml-cpp type is visible here.
/// Refused with file:line:column: duplicate keys, aliases and anchors, tags, more than one document,
/// keys that are not plain text, nesting deeper than 64. JSON is a subset and is read too.

#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/scene/description.h"

namespace palpate {

struct Mark {
  int line = 0;    ///< from 1
  int column = 0;  ///< from 1
};

struct Node {
  enum class Kind { kNull, kScalar, kSequence, kMap };
  struct Entry;

  Kind kind = Kind::kNull;
  Mark mark = {};
  std::string text = {};  ///< scalar: as written
  bool quoted = false;    ///< scalar: "..." or '...': text, never a number
  std::vector<Node> items = {};
  std::vector<Entry> entries;  ///< map: in the order of the file (no "= {}": Entry is incomplete)

  [[nodiscard]] const Node* find(std::string_view key) const noexcept;
};

struct Node::Entry {
  std::string key;
  Mark key_mark;
  Node value;
};

struct Document {
  std::string file;                ///< as the user named it, for messages
  std::vector<std::string> lines;  ///< of the source, for excerpts
  Node root;

  [[nodiscard]] SourcePlace place(Mark mark) const;
  [[nodiscard]] Error error(Mark mark, std::string code, std::string message,
                            std::string hint = {}) const;
};

/// @throws Error (kInput).
[[nodiscard]] std::shared_ptr<const Document> parseDocument(std::string_view text,
                                                            std::string file);
[[nodiscard]] std::shared_ptr<const Document> readDocument(const std::string& path);

}  // namespace palpate
