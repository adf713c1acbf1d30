#include "bake/lost_plates.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kDepths = 4;

/// Whether a shape may have parts thinner than `length`: what solids of such a feature size are united from has none.
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
  Search(const Field& field, const LevelSet& grid, const BakePlan& plan,
         const std::optional<Box3>& box)
      : field_(field), grid_(gridField(grid, Sampler::kAccessor)), plan_(plan), box_(box) {}

  [[nodiscard]] LostPlates in(const Leaf& leaf) const noexcept {
    LostPlates lost;
    const auto near = static_cast<float>(kBySurface * plan_.voxel / plan_.metres_per_unit);
    for (auto voxel = leaf.cbeginValueOn(); voxel; ++voxel) {
      if (std::fabs(*voxel) >= near) continue;
      const openvdb::Coord at = voxel.getCoord();
      look(Vec3(at.x(), at.y(), at.z()) * plan_.voxel, lost);
    }
    return lost;
  }

 private:
  /// From a point by the surface: down to it, and on through the shape.
  void look(const Vec3& p, LostPlates& lost) const noexcept {
    const FieldSample here = field_.sample(p);
    const double slope = glm::length(here.gradient);
    if (!here.in_band || !(slope > 0.0)) return;
    const Vec3 in = -here.gradient / slope;
    const Vec3 foot = p + here.value / slope * in;
    double inside = 0.0;
    double outside = 0.0;
    for (int i = 1; i <= kDepths && outside == 0.0; ++i) {
      const double depth = kHeld * i / kDepths * plan_.voxel;
      (field_.value(foot + depth * in) < 0.0 ? inside : outside) = depth;
    }
    if (outside == 0.0) return;  // thick
    for (int i = 0; i < 12; ++i) {
      const double middle = 0.5 * (inside + outside);
      (field_.value(foot + middle * in) < 0.0 ? inside : outside) = middle;
    }
    const Vec3 middle = foot + 0.5 * inside * in;
    if (!(inside > 0.0) || grid_->value(middle) < 0.0 || !goesOn(middle, in)) return;
    if (box_ && !box_->contains(middle)) return;
    lost.add(middle, inside);
  }

  [[nodiscard]] bool goesOn(const Vec3& middle, const Vec3& normal) const noexcept {
    const Vec3 across = std::fabs(normal.x) < 0.6 ? Vec3(1.0, 0.0, 0.0) : Vec3(0.0, 1.0, 0.0);
    const Vec3 u = glm::normalize(glm::cross(normal, across));
    const Vec3 v = glm::cross(normal, u);
    const double far = kGoesOn * plan_.voxel;
    return field_.value(middle + far * u) < 0.0 && field_.value(middle - far * u) < 0.0 &&
           field_.value(middle + far * v) < 0.0 && field_.value(middle - far * v) < 0.0;
  }

  const Field& field_;
  FieldPtr grid_;
  const BakePlan& plan_;
  const std::optional<Box3>& box_;
};

}  // namespace

void LostPlates::add(const Vec3& place, double thickness) { add({1, place, thickness}); }

void LostPlates::add(const LostPlates& others) {
  if (others.places == 0) return;
  if (places == 0) {
    *this = others;
    return;
  }
  places += others.places;
  thinnest = std::min(thinnest, others.thinnest);
}

void LostPlates::refuse(const BakePlan& plan, const BakeOptions& options) const {
  if (places == 0) return;
  throw inputError("bake.too_thin",
                   "'" + options.name + "' is " + inMillimetres(thinnest) + " thin near " +
                       placeText(where / plan.voxel, plan.voxel) +
                       " and would have holes in a grid of " + inMillimetres(plan.voxel) +
                       " voxels",
                   "a voxel of " + inMillimetres(thinnest / kHeld) +
                       " holds it; or keep this part analytic, or make it a sheet");
}

void refuseLostPlates(const Field& field, const LevelSet& grid, const BakePlan& plan,
                      const BakeOptions& options) {
  if (!mayBeThin(field, kHeld * plan.voxel)) return;
  std::vector<const Leaf*> leaves;
  grid.impl().grid->tree().getNodes(leaves);
  std::vector<LostPlates> found(leaves.size());
  const Search search(field, grid, plan, options.box);
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, leaves.size()),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t i = range.begin(); i != range.end(); ++i) {
                        found[i] = search.in(*leaves[i]);
                      }
                    });
  LostPlates all;
  for (const LostPlates& lost : found) all.add(lost);
  all.refuse(plan, options);
}

}  // namespace palpate::vdb
