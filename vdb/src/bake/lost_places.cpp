// What is said about places that a grid has lost.
#include <algorithm>

#include "bake/lost_plates.h"

namespace palpate::vdb {

void LostPlaces::add(const LostPlaces& others) {
  places_.insert(places_.end(), others.places_.begin(), others.places_.end());
}

void LostPlaces::refuse(const BakePlan& plan, const BakeOptions& options) const {
  const LostPlace* first = nullptr;
  double thinnest = kInfinity;
  for (const LostPlace& place : places_) {
    if (place.shape == LostShape::kCrumb) continue;
    if (first == nullptr) first = &place;
    thinnest = std::min(thinnest, place.thickness);
  }
  if (first == nullptr) return;
  const std::string thin = inMillimetres(first->thickness) + " thin near " +
                           placeText(first->where / plan.voxel, plan.voxel);
  const std::string grid = "a grid of " + inMillimetres(plan.voxel) + " voxels";
  const std::string held = "a voxel of " + inMillimetres(thinnest / kHeld) +
                           " holds it; or keep this part analytic, or ";
  if (first->shape == LostShape::kPlate) {
    throw inputError("bake.too_thin",
                     "'" + options.name + "' is " + thin + " and would have holes in " + grid,
                     held + "make it a sheet");
  }
  throw inputError("bake.too_thin",
                   "'" + options.name + "' has a wire " + thin + ", which would be broken in " + grid,
                   held + "take it out");
}

std::string LostPlaces::crumbs(const BakePlan& plan) const {
  std::vector<LostPlace> found;
  for (const LostPlace& place : places_) {
    if (place.shape != LostShape::kCrumb) continue;
    // Seen from several leaves, it is still one.
    const auto same = std::find_if(found.begin(), found.end(), [&](const LostPlace& other) {
      return glm::distance(other.where, place.where) < kGoesOn * plan.voxel;
    });
    if (same == found.end()) {
      found.push_back(place);
    } else if (place.thickness > same->thickness) {
      *same = place;
    }
  }
  if (found.empty()) return {};
  const auto thickest = std::max_element(
      found.begin(), found.end(),
      [](const LostPlace& a, const LostPlace& b) { return a.thickness < b.thickness; });
  return std::to_string(found.size()) +
         (found.size() == 1 ? " separate part" : " separate parts, the thickest") + " of " +
         inMillimetres(thickest->thickness) + " near " +
         placeText(thickest->where / plan.voxel, plan.voxel);
}

}  // namespace palpate::vdb
