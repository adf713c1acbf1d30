#include "scene/field_reader.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <utility>

#include "palpate/fields/blend.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/modify.h"
#include "palpate/fields/transform.h"
#include "scene/messages.h"
#include "scene/shape_reader.h"
#include "scene/source_text.h"
#include "scene/values.h"

namespace palpate {
namespace {

// Fields are numbered with LeafId; names that stand for each other twice over reach this in 16 lines.
constexpr std::size_t kMostLeaves = std::numeric_limits<LeafId>::max();

// Kinds that are made from other fields; the rest are shapeKinds().
constexpr std::string_view kOperations[] = {
    "union",        "intersection",        "difference",        "complement", "transform",
    "smooth_union", "smooth_intersection", "smooth_difference", "scale",      "offset",
    "shell"};
// Kinds of palpate::vdb: a scene that asks for them is right, only this program cannot read it.
constexpr std::string_view kKindsOfGrids[] = {"mesh", "grid", "baked"};

// A constructor's complaint, with the place it does not know.
template <typename Make>
FieldPtr madeAt(const SourcePlace& place, Make&& make) {
  try {
    return make();
  } catch (const Error& error) {
    const Problem& problem = error.problem();
    if (!problem.file.empty() || error.kind() != ErrorKind::kInput) throw;
    throw errorAt(place, problem.code, problem.message, problem.hint);
  }
}

// `make` over operands: done at once if they are all there, else when the result is asked for.
FieldSourcePtr deferred(std::vector<FieldSourcePtr> operands, SourcePlace place,
                        std::function<FieldPtr(std::vector<FieldPtr>)> make) {
  std::string summary;
  bool ready = true;
  for (const FieldSourcePtr& operand : operands) {
    ready = ready && operand->isMade();
    const std::string& part = operand->summary();
    if (!part.empty()) summary += (summary.empty() ? "" : ", ") + part;
  }
  auto maker = [operands = std::move(operands), place = std::move(place),
                make = std::move(make)](const Progress& progress) {
    std::vector<FieldPtr> fields;
    fields.reserve(operands.size());
    for (const FieldSourcePtr& operand : operands) fields.push_back(operand->get(progress));
    return madeAt(place, [&] { return make(std::move(fields)); });
  };
  if (ready && summary.empty()) return std::make_shared<FieldSource>(maker({}));
  return std::make_shared<FieldSource>(std::move(summary), std::move(maker));
}

std::vector<std::string_view> builtInKinds() {
  const std::span<const std::string_view> shapes = shapeKinds();
  std::vector<std::string_view> kinds(shapes.begin(), shapes.end());
  kinds.insert(kinds.end(), std::begin(kOperations), std::end(kOperations));
  return kinds;
}

template <typename Names>
bool isOneOf(std::string_view name, const Names& names) {
  return std::find(std::begin(names), std::end(names), name) != std::end(names);
}

}  // namespace

std::vector<std::string_view> FieldReader::names() const { return {order_.begin(), order_.end()}; }

void FieldReader::define(const Node& fields) {
  const Document& document = loader_.document();
  requireMap(document, fields, "'fields'");
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
    throw loader_.document().error(node.mark, "scene.kind",
                                   what + " wants the name of a field, not a field of its own",
                                   "define it in `fields`, and use its name in the layer too");
  }
  const std::string name = readText(loader_.document(), node, what);
  return buildNamed(name, node.mark).source;
}

const FieldReader::Built& FieldReader::buildNamed(const std::string& name, Mark mark) {
  const Document& document = loader_.document();
  const auto found = named_.find(name);
  if (found == named_.end()) {
    throw document.error(mark, "scene.unknown_field", "there is no field " + inQuotes(name),
                         suggestOrList(name, names(), "fields: "));
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
    throw document.error(mark, "scene.cycle",
                         "the field " + inQuotes(name) + " is defined by itself",
                         "the circle: " + cycle + name);
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
  return inQuotes(name) + " went into the " + blend.key + " in line " +
         std::to_string(blend.key_mark.line) + ", whose faces are new ones; name that whole field";
}

FieldReader::Built FieldReader::build(const Node& node) {
  const Document& document = loader_.document();
  const auto too_deep = [&] {
    return document.error(
        node.mark, "scene.depth",
        "this field has fields in fields, more than " + std::to_string(kDeepestNesting) + " deep");
  };
  // On the way in, so that a long chain of names cannot exhaust the stack; on the way out, because a
  // chain in the other order comes here without depth.
  if (depth_ >= kDeepestNesting) throw too_deep();
  if (node.kind == Node::Kind::kMap) {
    if (node.entries.empty()) {
      throw document.error(node.mark, "scene.empty", "this field is empty",
                           "write one kind: " + listed(builtInKinds()));
    }
    if (node.entries.size() > 1) {
      throw document.error(node.entries[1].key_mark, "scene.kind",
                           "a field is of one kind; this has " + inQuotes(node.entries[0].key) +
                               " and " + inQuotes(node.entries[1].key),
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
          "this field comes to more than " + std::to_string(kMostLeaves) + " simple ones");
    }
    return built;
  }
  if (node.kind == Node::Kind::kScalar) {
    ++depth_;
    Built built = buildNamed(readText(document, node, "a field"), node.mark);
    --depth_;
    return built;
  }
  throw document.error(node.mark, "scene.kind", "a field is a name or a map of one kind",
                       "{union: [...]} makes one field of a list");
}

FieldReader::Built FieldReader::buildKind(const Node::Entry& kind) {
  if (isOneOf(kind.key, kOperations)) return buildOperation(kind);
  if (isOneOf(kind.key, shapeKinds())) {
    MapReader reader(loader_, kind.value, inQuotes(kind.key));
    const auto make = readShape(kind.key, reader);
    return {std::make_shared<FieldSource>(madeAt(loader_.document().place(kind.key_mark), make))};
  }
  return buildRegistered(kind);
}

FieldReader::Built FieldReader::buildOperation(const Node::Entry& kind) {
  if (kind.key == "union") return combine(kind, kind.value, unite);
  if (kind.key == "intersection") return combine(kind, kind.value, intersect);
  if (kind.key == "difference") return combine(kind, kind.value, subtract);
  if (kind.key == "complement") {
    return modify(kind, kind.value, [](FieldPtr field) { return complement(std::move(field)); });
  }
  if (kind.key == "transform") return buildTransform(kind);

  MapReader reader(loader_, kind.value, inQuotes(kind.key));
  if (kind.key == "shell") {
    const Node& field = reader.require("field");
    const double thickness = positiveLength(reader, "thickness");
    reader.finish();
    // Its outer faces are those of the field itself, so they keep their names.
    Built built = modify(kind, field, [=](FieldPtr f) { return shell(std::move(f), thickness); });
    built.leaves = std::min(2 * built.leaves, kMostLeaves + 1);
    return built;
  }
  // What goes into the others cannot be named by a port any more.
  const Node::Entry* const around = blend_;
  if (blend_ == nullptr) blend_ = &kind;
  Built built = buildBlend(kind, reader);
  blend_ = around;
  return built;
}

FieldReader::Built FieldReader::buildBlend(const Node::Entry& kind, MapReader& reader) {
  if (kind.key == "scale") {
    const Node& field = reader.require("field");
    const double factor = reader.requireNumber("factor");
    reader.finish();
    if (!(factor > 0.0)) {
      throw reader.errorAt("factor", "scene.range", "'factor' must be more than 0",
                           "2 doubles the size; what mirrors is not a solid to feel");
    }
    return modify(kind, field, [=](FieldPtr f) { return scale(std::move(f), factor); });
  }
  if (kind.key == "offset") {
    const Node& field = reader.require("field");
    const double distance = reader.requireLength("distance");
    reader.finish();
    return modify(kind, field, [=](FieldPtr f) { return offset(std::move(f), distance); });
  }
  const Node& fields = reader.require("fields");
  const double radius = positiveLength(reader, "radius");
  reader.finish();
  const auto blended = [&](FieldPtr (*blend)(std::vector<FieldPtr>, double)) {
    return combine(kind, fields, [=](std::vector<FieldPtr> operands) {
      return blend(std::move(operands), radius);
    });
  };
  if (kind.key == "smooth_union") return blended(smoothUnite);
  if (kind.key == "smooth_intersection") return blended(smoothIntersect);
  return blended(smoothSubtract);
}

FieldReader::Built FieldReader::combine(const Node::Entry& kind, const Node& operands,
                                        Combine operation) {
  Built built{nullptr, 0, 0};
  std::vector<FieldSourcePtr> sources;
  const std::string what = inQuotes(&operands == &kind.value ? kind.key : "fields");
  for (const Node& operand : readList(loader_.document(), operands, what, 1, 0)) {
    const Built part = build(operand);
    sources.push_back(part.source);
    built.leaves = std::min(built.leaves + part.leaves, kMostLeaves + 1);
    built.height = std::max(built.height, part.height);
  }
  ++built.height;
  built.source =
      deferred(std::move(sources), loader_.document().place(kind.key_mark), std::move(operation));
  return built;
}

FieldReader::Built FieldReader::modify(const Node::Entry& kind, const Node& operand,
                                       const std::function<FieldPtr(FieldPtr)>& operation) {
  Built built = build(operand);
  ++built.height;
  built.source =
      deferred({built.source}, loader_.document().place(kind.key_mark),
               [=](const std::vector<FieldPtr>& fields) { return operation(fields[0]); });
  return built;
}

FieldReader::Built FieldReader::buildTransform(const Node::Entry& kind) {
  MapReader reader(loader_, kind.value, "'transform'");
  const Node& field = reader.require("field");
  Pose pose;
  const Node* rotate = reader.optional("rotate");
  if (rotate != nullptr) {
    MapReader rotation(loader_, *rotate, "'rotate'");
    const Vec3 axis = rotation.requireDirection("axis");
    const double degrees = rotation.requireNumber("degrees");
    rotation.finish();
    pose.rotation = rotationAbout(axis, degrees * std::numbers::pi / 180.0);
  }
  const bool translates = reader.optional("translate") != nullptr;
  if (translates) pose.translation = reader.requirePoint("translate");
  reader.finish();
  if (rotate == nullptr && !translates) {
    throw loader_.document().error(kind.key_mark, "scene.missing_key", "'transform' moves nothing",
                                   "add translate, rotate or both");
  }
  return modify(kind, field, [=](FieldPtr f) { return place(std::move(f), pose); });
}

FieldReader::Built FieldReader::buildRegistered(const Node::Entry& kind) {
  const Document& document = loader_.document();
  const auto found = registry_.fields.find(kind.key);
  if (found == registry_.fields.end()) {
    if (isOneOf(kind.key, kKindsOfGrids)) {
      throw document.error(kind.key_mark, "scene.no_reader",
                           "this program reads no " + inQuotes(kind.key) + " fields",
                           "palpate::vdb reads them, and is not part of this program");
    }
    std::vector<std::string_view> kinds = builtInKinds();
    for (const auto& [name, reader] : registry_.fields) kinds.push_back(name);
    throw document.error(kind.key_mark, "scene.unknown_kind",
                         "there is no kind of field " + inQuotes(kind.key),
                         suggestOrList(kind.key, kinds, "kinds: "));
  }
  MapReader reader(loader_, kind.value, inQuotes(kind.key));
  // It may be made of fields, which come here through read(), and whose faces may be new ones then.
  const Node::Entry* const around = blend_;
  if (blend_ == nullptr) blend_ = &kind;
  const Built before = std::exchange(operands_, Built{nullptr, 0, 0});
  FieldSourcePtr source = found->second(reader);
  const Built operands = std::exchange(operands_, before);
  blend_ = around;
  reader.finish();
  if (!source) {
    throw document.error(kind.key_mark, "scene.no_reader",
                         "nothing came of this " + inQuotes(kind.key));
  }
  return {std::move(source), std::max<std::size_t>(operands.leaves, 1), operands.height + 1};
}

}  // namespace palpate
