#include "palpate/vdb/hybrid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <unordered_map>
#include <utility>

#include "bake/grid_error.h"
#include "bake/query_cost.h"
#include "named_progress.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/fields/transform.h"

namespace palpate::vdb {
namespace {

using Kind = FieldStructure::Kind;

constexpr double kDegree = std::numbers::pi / 180.0;
/// A grid must be that many times as fast as what it stands for: it costs memory and an error.
constexpr double kWorthIt = 1.5;

std::string text(const char* format, double value) {
  std::array<char, 64> out{};
  std::snprintf(out.data(), out.size(), format, value);
  return out.data();
}

std::string millimetres(double metres) { return text("%.3g mm", metres * 1e3); }

/// What a sampler reaches where the surface bends over some four voxels or more; an edge is off by far more.
struct Usual {
  double off;   // [voxels]
  double turn;  // [rad]
};
constexpr Usual usual(Sampler sampler) {
  return sampler == Sampler::kCubic ? Usual{0.02, 1.0 * kDegree} : Usual{0.1, 10.0 * kDegree};
}

HybridOptions checked(HybridOptions options) {
  if (!(options.tolerance >= 0.0)) {
    throw inputError("bake.tolerance", "the tolerance is " + millimetres(options.tolerance) +
                                           "; it must be 0 or more");
  }
  if (options.sampler == Sampler::kCubic) {
    options.bake.half_width = std::max(options.bake.half_width, kCubicHalfWidth);
  }
  return options;
}

std::string errorText(const GridError& error) {
  return millimetres(error.off) + " and " + text("%.2g degree", error.turn / kDegree);
}

std::string placeText(const Vec3& p) {
  return "(" + millimetres(p.x) + ", " + millimetres(p.y) + ", " + millimetres(p.z) + ")";
}

Pose inverse(const Pose& pose) {
  const Mat3 back = glm::transpose(pose.rotation);
  return {back, -(back * pose.translation)};
}

/// Knows its distance near its surface only: a grid, or something made of one.
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
    collect(root_, root_->bounds(), "");
    Hybrid out;
    for (Part& part : parts_) {
      out.parts.push_back(decide(part));
      if (part.made) made_.emplace(part.field.get(), part.made);
    }
    out.field = rebuilt(root_);
    return out;
  }

  /// One grid of everything.
  Hybrid runWhole() {
    const LevelSet grid = bake(*root_, options_.bake, progress_);
    Hybrid out;
    out.field = gridField(grid, options_.sampler);
    const GridError error = gridError(*root_, grid, *out.field, root_->bounds());
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
    Box3 needed;    ///< [m] in its frame: where its surface can be one of the whole's
    FieldPtr made;  ///< the grid that takes its place; null: none does
  };

  static FieldPtr cutOff(FieldPtr field, const BakeOptions& bake) {
    if (!bake.box || !bake.box->isBounded()) return field;
    const Box3 bounds = field->bounds();
    if (bake.box->contains(bounds.lo) && bake.box->contains(bounds.hi)) return field;
    return intersect({palpate::box(bake.box->center(), bake.box->size()), std::move(field)});
  }

  void collect(const FieldPtr& field, const Box3& needed, const std::string& name) {
    const FieldStructure structure = field->structure();
    switch (structure.kind) {
      case Kind::kUnion:
      case Kind::kIntersection:
        for (std::size_t i = 0; i < structure.operands.size(); ++i) {
          collect(structure.operands[i], needed,
                  (name.empty() ? "" : name + ".") + std::to_string(i + 1));
        }
        return;
      case Kind::kComplement:
        collect(structure.operands.front(), needed, name);
        return;
      case Kind::kTransform:
        collect(structure.operands.front(), inverse(structure.pose).apply(needed), name);
        return;
      case Kind::kFaces:
      case Kind::kLeaf:
        break;
    }
    const auto [known, is_new] = index_.emplace(field.get(), parts_.size());
    if (is_new) {
      parts_.push_back({field, name, needed, nullptr});
    } else {
      Box3& all = parts_[known->second].needed;
      all = all.unitedWith(needed);
    }
  }

  HybridPart decide(Part& part) {
    HybridPart out;
    out.name = part.name;
    const Field& field = *part.field;
    const FieldStructure structure = field.structure();
    const Box3 domain = field.bounds().intersectedWith(part.needed);
    if (structure.operands.size() > 1) {
      out.reason = "stays analytic: it has edges, which no grid holds";
    } else if (hasBand(field)) {
      out.reason = "stays as it is: it is a grid already";
    } else if (domain.isEmpty()) {
      out.reason = "stays analytic: it does not reach into the whole";
    } else if (!domain.isBounded()) {
      out.reason = "stays analytic: it is endless, and nothing around it bounds it";
    } else if (options_.parts == Parts::kOperands && field.metric() == Metric::kExact) {
      out.reason = "stays analytic: it is exact";
    } else if (isFastEnough(part, domain, out)) {
      out.reason = "stays analytic: a query takes " + text("%.0f ns", out.analytic_ns) +
                   ", of a grid " + text("%.0f ns", out.grid_ns);
    } else {
      makeGrid(part, out);
    }
    return out;
  }

  bool isFastEnough(const Part& part, const Box3& domain, HybridPart& out) {
    if (options_.parts != Parts::kAuto) return false;
    // Contact asks the face of a solid that has one.
    const FieldStructure structure = part.field->structure();
    const Field& felt = structure.operands.empty() ? *part.field : *structure.operands.front();
    out.analytic_ns = queryNanoseconds(felt, domain);
    out.grid_ns = gridNanoseconds();
    return out.analytic_ns < kWorthIt * out.grid_ns;
  }

  /// Of any grid with such voxels: a small ball's.
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
    if (!part.name.empty()) bake_options.name += "/" + part.name;
    const double band = bake_options.half_width * bake_options.voxel_size;
    // Twice the band around what is needed: the cuts are then out of the band there.
    const Box3 needed = part.needed.grownBy(2.0 * band + 2.0 * bake_options.voxel_size);
    const Box3 bounds = part.field->bounds();
    bake_options.box.reset();
    if (!needed.contains(bounds.lo) || !needed.contains(bounds.hi)) {
      bake_options.box = needed.intersectedWith(bounds.grownBy(2.0 * band));
    }
    LevelSet grid;
    try {
      grid = bake(*part.field, bake_options, named(part));
    } catch (const Error& error) {
      const std::string& code = error.problem().code;
      if (code != "bake.too_thin" && code != "bake.empty") throw;
      out.reason = "stays analytic: " + error.problem().message;
      return;
    }
    FieldPtr made = gridField(grid, options_.sampler);
    const GridError error =
        gridError(*part.field, grid, *made, part.needed.grownBy(bake_options.voxel_size));
    out.off = error.off;
    out.turn = error.turn / kDegree;
    const Usual limit = usual(options_.sampler);
    const double tolerance =
        options_.tolerance > 0.0 ? options_.tolerance : limit.off * bake_options.voxel_size;
    if (error.off > tolerance || error.turn > limit.turn) {
      out.reason = "stays analytic: a grid is off by up to " + errorText(error) + ", worst near " +
                   placeText(error.where);
      return;
    }
    out.reason = "is a grid, off by at most " + errorText(error);
    if (options_.parts == Parts::kAuto) {
      out.reason += ": a query takes " + text("%.0f ns", out.grid_ns) + " instead of " +
                    text("%.0f ns", out.analytic_ns);
    }
    out.grid = std::move(grid);
    part.made = std::move(made);
  }

  [[nodiscard]] Progress named(const Part& part) const {
    return part.name.empty() ? progress_ : namedProgress(progress_, "part " + part.name);
  }

  /// The tree with grids in the place of parts; what did not change is the same object.
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
  std::unordered_map<const Field*, FieldPtr> made_;      // what each field of the tree came to be
};

}  // namespace

Hybrid bakeHybrid(const FieldPtr& field, const HybridOptions& options, const Progress& progress) {
  if (!field) throw inputError("bake.null_field", "there is no field to bake");
  HybridBaker baker(field, options, progress);
  return options.parts == Parts::kWhole ? baker.runWhole() : baker.run();
}

}  // namespace palpate::vdb
