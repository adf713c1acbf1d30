#include "import/suggested_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

#include "import/region_sampler.h"

namespace palpate::tools {
namespace {

constexpr double kBefore = 0.02;  // [m] in front of the box
constexpr double kInto = 1e-3;    // [m] into rigid tissue: 2 N at most, as walls go up to 2000 N/m

struct Side {
  const char* name;
  Vec3 outwards;
};
const std::array<Side, 6> kSides = {{{"front", {0, 1, 0}},
                                     {"left", {-1, 0, 0}},
                                     {"right", {1, 0, 0}},
                                     {"back", {0, -1, 0}},
                                     {"head", {0, 0, 1}},
                                     {"feet", {0, 0, -1}}}};

class WayFinder {
 public:
  explicit WayFinder(const ImportedScan& scan) : scan_(scan), sampler_(scan) {
    // Whole millimeters are easier to read.
    for (int axis = 0; axis < 3; ++axis)
      middle_[axis] = std::round(sampler_.box().center()[axis] * 1e3) * 1e-3;
    step_ = 0.5 * std::cbrt(std::abs(glm::determinant(scan.labels.axes)));
  }

  SuggestedWay find() const {
    SuggestedWay best;
    double longest = -1.0;
    for (const Side& side : kSides) {
      const Vec3 half = 0.5 * (sampler_.box().hi - sampler_.box().lo);
      const double reach = std::abs(glm::dot(half, side.outwards)) + kBefore;
      const double whole = std::round(reach * 1e3) * 1e-3;
      const Vec3 from = middle_ + whole * side.outwards;
      const auto [end, depth] = walk(from, -side.outwards, whole);
      if (depth <= longest + 1e-9) continue;
      longest = depth;
      const bool is_short = end < whole;
      best = {std::string("from the ") + side.name +
                  (is_short ? " to the first wall that stays closed" : " to the middle"),
              from, from - end * side.outwards};
    }
    return best;
  }

 private:
  struct Walk {
    double end;    // [m] from its beginning
    double depth;  // [m] length of its part in tissue
  };

  Walk walk(const Vec3& from, const Vec3& way, double reach) const {
    std::optional<double> first;
    const auto steps = static_cast<int>(std::ceil(reach / step_));
    for (int n = 0; n < steps; ++n) {
      const double s = n * step_;
      const RegionSampler::Sample here = sampler_.at(from + s * way);
      if (here.region >= scan_.survey.gap()) continue;  // no label
      const Tissue* const tissue = scan_.plan.regions[here.region].tissue;
      // The image ends in a closed wall.
      if (!first && here.is_at_border) return {s + kInto, 0.0};
      if (!first) first = s;
      if (tissue->kind == TissueClass::kRigid) return {std::min(s + kInto, reach), s - *first};
    }
    return {reach, first ? reach - *first : 0.0};
  }

  const ImportedScan& scan_;
  RegionSampler sampler_;
  Vec3 middle_{0.0};
  double step_ = 1e-3;
};

}  // namespace

SuggestedWay suggestedWay(const ImportedScan& scan) { return WayFinder(scan).find(); }

}  // namespace palpate::tools
