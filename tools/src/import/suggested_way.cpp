#include "import/suggested_way.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <optional>

namespace palpate::tools {
namespace {

constexpr double kBefore = 0.02;  // [m] of the box
constexpr double kInto = 1e-3;    // [m] into what is rigid: 2 N at most, as walls go to 2000 N/m

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
  explicit WayFinder(const ImportedScan& scan) : scan_(scan), to_index_(inverse(scan.labels)) {
    for (const PlannedRegion& region : scan.plan.regions) {
      for (const int label : region.labels) tissue_of_[label] = region.tissue;
    }
    for (std::size_t r = 0; r < scan.survey.outside(); ++r) {
      const Box3& bounds = scan.survey.regions[r].bounds;
      if (bounds.isEmpty()) continue;
      box_.include(bounds.lo);
      box_.include(bounds.hi);
    }
    // Whole millimeters read well.
    for (int axis = 0; axis < 3; ++axis)
      middle_[axis] = std::round(box_.center()[axis] * 1e3) * 1e-3;
    step_ = 0.5 * std::cbrt(std::abs(glm::determinant(scan.labels.axes)));
  }

  SuggestedWay find() const {
    SuggestedWay best;
    double longest = -1.0;
    for (const Side& side : kSides) {
      const Vec3 half = 0.5 * (box_.hi - box_.lo);
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
  static Mat3 inverse(const vdb::Image& image) { return glm::inverse(image.axes); }

  struct Walk {
    double end;    // [m] from where it begins
    double depth;  // [m] of it that is in tissue
  };

  Walk walk(const Vec3& from, const Vec3& way, double reach) const {
    std::optional<double> first;
    const auto steps = static_cast<int>(std::ceil(reach / step_));
    for (int n = 0; n < steps; ++n) {
      const double s = n * step_;
      const std::optional<std::array<int, 3>> voxel = voxelAt(from + s * way);
      if (!voxel) continue;
      const Tissue* tissue = tissueAt(*voxel);
      if (tissue == nullptr) continue;
      // Where the image ends there is a closed wall.
      if (!first && isAtBorder(*voxel)) return {s + kInto, 0.0};
      if (!first) first = s;
      if (tissue->kind == TissueClass::kRigid) return {std::min(s + kInto, reach), s - *first};
    }
    return {reach, first ? reach - *first : 0.0};
  }

  std::optional<std::array<int, 3>> voxelAt(const Vec3& world) const {
    const Vec3 index = to_index_ * (world - scan_.labels.origin);
    std::array<int, 3> voxel{};
    for (int axis = 0; axis < 3; ++axis) {
      const auto a = static_cast<std::size_t>(axis);
      const double nearest = std::round(index[axis]);
      if (!(nearest >= 0.0 && nearest < scan_.labels.size[a])) return std::nullopt;
      voxel[a] = static_cast<int>(nearest);
    }
    return voxel;
  }

  bool isAtBorder(const std::array<int, 3>& voxel) const {
    for (std::size_t a = 0; a < 3; ++a) {
      if (voxel[a] == 0 || voxel[a] + 1 == scan_.labels.size[a]) return true;
    }
    return false;
  }

  const Tissue* tissueAt(const std::array<int, 3>& voxel) const {
    const auto at =
        tissue_of_.find(static_cast<int>(scan_.labels.at(voxel[0], voxel[1], voxel[2])));
    return at == tissue_of_.end() ? nullptr : at->second;
  }

  const ImportedScan& scan_;
  Mat3 to_index_;
  std::map<int, const Tissue*> tissue_of_;
  Box3 box_;
  Vec3 middle_{0.0};
  double step_ = 1e-3;
};

}  // namespace

SuggestedWay suggestedWay(const ImportedScan& scan) { return WayFinder(scan).find(); }

}  // namespace palpate::tools
