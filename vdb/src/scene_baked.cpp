#include "scene_baked.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "named_progress.h"
#include "palpate/core/error.h"
#include "palpate/vdb/hybrid.h"
#include "scene_grid.h"

namespace palpate::vdb {
namespace {

constexpr double kVoxelsAlong = 128.0;

Parts readParts(MapReader& reader) {
  const std::string parts = reader.textOr("parts", "auto");
  if (parts == "auto") return Parts::kAuto;
  if (parts == "operands") return Parts::kOperands;
  if (parts == "whole") return Parts::kWhole;
  throw reader.errorAt("parts", "scene.kind", "'parts' is `" + parts + "`",
                       "write parts: auto, parts: operands or parts: whole");
}

HybridOptions readOptions(MapReader& reader) {
  HybridOptions options;
  options.bake.length_unit = reader.loader().lengthUnit();
  options.bake.name = "baked";
  options.bake.voxel_size = readPositiveOrNone(reader, "voxel");
  options.bake.half_width = readHalfWidth(reader, options.bake.half_width);
  options.tolerance = readPositiveOrNone(reader, "tolerance");
  options.parts = readParts(reader);
  options.sampler = readSampler(reader);
  if (options.parts == Parts::kWhole && options.tolerance > 0.0) {
    throw reader.errorAt("tolerance", "scene.range",
                         "one grid of the whole is made as it is, whatever its error",
                         "leave out tolerance, or write parts: auto or parts: operands");
  }
  return options;
}

double longestSide(const Field& field) {
  const Box3 bounds = field.bounds();
  if (!bounds.isBounded()) {
    throw inputError("bake.unbounded", "the field reaches to infinity, and no voxel size was given",
                     "give `voxel`, and bake what this field is cut to, not the field alone");
  }
  const Vec3 size = bounds.size();
  return std::max({size.x, size.y, size.z});
}

/// Tells what became of the parts, each grid and each decision.
void tell(const RegisterOptions& options, const std::string& what, const Hybrid& made,
          double seconds) {
  bool is_first = true;
  for (const HybridPart& part : made.parts) {
    const std::string name = part.name.empty() ? what : what + ", part " + part.name;
    if (options.on_note) options.on_note(name + " " + part.reason);
    if (!part.grid || !options.on_grid) continue;
    // The time is that of all together.
    options.on_grid({name, part.grid.info(), is_first ? seconds : 0.0});
    is_first = false;
  }
}

}  // namespace

FieldSourcePtr readBaked(MapReader& reader, const RegisterOptions& options) {
  const FieldSourcePtr field = reader.loader().field(reader.require("field"));
  const HybridOptions asked = readOptions(reader);
  const SourcePlace place = reader.loader().document().place(reader.node().mark);
  const std::string what = "baked field in line " + std::to_string(place.line);
  auto make = [field, asked, place, what, options](const Progress& progress) {
    const FieldPtr operand = field->get(progress);
    const auto start = std::chrono::steady_clock::now();
    Hybrid made;
    try {
      HybridOptions hybrid = asked;
      if (!(hybrid.bake.voxel_size > 0.0)) {
        hybrid.bake.voxel_size = longestSide(*operand) / kVoxelsAlong;
      }
      made = bakeHybrid(operand, hybrid, namedProgress(progress, what));
    } catch (const Error& error) {
      throwAt(place, error);
    }
    const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start;
    tell(options, what, made, took.count());
    return made.field;
  };
  const std::string& from = field->summary();
  return std::make_shared<FieldSource>("baked" + (from.empty() ? "" : " " + from), std::move(make));
}

}  // namespace palpate::vdb
