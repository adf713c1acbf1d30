// FieldReader's kinds that are made from other fields.

#include <algorithm>
#include <functional>
#include <utility>

#include "palpate/fields/csg.h"
#include "scene/field_at_place.h"
#include "scene/field_reader.h"
#include "scene/messages.h"
#include "scene/values.h"

namespace palpate {
namespace {

/// Whether an operation evaluates its operands only where it is evaluated itself. If not, its
/// operands are made whole: so a field that is used twice is requested for one box, and is one
/// leaf.
enum class Asks { kThere, kElsewhere };

// Applies `make` to the operands: now if all of them are made, else when the result is asked for.
FieldSourcePtr deferred(std::vector<FieldSourcePtr> operands, Asks asks, SourcePlace place,
                        std::function<FieldPtr(std::vector<FieldPtr>)> make) {
  std::string summary = joined(operands, ", ", &FieldSource::summary);
  const bool ready = std::all_of(operands.begin(), operands.end(),
                                 [](const auto& operand) { return operand->isMade(); });
  auto maker = [operands = std::move(operands), asks, place = std::move(place),
                make = std::move(make)](const Box3& within, const Progress& progress) {
    const Box3 needed = asks == Asks::kThere ? within : Box3::everything();
    std::vector<FieldPtr> fields;
    fields.reserve(operands.size());
    for (const FieldSourcePtr& operand : operands) fields.push_back(operand->get(needed, progress));
    return madeAt(place, [&] { return make(std::move(fields)); });
  };
  if (ready && summary.empty()) {
    return std::make_shared<FieldSource>(maker(Box3::everything(), {}));
  }
  return std::make_shared<FieldSource>(std::move(summary), std::move(maker));
}

}  // namespace

FieldReader::Built FieldReader::buildOperation(const Node::Entry& kind,
                                               const std::string& declared) {
  if (kind.key == "union") return combine(kind, kind.value, unite);
  if (kind.key == "intersection") return combine(kind, kind.value, intersect);
  if (kind.key == "difference") return combine(kind, kind.value, subtract);
  if (kind.key == "complement") {
    const auto invert = [](const std::vector<FieldPtr>& fields) { return complement(fields[0]); };
    Built built = build(kind.value);
    ++built.height;
    built.source =
        deferred({built.source}, Asks::kThere, loader_.document().place(kind.key_mark), invert);
    return built;
  }
  const MapReader reader(loader_, kind.value, inQuotes(kind.key), declared);
  if (kind.key == "transform") return buildTransform(kind, reader);
  if (kind.key == "shell") {
    const double thickness = reader.value("thickness");
    // The outer faces of a shell are those of the field itself, so a port can still name them.
    Built built = modify(kind, *reader.find("field"),
                         [=](FieldPtr f) { return shell(std::move(f), thickness); });
    built.leaves = std::min(2 * built.leaves, kMostLeaves + 1);
    return built;
  }
  // The operands of the other operations can no longer be named by a port.
  const Node::Entry* const around = blend_;
  if (blend_ == nullptr) blend_ = &kind;
  Built built = buildBlend(kind, reader);
  blend_ = around;
  return built;
}

FieldReader::Built FieldReader::buildBlend(const Node::Entry& kind, const MapReader& reader) {
  if (kind.key == "scale") {
    const double factor = reader.value("factor");
    return modify(kind, *reader.find("field"),
                  [=](FieldPtr f) { return scale(std::move(f), factor); });
  }
  if (kind.key == "offset") {
    const double distance = reader.value("distance");
    return modify(kind, *reader.find("field"),
                  [=](FieldPtr f) { return offset(std::move(f), distance); });
  }
  const auto blended = [&](FieldPtr (*blend)(std::vector<FieldPtr>, double)) {
    return combine(kind, *reader.find("fields"),
                   [blend, radius = reader.value("radius")](std::vector<FieldPtr> operands) {
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
  built.source = deferred(std::move(sources), Asks::kThere, loader_.document().place(kind.key_mark),
                          std::move(operation));
  return built;
}

FieldReader::Built FieldReader::modify(const Node::Entry& kind, const Node& operand,
                                       const std::function<FieldPtr(FieldPtr)>& operation) {
  Built built = build(operand);
  ++built.height;
  built.source =
      deferred({built.source}, Asks::kElsewhere, loader_.document().place(kind.key_mark),
               [=](const std::vector<FieldPtr>& fields) { return operation(fields[0]); });
  return built;
}

FieldReader::Built FieldReader::buildTransform(const Node::Entry& kind, const MapReader& reader) {
  if (!reader.has("rotate") && !reader.has("translate")) {
    throw loader_.document().error(kind.key_mark, "scene.missing_key", "'transform' moves nothing",
                                   "add translate, rotate or both");
  }
  Pose pose;
  if (reader.has("rotate")) pose.rotation = readRotation(reader.map("rotate"));
  pose.translation = reader.point("translate");
  return modify(kind, *reader.find("field"), [=](FieldPtr f) { return place(std::move(f), pose); });
}

}  // namespace palpate
