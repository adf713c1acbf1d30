#include "bake/lost_plates.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "bake/field_parts.h"
#include "bake/lost_wires.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kDepths = 4;

/// Whether a shape may have parts thinner than `length`. A union of solids whose feature size is
/// larger has none.
bool mayBeThin(const Field& field, double length) {
  const FieldStructure structure = field.structure();
  switch (structure.kind) {
    case FieldStructure::Kind::kLeaf:
    case FieldStructure::Kind::kFaces:
      return field.featureSize() < length;
    case FieldStructure::Kind::kUnion:
    case FieldStructure::Kind::kTransform:
      return std::any_of(structure.operands.begin(), structure.operands.end(),
                         [&](const FieldPtr& f) { return mayBeThin(*f, length); });
    case FieldStructure::Kind::kIntersection:
    case FieldStructure::Kind::kComplement:
      break;
  }
  return true;
}

class Search {
 public:
  Search(const Field& field, const BakePlan& plan, const std::optional<Box3>& box)
      : parts_(field),
        has_distances_(field.metric() != Metric::kImplicit),
        plan_(plan),
        box_(box) {}

  /// From now on, parts that this grid holds do not count as lost.
  void lookInto(const LevelSet& grid) { grid_ = gridField(grid, Sampler::kAccessor); }

  [[nodiscard]] LostPlaces in(const Leaf& leaf) const {
    // Keep the operands that decide the value at all points that are looked at from this leaf;
    // without distances, these points may be anywhere.
    constexpr double kReach = 0.5 * 1.7320508075688774 * 7.0 + kBySurface + kHeld + kGoesOn + 0.1;
    const openvdb::Coord first = leaf.origin();
    const Vec3 center = (Vec3(first.x(), first.y(), first.z()) + Vec3(3.5)) * plan_.voxel;
    FieldPart part;
    const double radius = has_distances_ ? kReach * plan_.voxel : kInfinity;
    static_cast<void>(parts_.narrow(parts_.whole(), center, radius, kInfinity, part));
    LostPlaces lost;
    const double held = kHeld * plan_.voxel;
    if (parts_.isUnionOf(part, [&](const Field& field) { return !mayBeThin(field, held); })) {
      return lost;
    }
    // Voxels outside the band are farther off.
    const auto near = static_cast<float>(kBySurface * plan_.voxel / plan_.meters_per_unit);
    const float* const values = leaf.buffer().data();
    for (openvdb::Index n = 0; n < Leaf::SIZE; ++n) {
      if (std::fabs(values[n]) >= near) continue;
      const openvdb::Coord at = leaf.offsetToGlobalCoord(n);
      look(part, Vec3(at.x(), at.y(), at.z()) * plan_.voxel, lost);
    }
    return lost;
  }

 private:
  /// Searches from a point beside the surface down to the surface, and on through the shape.
  void look(const FieldPart& part, const Vec3& p, LostPlaces& lost) const noexcept {
    const FieldSample here = parts_.sample(part, p);
    const double slope = glm::length(here.gradient);
    if (!here.in_band || !(slope > 0.0)) return;
    const Vec3 in = -here.gradient / slope;
    const Vec3 foot = p + here.value / slope * in;
    // A ball inside the shape that contains all the depths below.
    constexpr double kBall = 0.5 * (1.0 - 1.0 / kDepths) * kHeld;
    const double ball = kBall * plan_.voxel;
    if (has_distances_ &&
        parts_.value(part, foot + (kHeld * plan_.voxel - ball) * in) < -ball * (1.0 + 1e-9)) {
      return;
    }
    double inside = 0.0;
    double outside = 0.0;
    for (int i = 1; i <= kDepths && outside == 0.0; ++i) {
      const double depth = kHeld * i / kDepths * plan_.voxel;
      (parts_.value(part, foot + depth * in) < 0.0 ? inside : outside) = depth;
    }
    if (outside == 0.0) return;  // thick enough
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (inside + outside);
      (parts_.value(part, foot + middle * in) < 0.0 ? inside : outside) = middle;
    }
    const Vec3 middle = foot + 0.5 * inside * in;
    if (!(inside > 0.0) || (grid_ && grid_->value(middle) < 0.0)) return;
    if (box_ && !box_->contains(middle)) return;
    if (goesOn(part, middle, in)) {
      lost.add({middle, inside, LostShape::kPlate});
    } else if (lost.empty()) {
      const Thin solid(*this, inside);
      if (const auto shape = ThinPart(solid).lostAt(middle / plan_.voxel, in)) {
        lost.add({middle, inside, *shape});
      }
    }
  }

  [[nodiscard]] bool goesOn(const FieldPart& part, const Vec3& middle,
                            const Vec3& normal) const noexcept {
    const Vec3 across = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(normal, across));
    const Vec3 v = glm::cross(normal, u);
    const double far = kGoesOn * plan_.voxel;
    const auto is_inside = [&](const Vec3& p) { return parts_.value(part, p) < 0.0; };
    return is_inside(middle + far * u) && is_inside(middle - far * u) &&
           is_inside(middle + far * v) && is_inside(middle - far * v);
  }

  /// Answers ThinPart's questions about the field; all lengths in voxels.
  class Thin {
   public:
    Thin(const Search& search, double thickness)
        : search_(search),
          least_step_(std::clamp(0.25 * thickness / search.plan_.voxel, 0.01, 0.1)) {}

    [[nodiscard]] double wayOut(const Vec3& from, const Vec3& along) const noexcept {
      constexpr double kFar = 2.0 * kGoesOn;
      double inside = 0.0;
      double outside = 0.0;
      while (outside == 0.0) {
        const double here = valueAt(from + inside * along);
        const double step = search_.has_distances_ ? std::max(least_step_, -here) : least_step_;
        const double next = inside + step;
        if (valueAt(from + next * along) < 0.0) {
          if (next >= kFar) return kInfinity;
          inside = next;
        } else {
          outside = next;
        }
      }
      for (int i = 0; i < 12; ++i) {
        const double middle = 0.5 * (inside + outside);
        (valueAt(from + middle * along) < 0.0 ? inside : outside) = middle;
      }
      return inside;
    }
    [[nodiscard]] bool isInside(const Vec3& p) const noexcept { return valueAt(p) < 0.0; }
    [[nodiscard]] bool isHeld(const Vec3& p) const noexcept {
      return search_.grid_ && search_.grid_->value(p * search_.plan_.voxel) < 0.0;
    }

   private:
    [[nodiscard]] double valueAt(const Vec3& p) const noexcept {
      const FieldParts& parts = search_.parts_;
      return parts.value(parts.whole(), p * search_.plan_.voxel) / search_.plan_.voxel;
    }

    const Search& search_;
    double least_step_;
  };

  FieldParts parts_;
  bool has_distances_;
  FieldPtr grid_;  ///< null: as if it held nothing
  const BakePlan& plan_;
  const std::optional<Box3>& box_;
};

}  // namespace

std::string refuseLostPlates(const Field& field, const LevelSet& grid, const BakePlan& plan,
                             const BakeOptions& options) {
  if (!mayBeThin(field, kHeld * plan.voxel)) return {};
  std::vector<const Leaf*> leaves;
  grid.impl().grid->tree().getNodes(leaves);
  Search search(field, plan, options.box);
  const auto search_all = [&] {
    std::vector<LostPlaces> found(leaves.size());
    tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()),
                      [&](const tbb::blocked_range<std::size_t>& range) {
                        for (std::size_t i = range.begin(); i != range.end(); ++i) {
                          found[i] = search.in(*leaves[i]);
                        }
                      });
    return found;
  };
  // A field of the grid is made only if something is thin.
  std::vector<LostPlaces> found = search_all();
  std::vector<const Leaf*> thin;
  for (std::size_t i = 0; i < leaves.size(); ++i) {
    if (!found[i].empty()) thin.push_back(leaves[i]);
  }
  if (thin.empty()) return {};
  leaves = std::move(thin);
  search.lookInto(grid);
  found = search_all();
  LostPlaces all;
  for (const LostPlaces& lost : found) all.add(lost);
  all.refusePlates(plan, options);
  return all.wiresAndCrumbs(plan);
}

}  // namespace palpate::vdb
