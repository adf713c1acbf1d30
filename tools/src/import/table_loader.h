#pragma once
/// Reads tables by the strict reader of scene files' maps; tables hold no fields and no images.

#include <memory>
#include <string>
#include <vector>

#include "palpate/scene/scene_file.h"

namespace palpate::tools {

class TableLoader final : public SceneLoader {
 public:
  /// `document` must outlive it. `code`: the prefix of its error codes.
  TableLoader(const Document& document, std::string code)
      : document_(document), code_(std::move(code)) {}
  [[nodiscard]] const Document& document() const noexcept override { return document_; }
  [[nodiscard]] double metersPerUnit() const noexcept override { return 1.0; }
  [[nodiscard]] std::string lengthUnit() const override { return "m"; }
  [[nodiscard]] std::string resolvePath(const std::string& path) const override { return path; }
  [[nodiscard]] FieldSourcePtr field(const Node& node) const override { throw none(node.mark); }
  [[nodiscard]] std::shared_ptr<void> image(const std::string& /*name*/,
                                            Mark place) const override {
    throw none(place);
  }
  [[nodiscard]] MaterialMapPtr map(const Node& node, const ParameterKind& /*of*/) const override {
    throw none(node.mark);
  }

  [[nodiscard]] Error wrong(Mark mark, const std::string& message,
                            const std::string& hint = {}) const {
    return document_.error(mark, code_ + ".kind", message, hint);
  }
  /// @throws Error if `node` is not a map.
  [[nodiscard]] const std::vector<Node::Entry>& entries(const Node& node, const char* of) const {
    if (node.kind != Node::Kind::kMap) {
      throw wrong(node.mark, std::string("'") + of + "' must be a map");
    }
    return node.entries;
  }
  [[nodiscard]] std::string text(const Node& node, const char* of) const {
    if (node.kind != Node::Kind::kScalar || node.text.empty()) {
      throw wrong(node.mark, std::string("an entry of '") + of + "' is a text");
    }
    return node.text;
  }
  [[nodiscard]] std::vector<std::string> texts(const Node& node, const char* of) const {
    if (node.kind != Node::Kind::kSequence || node.items.empty()) {
      throw wrong(node.mark, std::string("'") + of + "' must be a list");
    }
    std::vector<std::string> result;
    for (const Node& item : node.items) result.push_back(text(item, of));
    return result;
  }

 private:
  [[nodiscard]] Error none(Mark mark) const {
    return wrong(mark, "a table of tissues has no shapes, images and maps");
  }
  const Document& document_;
  std::string code_;
};

}  // namespace palpate::tools
