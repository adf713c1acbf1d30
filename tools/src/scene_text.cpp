#include "scene_text.h"

#include <algorithm>
#include <filesystem>
#include <string_view>

#include "palpate/core/error.h"
#include "report.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;

/// Whether YAML reads the text as itself, without quotes, at any place.
bool isPlain(std::string_view text) {
  const auto is_safe = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
           std::string_view(" ._/+-^").find(c) != std::string_view::npos;
  };
  return !text.empty() && std::all_of(text.begin(), text.end(), is_safe) && text.front() != ' ' &&
         text.back() != ' ' && (text.front() != '-' || text.size() > 1);
}

std::string wordText(const std::string& word) { return isPlain(word) ? word : sceneWord(word); }

std::string flowText(const Node& node) {
  std::string out;
  switch (node.kind) {
    case Node::Kind::kNull:
      return "null";
    case Node::Kind::kScalar:
      return node.quoted ? sceneWord(node.text) : wordText(node.text);
    case Node::Kind::kSequence:
      for (const Node& item : node.items) out += (out.empty() ? "" : ", ") + flowText(item);
      return "[" + out + "]";
    case Node::Kind::kMap:
      break;
  }
  for (const Node::Entry& entry : node.entries) {
    out += (out.empty() ? "" : ", ") + wordText(entry.key) + ": " + flowText(entry.value);
  }
  return "{" + out + "}";
}

/// Whether the keys of a section are names that the author gave.
bool namesThings(std::string_view section) {
  return section == "fields" || section == "images" || section == "materials";
}

class PathMover {
 public:
  PathMover(const std::string& from, const std::string& to)
      : from_(fs::absolute(from).parent_path()), to_(fs::absolute(to).parent_path()) {}

  void move(Node& node, bool keys_are_names) const {
    for (Node& item : node.items) move(item, false);
    for (Node::Entry& entry : node.entries) {
      const bool is_path = !keys_are_names && (entry.key == "file" || entry.key == "names") &&
                           entry.value.kind == Node::Kind::kScalar;
      if (is_path && fs::path(entry.value.text).is_relative()) {
        entry.value.text = (from_ / entry.value.text).lexically_normal().lexically_proximate(to_);
        entry.value.quoted = true;
      }
      move(entry.value, false);
    }
  }

 private:
  fs::path from_, to_;
};

}  // namespace

std::string sceneWord(const std::string& text) {
  try {
    return Json(text).dump();
  } catch (const Json::exception&) {
    const std::string shown = Json(text).dump(-1, ' ', false, Json::error_handler_t::replace);
    throw Error(ErrorKind::kUsage,
                {"scene.not_utf8", shown + " is not UTF-8, as a scene file must be",
                 "rename the file or folder"});
  }
}

std::string sceneText(const Node& root) {
  std::string out;
  for (const Node::Entry& section : root.entries) {
    const Node& value = section.value;
    out += wordText(section.key) + ":";
    if (value.kind == Node::Kind::kMap && namesThings(section.key)) {
      out += "\n";
      for (const Node::Entry& entry : value.entries) {
        out += "  " + wordText(entry.key) + ": " + flowText(entry.value) + "\n";
      }
    } else if (value.kind == Node::Kind::kSequence) {
      out += "\n";
      for (const Node& item : value.items) out += "  - " + flowText(item) + "\n";
    } else {
      out += " " + flowText(value) + "\n";
    }
  }
  return out;
}

Node withPathsSeenFrom(Node root, const std::string& from, const std::string& to) {
  const PathMover mover(from, to);
  for (Node::Entry& section : root.entries) mover.move(section.value, namesThings(section.key));
  return root;
}

}  // namespace palpate::tools
