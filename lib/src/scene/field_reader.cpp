#include "scene/field_reader.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>

#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/fields/transform.h"
#include "scene/messages.h"
#include "scene/source_text.h"
#include "scene/values.h"

namespace palpate {
namespace {

// Fields are numbered with LeafId; names that stand for each other twice over reach this in 16 lines.
constexpr std::size_t kMostLeaves = std::numeric_limits<LeafId>::max();

constexpr std::string_view kKinds[] = {"half_space", "sphere",   "box",          "cylinder",
                                       "ellipsoid",  "union",    "intersection", "difference",
                                       "complement", "transform"};
// Kinds of palpate::vdb: a scene that asks for them is right, only this program cannot read it.
constexpr std::string_view kKindsOfGrids[] = {"mesh", "grid"};

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

double positiveLength(MapReader& reader, std::string_view key) {
  const double length = reader.requireLength(key);
  if (!(length > 0.0)) {
    throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be more than 0");
  }
  return length;
}

Vec3 positiveLengths(MapReader& reader, std::string_view key) {
  const Vec3 lengths = reader.requirePoint(key);
  if (!(lengths.x > 0.0 && lengths.y > 0.0 && lengths.z > 0.0)) {
    throw reader.errorAt(key, "scene.range",
                         "each length of " + inQuotes(key) + " must be more than 0");
  }
  return lengths;
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
                           "write one kind: " + listed({std::begin(kKinds), std::end(kKinds)}));
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
    const Built built = buildNamed(readText(document, node, "a field"), node.mark);
    --depth_;
    return built;
  }
  throw document.error(node.mark, "scene.kind", "a field is a name or a map of one kind",
                       "{union: [...]} makes one field of a list");
}

FieldReader::Built FieldReader::buildKind(const Node::Entry& kind) {
  const Document& document = loader_.document();
  const std::string what = inQuotes(kind.key);
  const auto all_of = [&] {
    std::vector<const Node*> operands;
    for (const Node& item : readList(document, kind.value, what, 1, 0)) operands.push_back(&item);
    return operands;
  };
  if (kind.key == "union") return combine(kind, all_of(), unite);
  if (kind.key == "intersection") return combine(kind, all_of(), intersect);
  if (kind.key == "difference") return combine(kind, all_of(), subtract);
  if (kind.key == "complement") {
    return combine(kind, {&kind.value},
                   [](std::vector<FieldPtr> fields) { return complement(fields[0]); });
  }
  if (kind.key == "transform") return buildTransform(kind);
  if (std::find(std::begin(kKinds), std::end(kKinds), kind.key) != std::end(kKinds)) {
    return {buildPrimitive(kind)};
  }
  return buildRegistered(kind);
}

FieldReader::Built FieldReader::combine(const Node::Entry& kind,
                                        const std::vector<const Node*>& operands,
                                        Combine operation) {
  Built built{nullptr, 0, 0};
  std::vector<FieldSourcePtr> sources;
  for (const Node* operand : operands) {
    const Built part = build(*operand);
    sources.push_back(part.source);
    built.leaves = std::min(built.leaves + part.leaves, kMostLeaves + 1);
    built.height = std::max(built.height, part.height);
  }
  ++built.height;
  built.source = deferred(std::move(sources), loader_.document().place(kind.key_mark), operation);
  return built;
}

FieldReader::Built FieldReader::buildTransform(const Node::Entry& kind) {
  MapReader reader(loader_, kind.value, "'transform'");
  Built built = build(reader.require("field"));
  ++built.height;
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
  built.source =
      deferred({built.source}, loader_.document().place(kind.key_mark),
               [pose](const std::vector<FieldPtr>& fields) { return place(fields[0], pose); });
  return built;
}

FieldSourcePtr FieldReader::buildPrimitive(const Node::Entry& kind) {
  MapReader reader(loader_, kind.value, inQuotes(kind.key));
  const auto ready = [&](auto&& make) {
    reader.finish();
    return std::make_shared<FieldSource>(madeAt(loader_.document().place(kind.key_mark), make));
  };
  if (kind.key == "half_space") {
    const Vec3 point = reader.requirePoint("point");
    const Vec3 normal = reader.requireDirection("normal");
    return ready([&] { return halfSpace(point, normal); });
  }
  const Vec3 center = reader.requirePoint("center");
  if (kind.key == "sphere") {
    const double radius = positiveLength(reader, "radius");
    return ready([&] { return sphere(center, radius); });
  }
  if (kind.key == "box") {
    const Vec3 size = positiveLengths(reader, "size");
    return ready([&] { return box(center, size); });
  }
  if (kind.key == "ellipsoid") {
    const Vec3 radii = positiveLengths(reader, "radii");
    return ready([&] { return ellipsoid(center, radii); });
  }
  const Vec3 axis = reader.requireDirection("axis");
  const double radius = positiveLength(reader, "radius");
  const double height = positiveLength(reader, "height");
  return ready([&] { return cylinder(center, axis, radius, height); });
}

FieldReader::Built FieldReader::buildRegistered(const Node::Entry& kind) {
  const Document& document = loader_.document();
  const auto found = registry_.fields.find(kind.key);
  if (found == registry_.fields.end()) {
    if (std::find(std::begin(kKindsOfGrids), std::end(kKindsOfGrids), kind.key) !=
        std::end(kKindsOfGrids)) {
      throw document.error(kind.key_mark, "scene.no_reader",
                           "this program reads no " + inQuotes(kind.key) + " fields",
                           "palpate::vdb reads them, and is not part of this program");
    }
    std::vector<std::string_view> kinds(std::begin(kKinds), std::end(kKinds));
    for (const auto& [name, reader] : registry_.fields) kinds.push_back(name);
    throw document.error(kind.key_mark, "scene.unknown_kind",
                         "there is no kind of field " + inQuotes(kind.key),
                         suggestOrList(kind.key, kinds, "kinds: "));
  }
  MapReader reader(loader_, kind.value, inQuotes(kind.key));
  FieldSourcePtr source = found->second(reader);
  reader.finish();
  if (!source) {
    throw document.error(kind.key_mark, "scene.no_reader",
                         "nothing came of this " + inQuotes(kind.key));
  }
  return {std::move(source)};
}

}  // namespace palpate
