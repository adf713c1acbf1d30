// The one file that uses yaml-cpp directly. It reads events because yaml-cpp's tree hides anchors,
// tags, marks of keys, and duplicate keys.

#include <yaml-cpp/eventhandler.h>
#include <yaml-cpp/exceptions.h>
#include <yaml-cpp/parser.h>

#include <algorithm>
#include <limits>
#include <sstream>
#include <unordered_set>

#include "palpate/core/stop.h"
#include "scene/messages.h"
#include "scene/source_text.h"

namespace palpate {
namespace {

class TreeBuilder final : public YAML::EventHandler {
 public:
  TreeBuilder(const std::string& text, Document& document) : text_(text), document_(document) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (has_document_) {
      const bool marker =
          mark.pos >= 0 && text_.compare(static_cast<std::size_t>(mark.pos), 3, "---") == 0;
      throw document_.error(
          markOf(mark), "document.several",
          marker ? "a second YAML document" : "this line does not continue anything before it",
          marker ? "one file is one document; remove the '---'"
                 : "indent it like the lines before it, and keep it inside their brackets");
    }
    has_document_ = true;
  }
  void OnDocumentEnd() override {}

  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override {
    refuseAnchor(mark, anchor);
    Node node;
    node.mark = markOfNull(mark);
    add(std::move(node));
  }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t /*anchor*/) override { throw alias(mark); }
  void OnScalar(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                const std::string& value) override {
    refuseTag(mark, tag);
    refuseAnchor(mark, anchor);
    Node node;
    node.kind = Node::Kind::kScalar;
    node.mark = markOf(mark);
    node.text = value;
    node.quoted = tag == "!";  // yaml-cpp's tag for every scalar that is not plain
    refuseOpenQuote(mark);
    add(std::move(node));
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value /*style*/) override {
    open(mark, tag, anchor, Node::Kind::kSequence);
  }
  void OnSequenceEnd() override { close(); }
  void OnMapStart(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value /*style*/) override {
    open(mark, tag, anchor, Node::Kind::kMap);
  }
  void OnMapEnd() override { close(); }

  [[nodiscard]] bool hasDocument() const noexcept { return has_document_; }

  // An error for text that yaml-cpp could not read; it names the likely cause where one is known.
  [[nodiscard]] Error syntax(const YAML::Exception& exception) const {
    const char at = characterAt(exception.mark);
    const char before =
        exception.mark.pos > 0
            ? text_[std::min(text_.size(), static_cast<std::size_t>(exception.mark.pos)) - 1]
            : '\0';
    if (at == '*') return alias(exception.mark);
    if (at == '&' || before == '&') return anchorError(exception.mark);
    if (before == '*') {
      YAML::Mark star = exception.mark;
      --star.pos;
      --star.column;
      return alias(star);
    }
    std::string hint = "a text with : # [ ] { } , in it needs quotes";
    if (at == '?') {
      hint = "quote globs: \"name?\"";
    } else if (exception.msg == YAML::ErrorMsg::MAP_VALUE) {
      hint =
          "a bracket or quote before this line may be open, or the line indented otherwise; a text "
          "with ': ' needs quotes";
    } else if (exception.msg == YAML::ErrorMsg::END_OF_MAP_FLOW) {
      hint = "a '{' is not closed, or a ',' is missing";
    } else if (exception.msg == YAML::ErrorMsg::END_OF_SEQ_FLOW) {
      hint = "a '[' is not closed, or a ',' is missing";
    } else if (exception.msg == YAML::ErrorMsg::END_OF_MAP) {
      hint = "is this line indented like the lines before it, with a ':' after the key?";
    } else if (exception.msg == YAML::ErrorMsg::END_OF_SEQ) {
      hint = "is this line indented like the '-' lines before it?";
    } else if (exception.msg == YAML::ErrorMsg::EOF_IN_SCALAR) {
      hint = "a quotation mark is not closed";
    }
    return document_.error(markOf(exception.mark), "document.syntax", "not YAML: " + exception.msg,
                           std::move(hint));
  }

 private:
  struct Frame {
    Node node;
    bool has_key = false;  // for maps: a key has been read and its value not yet
    std::string key = {};
    Mark key_mark = {};
    std::unordered_set<std::string> keys = {};
  };

  // yaml-cpp counts from 0, and has no mark at all for a value that is missing at the end of the
  // file.
  [[nodiscard]] Mark markOf(const YAML::Mark& mark) const {
    if (mark.is_null() || mark.line < 0 ||
        static_cast<std::size_t>(mark.line) >= document_.lines.size()) {
      return {static_cast<int>(document_.lines.size()),
              static_cast<int>(document_.lines.back().size()) + 1};
    }
    return {mark.line + 1, mark.column + 1};
  }
  [[nodiscard]] char characterAt(const YAML::Mark& mark) const {
    const bool inside =
        !mark.is_null() && mark.pos >= 0 && static_cast<std::size_t>(mark.pos) < text_.size();
    return inside ? text_[static_cast<std::size_t>(mark.pos)] : '\0';
  }
  // Where a value is missing, yaml-cpp marks what comes next, perhaps lines below: go back to the
  // last thing before it, the '-' or ',' or '[' that needs a value.
  [[nodiscard]] Mark markOfNull(const YAML::Mark& mark) const {
    const char c = characterAt(mark);
    if (c == '~' || c == 'n' || c == 'N') return markOf(mark);
    Mark found = markOf(mark);
    while (found.line > 0) {
      const std::string& line = document_.lines[static_cast<std::size_t>(found.line) - 1];
      const std::size_t end = std::min(line.size(), static_cast<std::size_t>(found.column) - 1);
      const std::string_view before = std::string_view(line).substr(0, end);
      const std::size_t last = before.find_last_not_of(' ');
      const bool comment = before.find_first_not_of(' ') == before.find('#');
      if (last != std::string_view::npos && !comment) {
        return {found.line, static_cast<int>(last) + 1};
      }
      found = {found.line - 1, std::numeric_limits<int>::max()};
    }
    return markOf(mark);
  }

  [[nodiscard]] Error alias(const YAML::Mark& mark) const {
    return document_.error(markOf(mark), "document.alias",
                           "an unquoted '*' makes a YAML alias, which scenes do not use",
                           "quote globs: \"*name\"");
  }
  [[nodiscard]] Error anchorError(const YAML::Mark& mark) const {
    return document_.error(markOf(mark), "document.anchor",
                           "an unquoted '&' makes a YAML anchor, which scenes do not use",
                           "quote the text, or write the value out; a field is reused by its name");
  }
  void OnAnchor(const YAML::Mark& mark, const std::string& /*name*/) override {
    throw anchorError(mark);
  }
  void refuseAnchor(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != 0) throw anchorError(mark);
  }
  void refuseTag(const YAML::Mark& mark, const std::string& tag) const {
    // "?" and "!" mean "no tag" on plain and quoted scalars; a written tag has the node's mark.
    if ((tag == "?" || tag == "!" || tag.empty()) && characterAt(mark) != '!') return;
    throw document_.error(markOf(mark), "document.tag",
                          "an unquoted '!' makes a YAML tag, which scenes do not use",
                          "quote the text, or leave the tag out");
  }

  // yaml-cpp accepts a quotation that is never closed. One that runs on swallows the following
  // lines, so it must end on its line, as in JSON.
  void refuseOpenQuote(const YAML::Mark& mark) const {
    const char quote = characterAt(mark);
    if (quote != '"' && quote != '\'') return;
    for (auto i = static_cast<std::size_t>(mark.pos) + 1; i < text_.size() && text_[i] != '\n';
         ++i) {
      if (quote == '"' && text_[i] == '\\') {
        ++i;
      } else if (text_[i] == quote) {
        // A doubled quotation mark is one that belongs to the text.
        const bool doubled = quote == '\'' && i + 1 < text_.size() && text_[i + 1] == quote;
        if (!doubled) return;
        ++i;
      }
    }
    throw document_.error(markOf(mark), "document.quote",
                          "the quotation mark is not closed on its line",
                          "close it; a text of several lines is written below a '|'");
  }

  void open(const YAML::Mark& mark, const std::string& tag, YAML::anchor_t anchor,
            Node::Kind kind) {
    refuseTag(mark, tag);
    refuseAnchor(mark, anchor);
    // Checked before yaml-cpp recurses: every level of its recursion below here comes through this
    // line.
    if (frames_.size() >= static_cast<std::size_t>(kDeepestNesting)) {
      throw document_.error(markOf(mark), "document.depth",
                            "nested deeper than " + std::to_string(kDeepestNesting) + " levels",
                            "give inner fields names of their own in `fields`");
    }
    Frame frame;
    frame.node.kind = kind;
    frame.node.mark = markOf(mark);
    frames_.push_back(std::move(frame));
  }
  void close() {
    Node node = std::move(frames_.back().node);
    frames_.pop_back();
    add(std::move(node));
  }

  void add(Node node) {
    if (++nodes_ % 1024 == 0) pollStop();
    if (nodes_ > kMostNodes) {
      throw document_.error(node.mark, "document.size",
                            "more than " + std::to_string(kMostNodes) + " values, lists and maps",
                            "a scene names its meshes, grids and scans; it does not hold them");
    }
    if (frames_.empty()) {
      document_.root = std::move(node);
      return;
    }
    Frame& top = frames_.back();
    if (top.node.kind == Node::Kind::kSequence) {
      top.node.items.push_back(std::move(node));
      return;
    }
    if (top.has_key) {
      top.node.entries.push_back({std::move(top.key), top.key_mark, std::move(node)});
      top.has_key = false;
      return;
    }
    if (node.kind != Node::Kind::kScalar) {
      throw document_.error(node.mark, "document.key", "a key that is not plain text",
                            "a key is one word, with ': ' behind it");
    }
    if (!top.keys.insert(node.text).second) {
      const auto first = std::find_if(top.node.entries.begin(), top.node.entries.end(),
                                      [&](const Node::Entry& e) { return e.key == node.text; });
      throw document_.error(
          node.mark, "document.duplicate_key", "the key " + inQuotes(node.text) + " is given twice",
          "it is also in line " + std::to_string(first->key_mark.line) + "; keep one of them");
    }
    top.has_key = true;
    top.key = std::move(node.text);
    top.key_mark = node.mark;
  }

  const std::string& text_;
  Document& document_;
  std::size_t nodes_ = 0;
  bool has_document_ = false;
  std::vector<Frame> frames_;
};

}  // namespace

void readYaml(const std::string& text, Document& document) {
  std::istringstream stream(text);
  TreeBuilder builder(text, document);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(builder)) {
    }
  } catch (const YAML::Exception& exception) {
    throw builder.syntax(exception);
  }
  if (!builder.hasDocument()) {
    throw document.error({1, 1}, "document.empty", "the file is empty");
  }
}

}  // namespace palpate
