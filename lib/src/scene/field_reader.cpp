#include "scene/field_reader.h"

#include <algorithm>
#include <utility>

#include "scene/field_at_place.h"
#include "scene/messages.h"
#include "scene/shape_reader.h"
#include "scene/source_text.h"
#include "scene/values.h"

namespace palpate {
std::vector<std::string_view> FieldReader::names() const { return {order_.begin(), order_.end()}; }

std::vector<std::string_view> FieldReader::kinds() const {
  std::vector<std::string_view> all;
  for (const KeyWords& kind : loader_.vocabulary().find("field_kind")->keys) {
    all.push_back(kind.name);
  }
  for (const auto& [name, reader] : registry_.fields) {
    if (wordsOf(name) == nullptr) all.push_back(name);
  }
  return all;
}

const KeyWords* FieldReader::wordsOf(const std::string& kind) const {
  return loader_.vocabulary().find("field_kind")->find(kind);
}

void FieldReader::define(const Node& fields) {
  const Document& document = loader_.document();
  for (const Node::Entry& entry : fields.entries) {
    refuseEmpty(document, entry);
    named_[entry.key].entry = &entry;
    order_.push_back(entry.key);
  }
  for (const Node::Entry& entry : fields.entries) {
    (void)buildNamed(entry.key, entry.key_mark);
  }
}

std::vector<NamedField> FieldReader::all() const {
  std::vector<NamedField> all;
  all.reserve(order_.size());
  for (const std::string& name : order_) {
    all.push_back({name, named_.find(name)->second.built.source});
  }
  return all;
}

FieldSourcePtr FieldReader::read(const Node& node) {
  Built built = build(node);
  operands_.leaves = std::min(operands_.leaves + built.leaves, kMostLeaves + 1);
  operands_.height = std::max(operands_.height, built.height);
  return std::move(built.source);
}

FieldSourcePtr FieldReader::readName(const Node& node, const std::string& what) {
  if (node.kind == Node::Kind::kMap) {
    throw loader_.document().error(
        node.mark, "scene.kind", what + " must be the name of a field, not a field written out",
        "define the field in `fields`, and use its name here and in the layer");
  }
  const std::string name = readText(loader_.document(), node, what);
  return buildNamed(name, node.mark).source;
}

const FieldReader::Built& FieldReader::buildNamed(const std::string& name, Mark mark) {
  const Document& document = loader_.document();
  const auto found = named_.find(name);
  if (found == named_.end()) {
    throw unknownName(document, mark, "field", name, names());
  }
  Named& named = found->second;
  if (!path_.empty()) named_.find(path_.back())->second.uses.push_back(name);
  if (blend_ != nullptr) hide(name, *blend_);
  if (named.built.source) return named.built;
  if (named.under_way) {
    std::string cycle;
    for (auto at = std::find(path_.begin(), path_.end(), name); at != path_.end(); ++at) {
      cycle += *at + " -> ";
    }
    throw document.error(mark, "scene.cycle", "the field " + inQuotes(name) + " is made of itself",
                         "the chain of names: " + cycle + name);
  }
  named.under_way = true;
  path_.push_back(name);
  named.built = build(named.entry->value);
  path_.pop_back();
  named.under_way = false;
  return named.built;
}

void FieldReader::hide(const std::string& name, const Node::Entry& blend) {
  Named& named = named_.find(name)->second;
  if (named.hidden_in != nullptr) return;
  named.hidden_in = &blend;
  for (const std::string& part : named.uses) hide(part, blend);
}

std::string FieldReader::hidingPlace(const std::string& name) const {
  const auto found = named_.find(name);
  if (found == named_.end() || found->second.hidden_in == nullptr) return {};
  const Node::Entry& blend = *found->second.hidden_in;
  return inQuotes(name) + " is part of the " + blend.key + " in line " +
         std::to_string(blend.key_mark.line) +
         ", which makes new faces; name that whole field instead";
}

FieldReader::Built FieldReader::build(const Node& node) {
  const Document& document = loader_.document();
  const auto too_deep = [&] {
    return document.error(
        node.mark, "scene.depth",
        "fields are nested more than " + std::to_string(kDeepestNesting) + " deep here");
  };
  // The depth is checked on the way in, so that a long chain of names cannot exhaust the stack, and
  // on the way out, because a chain defined in the other order arrives here without depth.
  if (depth_ >= kDeepestNesting) throw too_deep();
  if (node.kind == Node::Kind::kMap) {
    if (node.entries.empty()) {
      throw document.error(node.mark, "scene.empty", "this field is empty",
                           "write one kind: " + listed(kinds()));
    }
    if (node.entries.size() > 1) {
      throw document.error(
          node.entries[1].key_mark, "scene.kind",
          "a field has one kind; this one has two: " + inQuotes(node.entries[0].key) + " and " +
              inQuotes(node.entries[1].key),
          "combine fields with union, intersection or difference");
    }
    refuseEmpty(document, node.entries[0]);
    ++depth_;
    Built built = buildKind(node.entries[0]);
    --depth_;
    if (built.height > kDeepestNesting) throw too_deep();
    if (built.leaves > kMostLeaves) {
      throw document.error(
          node.mark, "scene.too_many_fields",
          "this field is made of more than " + std::to_string(kMostLeaves) + " simple fields");
    }
    return built;
  }
  if (node.kind == Node::Kind::kScalar) {
    ++depth_;
    Built built = buildNamed(readText(document, node, "a field"), node.mark);
    --depth_;
    return built;
  }
  throw document.error(node.mark, "scene.kind",
                       "a field is a name, or a map with one key: its kind",
                       "{union: [...]} makes one field of a list");
}

FieldReader::Built FieldReader::buildKind(const Node::Entry& kind) {
  const KeyWords* words = wordsOf(kind.key);
  const bool is_ours = words != nullptr && words->form != KeyWords::Form::kAny &&
                       !registry_.fields.contains(kind.key);
  if (!is_ours) return buildRegistered(kind);
  if (words->form == KeyWords::Form::kMap) {
    const MapReader reader(loader_, kind.value, inQuotes(kind.key), words->type);
    if (const auto make = readShape(kind.key, reader)) {
      return {std::make_shared<FieldSource>(madeAt(loader_.document().place(kind.key_mark), make))};
    }
  }
  return buildOperation(kind, words->type);
}

FieldReader::Built FieldReader::buildRegistered(const Node::Entry& kind) {
  const Document& document = loader_.document();
  const KeyWords* words = wordsOf(kind.key);
  const auto found = registry_.fields.find(kind.key);
  if (found == registry_.fields.end()) {
    if (words != nullptr) {
      throw noReader(document, kind.key_mark, inQuotes(kind.key) + " fields");
    }
    throw document.error(kind.key_mark, "scene.unknown_kind",
                         "there is no kind of field " + inQuotes(kind.key),
                         suggestOrList(kind.key, kinds(), "kinds: "));
  }
  MapReader reader(loader_, kind.value, inQuotes(kind.key),
                   words == nullptr ? std::string_view() : words->type);
  // A registered kind may have fields as operands, which are read through read(); it may give them
  // new faces.
  const Node::Entry* const around = blend_;
  if (blend_ == nullptr) blend_ = &kind;
  const Built before = std::exchange(operands_, Built{nullptr, 0, 0});
  FieldSourcePtr source = found->second(reader);
  const Built operands = std::exchange(operands_, before);
  blend_ = around;
  reader.finish();
  if (!source) {
    throw document.error(kind.key_mark, "scene.no_reader",
                         "this " + inQuotes(kind.key) + " could not be made");
  }
  return {std::move(source), std::max<std::size_t>(operands.leaves, 1), operands.height + 1};
}

}  // namespace palpate
