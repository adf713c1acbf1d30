// Messages about places that a grid has lost.
#include <algorithm>

#include "bake/lost_plates.h"
#include "palpate/vdb/text.h"

namespace palpate::vdb {
namespace {

std::string textOf(const LostPlace& place) {
  return inMillimeters(place.thickness) + " thin near " + eachInMillimeters(place.where);
}

}  // namespace

void LostPlaces::add(const LostPlaces& others) {
  places_.insert(places_.end(), others.places_.begin(), others.places_.end());
}

void LostPlaces::refusePlates(const BakePlan& plan, const BakeOptions& options) const {
  const LostPlace* first = nullptr;
  double thinnest = kInfinity;
  for (const LostPlace& place : places_) {
    if (place.shape != LostShape::kPlate) continue;
    if (first == nullptr) first = &place;
    thinnest = std::min(thinnest, place.thickness);
  }
  if (first == nullptr) return;
  throw inputError("bake.too_thin",
                   "'" + options.name + "' is " + textOf(*first) +
                       " and would have holes in a grid of " + inMillimeters(plan.voxel) +
                       " voxels",
                   "a voxel of " + inMillimeters(thinnest / kHeld) +
                       " holds it; or keep this part analytic, or make it a sheet");
}

std::string LostPlaces::wiresAndCrumbs(const BakePlan& plan) const {
  std::vector<LostPlace> wires;
  std::vector<LostPlace> crumbs;
  for (const LostPlace& place : places_) {
    if (place.shape == LostShape::kPlate) continue;
    std::vector<LostPlace>& found = place.shape == LostShape::kWire ? wires : crumbs;
    // Seen from several leaves, it is still one place.
    const auto same = std::find_if(found.begin(), found.end(), [&](const LostPlace& other) {
      return glm::distance(other.where, place.where) < kGoesOn * plan.voxel;
    });
    if (same == found.end()) {
      found.push_back(place);
    } else if (place.thickness > same->thickness) {
      *same = place;
    }
  }
  const auto thickest = [&](const std::vector<LostPlace>& found) {
    return textOf(*std::max_element(
        found.begin(), found.end(),
        [](const LostPlace& a, const LostPlace& b) { return a.thickness < b.thickness; }));
  };
  std::string text;
  // A long wire is found at several places, so that the number of wires is not known.
  if (!wires.empty()) text = "wires, the thickest " + thickest(wires);
  if (crumbs.empty()) return text;
  if (!text.empty()) text += "; ";
  return text + std::to_string(crumbs.size()) +
         (crumbs.size() == 1 ? " separate part, " : " separate parts, the thickest ") +
         thickest(crumbs);
}

}  // namespace palpate::vdb
