#include "pack/packed_scene.h"

#include <algorithm>
#include <map>
#include <vector>

#include "scene_text.h"

namespace palpate::tools {
namespace {

/// A value in the text, and its replacement.
struct Change {
  Mark mark;
  std::string old;
  bool quoted = false;
  std::string now;
};

class Changes {
 public:
  explicit Changes(const NameInBundle& name) : name_(name) {}

  void find(const Node& root) {
    for (const Node::Entry& section : root.entries) {
      if (section.key == "images") {
        for (const Node::Entry& image : section.value.entries) findInImage(image);
      } else if (section.key == "fields" || section.key == "materials") {
        // Keys here are names that the author gave.
        for (const Node::Entry& entry : section.value.entries) findIn(entry.value);
      } else {
        findIn(section.value);
      }
    }
  }

  [[nodiscard]] std::vector<Change>& list() noexcept { return list_; }

 private:
  void add(Named what, const Node& value, const std::string& image) {
    if (value.kind != Node::Kind::kScalar) return;
    list_.push_back({value.mark, value.text, value.quoted, name_(what, value.text, image)});
  }

  void findInImage(const Node::Entry& image) {
    for (const Node::Entry& entry : image.value.entries) {
      if (entry.key == "file") add(Named::kScan, entry.value, image.key);
      if (entry.key == "names") add(Named::kFile, entry.value, image.key);
      if (entry.key != "with") continue;
      for (const Node& more : entry.value.items) add(Named::kMore, more, image.key);
    }
  }

  void findIn(const Node& node) {
    for (const Node& item : node.items) findIn(item);
    for (const Node::Entry& entry : node.entries) {
      if (entry.key == "file") add(Named::kFile, entry.value, {});
      findIn(entry.value);
    }
  }

  const NameInBundle& name_;
  std::vector<Change> list_;
};

/// Length of the value in `line` from `at` on; 0 if the value does not end on this line.
std::size_t lengthOf(const std::string& line, std::size_t at, const Change& change) {
  if (at >= line.size()) return 0;
  if (!change.quoted)
    return line.compare(at, change.old.size(), change.old) == 0 ? change.old.size() : 0;
  const char quote = line[at];
  if (quote != '"' && quote != '\'') return 0;
  for (std::size_t end = at + 1; end < line.size(); ++end) {
    if (quote == '"' && line[end] == '\\') {
      ++end;
    } else if (line[end] == quote) {
      if (quote == '"' || end + 1 >= line.size() || line[end + 1] != quote) return end + 1 - at;
      ++end;  // '' stands for a single '
    }
  }
  return 0;
}

void replaceAll(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
  }
}

bool findsImage(const Node& node, const std::string& image) {
  const Node* named = node.find("image");
  if (named != nullptr && named->text == image) return true;
  return std::any_of(node.items.begin(), node.items.end(),
                     [&](const Node& item) { return findsImage(item, image); }) ||
         std::any_of(node.entries.begin(), node.entries.end(),
                     [&](const Node::Entry& entry) { return findsImage(entry.value, image); });
}

}  // namespace

std::string packedText(const Document& document, const NameInBundle& name) {
  Changes changes(name);
  changes.find(document.root);
  std::vector<Change>& list = changes.list();
  // From the end on, so that positions before a change stay valid.
  std::sort(list.begin(), list.end(), [](const Change& a, const Change& b) {
    return a.mark.line != b.mark.line ? a.mark.line > b.mark.line : a.mark.column > b.mark.column;
  });
  std::vector<std::string> lines = document.lines;
  std::map<std::string, std::string, std::greater<>> absolute;  // longer names come first
  for (const Change& change : list) {
    std::string& line = lines.at(static_cast<std::size_t>(change.mark.line - 1));
    const auto at = static_cast<std::size_t>(change.mark.column - 1);
    const std::size_t length = lengthOf(line, at, change);
    if (length == 0) {
      throw document.error(change.mark, "pack.name", "this file name spans several lines",
                           "write it in one line, in quotes");
    }
    line.replace(at, length, sceneWord(change.now));
    if (change.old.starts_with('/')) absolute[change.old] = change.now;
  }
  std::string text;
  for (std::string& line : lines) {
    for (const auto& [old, now] : absolute) replaceAll(line, old, now);
    text += line + "\n";
  }
  return text;
}

bool isReadByMaterials(const Node& root, const std::string& image) {
  return std::any_of(root.entries.begin(), root.entries.end(), [&](const Node::Entry& section) {
    if (section.key == "images") return false;
    if (section.key != "layers") return findsImage(section.value, image);
    // Layers also name images for their surfaces; other keys of a layer may hold materials.
    return std::any_of(
        section.value.items.begin(), section.value.items.end(), [&](const Node& layer) {
          return std::any_of(layer.entries.begin(), layer.entries.end(),
                             [&](const Node::Entry& entry) {
                               return entry.key != "labels" && entry.key != "threshold" &&
                                      findsImage(entry.value, image);
                             });
        });
  });
}

}  // namespace palpate::tools
