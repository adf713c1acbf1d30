#pragma once
/// Reads the `fields` of a scene: named and inline, analytic, combined, and of the registry's
/// kinds.

#include <functional>
#include <limits>
#include <map>
#include <string>
#include <vector>

#include "palpate/interior/partition.h"
#include "palpate/scene/scene_file.h"

namespace palpate {

/// Makes field sources from nodes. A named field is made once, so that all its users share one
/// object: ports find their facet by identity.
class FieldReader {
 public:
  FieldReader(const SceneLoader& loader, const SceneRegistry& registry)
      : loader_(loader), registry_(registry) {}

  /// Records all names, then makes each field; a name may be used before it is defined.
  void define(const Node& fields);

  /// A name, or an inline map of one kind.
  [[nodiscard]] FieldSourcePtr read(const Node& node);
  /// A name only: for fields that must be the same object elsewhere.
  [[nodiscard]] FieldSourcePtr readName(const Node& node, const std::string& what);

  /// The reason why the named field may not be a face of the field that it became part of, as a
  /// sentence for people; empty if none is known.
  [[nodiscard]] std::string hidingPlace(const std::string& name) const;

  /// All named fields, in the order of the file.
  [[nodiscard]] std::vector<NamedField> all() const;

 private:
  /// The most leaves of a tree, since leaves are numbered with LeafId. Names that each use the one
  /// before twice exceed this in 16 lines.
  static constexpr std::size_t kMostLeaves = std::numeric_limits<LeafId>::max();

  struct Built {
    FieldSourcePtr source;
    std::size_t leaves = 1;  // of its tree; shared parts count each time, as they are evaluated
    int height = 1;
  };
  struct Named {
    const Node::Entry* entry = nullptr;
    bool under_way = false;
    Built built = {};
    std::vector<std::string> uses = {};      // names that it is made from
    const Node::Entry* hidden_in = nullptr;  // the operation that replaced its faces
  };
  using Combine = std::function<FieldPtr(std::vector<FieldPtr>)>;

  [[nodiscard]] Built build(const Node& node);
  [[nodiscard]] const Built& buildNamed(const std::string& name, Mark mark);
  [[nodiscard]] Built buildKind(const Node::Entry& kind);
  [[nodiscard]] Built buildOperation(const Node::Entry& kind, const std::string& declared);
  [[nodiscard]] Built buildBlend(const Node::Entry& kind, const MapReader& reader);
  [[nodiscard]] Built buildTransform(const Node::Entry& kind, const MapReader& reader);
  [[nodiscard]] Built buildRegistered(const Node::Entry& kind);
  [[nodiscard]] const KeyWords* wordsOf(const std::string& kind) const;
  [[nodiscard]] Built combine(const Node::Entry& kind, const Node& operands, Combine operation);
  [[nodiscard]] Built modify(const Node::Entry& kind, const Node& operand,
                             const std::function<FieldPtr(FieldPtr)>& operation);
  void hide(const std::string& name, const Node::Entry& blend);
  [[nodiscard]] std::vector<std::string_view> names() const;
  [[nodiscard]] std::vector<std::string_view> kinds() const;

  const SceneLoader& loader_;
  const SceneRegistry& registry_;
  std::map<std::string, Named, std::less<>> named_ = {};
  std::vector<std::string> order_ = {};
  std::vector<std::string> path_ = {};  // names being read, to show a cycle
  const Node::Entry* blend_ = nullptr;  // the outermost one being read
  Built operands_ = {nullptr, 0, 0};    // all operands together of the registered kind being read
  int depth_ = 0;
};

}  // namespace palpate
