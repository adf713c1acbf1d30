#include "scan/lattice_spline.h"

#include <algorithm>
#include <cmath>

#include "brick/brick_field.h"
#include "palpate/vdb/openvdb_access.h"

namespace palpate::vdb {
namespace {

using openvdb::Coord;
using Leaf = openvdb::FloatTree::LeafNodeType;

constexpr int kNewtonSteps = 12;
// [steps of the shortest axis] longest Newton step.
constexpr double kLongest = 0.5;
constexpr double kEnough = 1e-6;
/// After a Newton step the remaining error is about the square of the step.
constexpr double kEnoughByNewton = 1e-3;
constexpr double kLeastBent = 1e-3;
/// Number of mirrored layers beyond the border that a spline at the surface depends on.
constexpr int kMirrored = 4;

/// Some vector perpendicular to `v`.
Vec3 across(const Vec3& v) noexcept {
  const Vec3 size = glm::abs(v);
  const bool by_x = size.x <= size.y && size.x <= size.z;
  return by_x               ? Vec3(0.0, v.z, -v.y)
         : size.y <= size.z ? Vec3(-v.z, 0.0, v.x)
                            : Vec3(v.y, -v.x, 0.0);
}

/// Places along one axis where a voxel counts: itself, and its mirror images beyond the borders.
struct Images {
  std::array<int, 3> at{};
  int count = 1;

  Images(int i, int n) : at{i} {
    if (i < kMirrored) at[static_cast<std::size_t>(count++)] = -1 - i;
    if (n - 1 - i < kMirrored) at[static_cast<std::size_t>(count++)] = 2 * n - 1 - i;
  }
};

/// The value of a voxel; NaN: not in the band. An open band's shape ends at the border.
float valueOf(const Band& band, const Mask& mask, const BandBlock& block, std::size_t n) noexcept {
  const float value = block.value[n];
  if (!band.is_open) return value;
  const auto place = static_cast<int>(n);
  const std::array<int, 3> at = {block.first[0] + (place >> 6), block.first[1] + (place >> 3 & 7),
                                 block.first[2] + (place & 7)};
  for (std::size_t a = 0; a < 3; ++a) {
    if (at[a] >= band.box[a]) return value;
  }
  if (mask.inside[static_cast<std::size_t>(mask.at(at[0], at[1], at[2]))] == 0) return value;
  return band.closed(value, at);
}

void mirror(const Band& band, const Mask& mask, openvdb::FloatGrid& grid) {
  auto accessor = grid.getAccessor();
  for (const BandBlock& block : band.blocks) {
    bool by_border = false;
    for (std::size_t a = 0; a < 3; ++a) {
      by_border = by_border || block.first[a] < kMirrored ||
                  block.first[a] + BandBlock::kSide > band.box[a] - kMirrored;
    }
    if (!by_border) continue;
    for (std::size_t n = 0; n < BandBlock::kVoxels; ++n) {
      const float value = valueOf(band, mask, block, n);
      if (std::isnan(value)) continue;
      const auto place = static_cast<int>(n);
      const Images x(block.first[0] + (place >> 6), band.box[0]);
      const Images y(block.first[1] + (place >> 3 & 7), band.box[1]);
      const Images z(block.first[2] + (place & 7), band.box[2]);
      for (int i = 0; i < x.count; ++i) {
        for (int j = 0; j < y.count; ++j) {
          for (int k = 0; k < z.count; ++k) {
            if (i + j + k == 0) continue;
            accessor.setValueOn(
                Coord(x.at[static_cast<std::size_t>(i)], y.at[static_cast<std::size_t>(j)],
                      z.at[static_cast<std::size_t>(k)]),
                std::fabs(value));
          }
        }
      }
    }
  }
}

/// The band as a level set with voxels 1 m wide, so that positions equal box indices.
LevelSet gridOf(const Band& band, const Mask& mask) {
  float largest = 1.0F;
  for (const BandBlock& block : band.blocks) {
    for (const float value : block.value) {
      if (!std::isnan(value)) largest = std::max(largest, std::fabs(value));
    }
  }
  const float background = 2.0F * largest;
  initializeOpenVdb();
  auto grid = openvdb::FloatGrid::create(background);
  grid->setTransform(openvdb::math::Transform::createLinearTransform(1.0));
  for (const BandBlock& block : band.blocks) {
    const auto [x, y, z] = block.first;
    auto leaf = std::make_unique<Leaf>(Coord(x, y, z), background, false);
    for (openvdb::Index n = 0; n < BandBlock::kVoxels; ++n) {
      const float value = valueOf(band, mask, block, n);
      if (!std::isnan(value)) {
        leaf->setValueOn(n, value);
        continue;
      }
      const Coord at = leaf->offsetToGlobalCoord(n);
      const bool in_box = at.x() < band.box[0] && at.y() < band.box[1] && at.z() < band.box[2];
      if (in_box && mask.inside[static_cast<std::size_t>(mask.at(at.x(), at.y(), at.z()))] != 0) {
        leaf->setValueOff(n, -background);
      }
    }
    grid->tree().addLeaf(leaf.release());
  }
  mirror(band, mask, *grid);
  return makeLevelSet(grid, "m");
}

}  // namespace

LatticeSpline::LatticeSpline(const Band& band, const Mask& mask, const Mat3& axes,
                             const Vec3& origin)
    : spline_(std::make_unique<BrickField>(gridOf(band, mask), Sampler::kCubic)),
      axes_(axes),
      to_index_(glm::inverse(axes)),
      metric_(glm::transpose(axes) * axes),
      inverse_metric_(to_index_ * glm::transpose(to_index_)),
      metric_size_(glm::determinant(metric_)),
      origin_(origin),
      shortest_(std::min({glm::length(axes[0]), glm::length(axes[1]), glm::length(axes[2])})) {}

LatticeSpline::~LatticeSpline() = default;

std::optional<double> LatticeSpline::valueAt(const Vec3& index) const noexcept {
  const FieldSample sample = spline_->sample(index);
  if (!sample.in_band) return std::nullopt;
  return sample.value;
}

Vec3 LatticeSpline::slopeAt(const Vec3& index) const noexcept {
  const FieldSample sample = spline_->sample(index);
  return sample.in_band ? sample.gradient : Vec3(0.0);
}

std::optional<LatticeSpline::Foot> LatticeSpline::foot(const Vec3& p,
                                                       const Vec3& start) const noexcept {
  // Everything is computed in index space: the axes enter through their metric alone.
  const Vec3 target = to_index_ * (p - origin_);
  Vec3 q = to_index_ * (start - origin_);
  for (int step = 0; step < kNewtonSteps; ++step) {
    const FieldJet jet = spline_->jet(q);
    if (!jet.in_band) return std::nullopt;
    const Vec3 gradient = jet.gradient;
    const Vec3 uphill = inverse_metric_ * gradient;
    const double square = glm::dot(gradient, uphill);
    if (!(square > 0.0)) return std::nullopt;
    const Vec3 apart = target - q;
    const double side = glm::dot(apart, gradient);
    const double m = side / square;
    // Solve towards the surface and in its tangent plane; how S curves across the surface does not
    // matter.
    const Vec3 down = (-jet.value / square) * uphill;
    const Mat3 bent = metric_ + m * jet.hessian;
    const Vec3 u = across(gradient);
    const Vec3 v = glm::cross(gradient, u);
    const Vec3 bent_u = bent * u;
    const Vec3 bent_v = bent * v;
    const double uu = glm::dot(u, bent_u);
    const double uv = glm::dot(u, bent_v);
    const double vv = glm::dot(v, bent_v);
    const double size = uu * vv - uv * uv;
    // Determinant without curvature, from the metric alone:
    const double flat = metric_size_ * square * glm::dot(u, u) * glm::dot(u, u);
    // Beyond a center of curvature the matrix is indefinite; there the step goes to the point on
    // the tangent plane.
    Vec3 move = apart - m * uphill + down;
    double enough = kEnough;
    if (uu > 0.0 && size > kLeastBent * flat) {
      const Vec3 pull = metric_ * apart - bent * down;
      const double a = glm::dot(u, pull);
      const double b = glm::dot(v, pull);
      move = down + ((vv * a - uv * b) / size) * u + ((uu * b - uv * a) / size) * v;
      enough = kEnoughByNewton;
    }
    const double length = std::sqrt(glm::dot(move, metric_ * move));
    if (!std::isfinite(length)) return std::nullopt;
    if (length < enough * shortest_) {
      const Vec3 point = axes_ * (q + move) + origin_;
      const double distance = glm::length(p - point);
      return Foot{point, glm::normalize(glm::transpose(to_index_) * gradient),
                  side < 0.0 ? -distance : distance};
    }
    q += move * std::min(1.0, kLongest * shortest_ / length);
  }
  return std::nullopt;
}

}  // namespace palpate::vdb
