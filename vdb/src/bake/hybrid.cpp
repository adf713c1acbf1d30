#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <numbers>
#include <unordered_map>
#include <unordered_set>
#include <utility>

#include "bake/query_cost.h"
#include "named_progress.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/certificate.h"
#include "palpate/vdb/grid_error.h"
#include "palpate/vdb/grid_memory.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

using Kind = FieldStructure::Kind;

constexpr double kDegree = std::numbers::pi / 180.0;
/// A grid must be this many times as fast as the part it replaces, because it costs memory and has
/// an error.
constexpr double kWorthIt = 1.5;
/// Metadata key of a part's grid: [m] how far it may be off its part.
constexpr const char* kTolerance = "tolerance_m";

std::string inNanoseconds(double ns) {
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), "%.0f ns", ns);
  return out.data();
}

/// When a grid is read again, this many of its blocks of 8^3 voxels are compared with its part.
constexpr std::size_t kBlocksToTellBy = 100;

HybridOptions checked(HybridOptions options) {
  if (!(options.tolerance >= 0.0)) {
    throw inputError("bake.tolerance", "the tolerance is " + inMillimeters(options.tolerance, 3) +
                                           "; it must be 0 or more");
  }
  if (options.sampler == Sampler::kCubic) {
    options.bake.half_width = std::max(options.bake.half_width, kCubicHalfWidth);
  }
  return options;
}

std::string errorText(const GridError& error) {
  return inMillimeters(error.off, 3) + " and " + shortNumber(error.turn / kDegree, 2) + " degree";
}

Pose inverse(const Pose& pose) {
  const Mat3 back = glm::transpose(pose.rotation);
  return {back, -(back * pose.translation)};
}

/// Whether a field knows its distance near its surface only: a grid, or a field made from one.
bool hasBand(const Field& field) {
  const Box3 bounds = field.bounds();
  if (!bounds.isBounded()) return false;
  const double diagonal = glm::length(bounds.size());
  return !field.sample(bounds.hi + Vec3(diagonal + field.featureSize())).in_band;
}

class HybridBaker {
 public:
  HybridBaker(FieldPtr field, const HybridOptions& options, const Progress& progress)
      : root_(cutOff(std::move(field), options.bake)),
        options_(checked(options)),
        progress_(progress) {}

  Hybrid run() {
    collect(root_, root_->bounds(), options_.within, "", false);
    for (const FieldPtr& field : options_.keep) keepLeavesOf(field);
    Hybrid out;
    for (Part& part : parts_) {
      out.parts.push_back(decide(part));
      if (part.made) made_.emplace(part.field.get(), part.made);
    }
    out.field = rebuilt(root_);
    return out;
  }

  /// Uses grids that were made before.
  FieldPtr runOn(const std::map<std::string, LevelSet>& grids) {
    collect(root_, root_->bounds(), options_.within, "", false);
    for (const auto& [name, grid] : grids) {
      const auto part = std::find_if(parts_.begin(), parts_.end(),
                                     [&, &name = name](const Part& p) { return p.name == name; });
      if (part == parts_.end()) {
        throw inputError(
            "bake.other_field",
            "the grid " + grid.info().name + " belongs to a part that the field does not have",
            "it was made from another field: bake again");
      }
      CertifyOptions certify;
      certify.sampler = options_.sampler;
      certify.max_memory = options_.bake.max_memory;
      const LevelSet wide = certified(grid, certify, progress_).grid;
      const std::uint64_t limit = options_.bake.max_memory;
      part->made = gridField(wide, options_.sampler, Box3::everything(), limit);
      refuseOther(*part, wide);
      if (part->within.isBounded()) {
        part->made = gridField(wide, options_.sampler, part->within, limit);
      }
      made_.emplace(part->field.get(), part->made);
    }
    return rebuilt(root_);
  }

  /// Makes one grid of the whole field.
  Hybrid runWhole() {
    BakeOptions bake_options = options_.bake;
    if (options_.within.isBounded()) setBox(bake_options, options_.within, root_->bounds());
    const LevelSet grid = sure(bake(*root_, bake_options, progress_));
    Hybrid out;
    out.field = gridField(grid, options_.sampler, options_.within, options_.bake.max_memory);
    const GridError error =
        gridError(*root_, grid, *out.field, root_->bounds().intersectedWith(options_.within));
    HybridPart part;
    part.grid = grid;
    part.off = error.off;
    part.turn = error.turn / kDegree;
    part.reason = "one grid of the whole was asked for; it is off by at most " + errorText(error);
    out.parts.push_back(std::move(part));
    return out;
  }

 private:
  struct Part {
    FieldPtr field;
    std::string name;
    Box3 needed;         ///< [m] in its frame: where its surface can be part of the whole's surface
    Box3 within;         ///< [m] in its frame: HybridOptions::within
    bool is_placed;      ///< its frame differs from that of the whole
    FieldPtr made = {};  ///< the grid that replaces it; null: none does
  };

  static FieldPtr cutOff(FieldPtr field, const BakeOptions& bake) {
    if (!bake.box || !bake.box->isBounded()) return field;
    const Box3 bounds = field->bounds();
    if (bake.box->contains(bounds.lo) && bake.box->contains(bounds.hi)) return field;
    return intersect({palpate::box(bake.box->center(), bake.box->size()), std::move(field)});
  }

  void collect(const FieldPtr& field, const Box3& needed, const Box3& within,
               const std::string& name, bool is_placed) {
    const FieldStructure structure = field->structure();
    // Outside the bounds of the tree the whole is outside, whatever the parts are there.
    const Box3 here = needed.intersectedWith(field->bounds());
    switch (structure.kind) {
      case Kind::kUnion:
      case Kind::kIntersection:
        for (std::size_t i = 0; i < structure.operands.size(); ++i) {
          collect(structure.operands[i], here, within,
                  (name.empty() ? "" : name + ".") + std::to_string(i + 1), is_placed);
        }
        return;
      case Kind::kComplement:
        collect(structure.operands.front(), here, within, name, is_placed);
        return;
      case Kind::kTransform:
        collect(structure.operands.front(), inverse(structure.pose).apply(here),
                inverse(structure.pose).apply(within), name, true);
        return;
      case Kind::kFaces:
      case Kind::kLeaf:
        break;
    }
    const auto [known, is_new] = index_.emplace(field.get(), parts_.size());
    if (is_new) {
      parts_.push_back({field, name, needed.intersectedWith(within), within, is_placed});
    } else {
      Part& all = parts_[known->second];
      all.needed = all.needed.unitedWith(needed.intersectedWith(within));
      all.within = all.within.unitedWith(within);
    }
  }

  void keepLeavesOf(const FieldPtr& field) {
    kept_.insert(field.get());
    for (const FieldPtr& operand : field->structure().operands) keepLeavesOf(operand);
  }

  /// Throws if `grid` was made from another field than `part`.
  void refuseOther(const Part& part, const LevelSet& grid) const {
    GridError limit = allowed(grid.info().voxel_size);
    const auto told = grid.info().metadata.find(kTolerance);
    if (told != grid.info().metadata.end()) {
      limit.off = std::max(limit.off, std::strtod(told->second.c_str(), nullptr));
    }
    const GridError error = gridError(*part.field, grid, *part.made,
                                      part.needed.grownBy(grid.info().voxel_size), kBlocksToTellBy);
    if (error.off <= limit.off && error.turn <= limit.turn) return;
    throw inputError("bake.other_field",
                     "the grid " + grid.info().name + " is off its part of the field by " +
                         errorText(error) + " near " + eachInMillimeters(error.where, 3),
                     "it was made of another field: bake again");
  }

  HybridPart decide(Part& part) {
    HybridPart out;
    out.name = part.name;
    const Field& field = *part.field;
    const FieldStructure structure = field.structure();
    const Box3 domain = field.bounds().intersectedWith(part.needed);
    if (structure.operands.size() > 1) {
      out.reason = "stays analytic: it has edges, which no grid holds";
    } else if (kept_.contains(part.field.get())) {
      out.reason = "stays analytic: that was asked for";
    } else if (hasBand(field)) {
      out.reason = "stays as it is: it is a grid already";
    } else if (domain.isEmpty()) {
      out.reason = "stays analytic: it does not reach into the whole";
    } else if (!domain.isBounded()) {
      out.reason = "stays analytic: it is endless, and nothing around it bounds it";
    } else if (options_.parts == Parts::kOperands && field.metric() == Metric::kExact) {
      out.reason = "stays analytic: it is exact";
    } else if (isFastEnough(part, domain, out)) {
      out.reason = "stays analytic: a query takes " + inNanoseconds(out.analytic_ns) +
                   ", from a grid " + inNanoseconds(out.grid_ns);
    } else {
      makeGrid(part, out);
    }
    return out;
  }

  /// Sets the box to bake, so that a surface within `bounds` is right where it is needed.
  static void setBox(BakeOptions& bake_options, const Box3& needed, const Box3& bounds) {
    const double band = bake_options.half_width * bake_options.voxel_size;
    // Twice the band around the needed box: the faces that cut are then outside the band of the
    // needed box.
    const Box3 around = needed.grownBy(2.0 * band + 2.0 * bake_options.voxel_size);
    bake_options.box.reset();
    if (around.contains(bounds.lo) && around.contains(bounds.hi)) return;
    bake_options.box = around.intersectedWith(bounds.grownBy(2.0 * band));
  }

  bool isFastEnough(const Part& part, const Box3& domain, HybridPart& out) {
    if (options_.parts != Parts::kAuto) return false;
    // If the solid has faces, contact asks one face, not the solid.
    const FieldStructure structure = part.field->structure();
    const Field& felt = structure.operands.empty() ? *part.field : *structure.operands.front();
    out.analytic_ns = queryNanoseconds(felt, domain);
    out.grid_ns = gridNanoseconds();
    return out.analytic_ns < kWorthIt * out.grid_ns;
  }

  /// Certifies what contact relies on in a grid.
  [[nodiscard]] LevelSet sure(const LevelSet& grid) const {
    CertifyOptions certify;
    certify.sampler = options_.sampler;
    certify.is_foreign = false;
    return certified(grid, certify, progress_).grid;
  }

  /// Time of a query of any grid with such voxels, measured on a small ball.
  double gridNanoseconds() {
    if (grid_ns_ == 0.0) {
      BakeOptions bake_options = options_.bake;
      bake_options.box.reset();
      const FieldPtr ball = sphere(Vec3(0.0), 12.0 * bake_options.voxel_size);
      const FieldPtr made = gridField(bake(*ball, bake_options), options_.sampler);
      grid_ns_ = queryNanoseconds(*made, ball->bounds());
    }
    return grid_ns_;
  }

  void makeGrid(Part& part, HybridPart& out) {
    BakeOptions bake_options = options_.bake;
    if (!part.name.empty()) {
      bake_options.name += "/" + part.name;
      bake_options.metadata["part"] = part.name;
    }
    if (part.is_placed) bake_options.metadata["frame"] = "part";
    if (options_.tolerance > 0.0)
      bake_options.metadata[kTolerance] = shortNumber(options_.tolerance, 17);
    setBox(bake_options, part.needed, part.field->bounds());
    LevelSet grid;
    try {
      grid = sure(bake(*part.field, bake_options, named(part)));
    } catch (const Error& error) {
      const std::string& code = error.problem().code;
      if (code != "bake.too_thin" && code != "bake.empty" && code != "vdb.uncertified") throw;
      out.reason = "stays analytic: " + error.problem().message;
      return;
    }
    FieldPtr made = gridField(grid, options_.sampler, part.within, options_.bake.max_memory);
    const GridError error =
        gridError(*part.field, grid, *made,
                  part.needed.grownBy(bake_options.voxel_size).intersectedWith(part.within));
    out.off = error.off;
    out.turn = error.turn / kDegree;
    const GridError limit = allowed(bake_options.voxel_size);
    if (error.off > limit.off || error.turn > limit.turn) {
      out.reason = "stays analytic: a grid is off by up to " + errorText(error) + ", worst near " +
                   eachInMillimeters(error.where, 3);
      return;
    }
    out.reason = "is a grid, off by at most " + errorText(error);
    if (options_.parts == Parts::kAuto) {
      out.reason += ": a query takes " + inNanoseconds(out.grid_ns) + " instead of " +
                    inNanoseconds(out.analytic_ns);
    }
    out.grid = std::move(grid);
    part.made = std::move(made);
  }

  [[nodiscard]] GridError allowed(double voxel_size) const {
    GridError limit = smoothGridError(options_.sampler, voxel_size);
    if (options_.tolerance > 0.0) limit.off = options_.tolerance;
    return limit;
  }

  [[nodiscard]] Progress named(const Part& part) const {
    return part.name.empty() ? progress_ : namedProgress(progress_, "part " + part.name);
  }

  /// The tree with grids in place of parts; a subtree without changes is the same object as before.
  FieldPtr rebuilt(const FieldPtr& field) {
    const auto known = made_.find(field.get());
    if (known != made_.end()) return known->second;
    const FieldStructure structure = field->structure();
    FieldPtr out = field;
    if (structure.kind != Kind::kLeaf && structure.kind != Kind::kFaces) {
      std::vector<FieldPtr> operands;
      bool is_changed = false;
      for (const FieldPtr& operand : structure.operands) {
        operands.push_back(rebuilt(operand));
        is_changed = is_changed || operands.back() != operand;
      }
      if (is_changed) out = combined(structure, std::move(operands));
    }
    made_.emplace(field.get(), out);
    return out;
  }

  static FieldPtr combined(const FieldStructure& structure, std::vector<FieldPtr> operands) {
    switch (structure.kind) {
      case Kind::kUnion:
        return unite(std::move(operands));
      case Kind::kIntersection:
        return intersect(std::move(operands));
      case Kind::kTransform:
        return place(std::move(operands.front()), structure.pose);
      case Kind::kComplement:
      case Kind::kFaces:
      case Kind::kLeaf:
        break;
    }
    return complement(std::move(operands.front()));
  }

  FieldPtr root_;
  HybridOptions options_;
  const Progress& progress_;
  double grid_ns_ = 0.0;  // 0: not measured yet
  std::vector<Part> parts_;
  std::unordered_map<const Field*, std::size_t> index_;  // into parts_
  std::unordered_set<const Field*> kept_;
  std::unordered_map<const Field*, FieldPtr> made_;  // the replacement of each field of the tree
};

}  // namespace

Hybrid bakeHybrid(const FieldPtr& field, const HybridOptions& options, const Progress& progress) {
  if (!field) throw inputError("bake.null_field", "there is no field to bake");
  HybridBaker baker(field, options, progress);
  return options.parts == Parts::kWhole ? baker.runWhole() : baker.run();
}

FieldPtr recombined(const FieldPtr& field, const std::map<std::string, LevelSet>& grids,
                    Sampler sampler, const Box3& within, std::uint64_t max_memory) {
  if (!field) throw inputError("bake.null_field", "there is no field to put grids into");
  HybridOptions options;
  options.sampler = sampler;
  options.within = within;
  options.bake.max_memory = max_memory;
  const Progress silent;
  return HybridBaker(field, options, silent).runOn(grids);
}

}  // namespace palpate::vdb
