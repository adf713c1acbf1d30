#include "picture/cutaway.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <deque>
#include <numbers>

#include "picture/palette.h"
#include "picture/parallel_rows.h"

namespace palpate::tools {
namespace {

constexpr double kYaw = 35.0 * std::numbers::pi / 180.0;
constexpr double kPitch = 24.0 * std::numbers::pi / 180.0;
constexpr int kTrial = 64;  // [pixels] size of the first, coarse picture
constexpr double kEdgeShade = 0.4;
constexpr int kBlock = 8;  // [pixels] side of a block whose rays share the march through free space
constexpr int kBand = 32 * kBlock;         // [rows] that are drawn together ...
constexpr int kHeld = kBand + 2 * kBlock;  // ... and traced, with their neighbors
// Difference of neighboring pixels above which a pixel gets finer rays
constexpr double kContrast = 0.1;

double differenceOf(const Color& a, const Color& b) {
  return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b)});
}

/// Casts rays through the pixels' centers, and finer ones where needed. It works band by band, so
/// that only the picture itself takes memory that grows with the height.
class Drawing {
 public:
  Drawing(const SpaceScene& space, const Camera& camera)
      : width_(camera.width),
        height_(camera.height),
        columns_((camera.width + kBlock - 1) / kBlock),
        hits_(static_cast<std::size_t>(width_) * kHeld),
        free_(static_cast<std::size_t>(columns_) * (kHeld / kBlock)) {
    for (std::size_t i = 0; i < workerCount(); ++i) marches_.emplace_back(space, camera);
  }

  Raster draw(const Progress& progress) {
    Raster raster(width_, height_);
    for (int top = 0; top < height_; top += kBand) {
      const int end = std::min(top + kBand, height_);
      first_ = std::max(0, top - kBlock);
      const int last = std::min(end + kBlock, height_);
      const Progress part = [&](std::string_view what, double share) {
        return !progress || progress(what, (top + share * (end - top)) / height_);
      };
      parallelRows((last - first_ + kBlock - 1) / kBlock, part, "shading the scene",
                   [&](int row, std::size_t worker) {
                     blocks(first_ + row * kBlock, last, marches_[worker]);
                   });
      parallelRows(end - top, part, "shading the scene", [&](int row, std::size_t worker) {
        const int y = top + row;
        for (int x = 0; x < width_; ++x) raster.set(x, y, finished(x, y, marches_[worker]));
      });
    }
    return raster;
  }

 private:
  [[nodiscard]] Hit& hit(int x, int y) {
    return hits_[static_cast<std::size_t>(x) +
                 static_cast<std::size_t>(width_) * static_cast<std::size_t>(y - first_)];
  }
  [[nodiscard]] double& freeAt(int x, int y) {
    return free_[static_cast<std::size_t>(x / kBlock) +
                 static_cast<std::size_t>(columns_) *
                     static_cast<std::size_t>((y - first_) / kBlock)];
  }

  /// Traces a row of blocks from `top` on, but no pixel from `end` on.
  void blocks(int top, int end, RayMarch& march) {
    const double radius = 0.5 * kBlock * std::numbers::sqrt2;
    for (int left = 0; left < width_; left += kBlock) {
      const double free = march.freeWay(left + 0.5 * kBlock, top + 0.5 * kBlock, radius);
      freeAt(left, top) = free;
      for (int y = top; y < std::min(top + kBlock, end); ++y) {
        for (int x = left; x < std::min(left + kBlock, width_); ++x) {
          hit(x, y) = march.cast(x + 0.5, y + 0.5, free);
        }
      }
    }
  }

  Color finished(int x, int y, RayMarch& march) {
    const Hit& here = hit(x, y);
    bool is_edge = false;
    bool is_rough = false;
    const auto look = [&](int nx, int ny) {
      if (nx < 0 || ny < 0 || nx >= width_ || ny >= height_) return;
      const Hit& there = hit(nx, ny);
      is_edge = is_edge || there.isApartFrom(here);
      is_rough = is_rough || differenceOf(there.color, here.color) > kContrast;
    };
    look(x - 1, y);
    look(x + 1, y);
    look(x, y - 1);
    look(x, y + 1);
    if (!is_edge && !is_rough) return here.color;
    Color sum{0.0, 0.0, 0.0, 1.0};
    for (int i = 0; i < 4; ++i) {
      const Hit fine =
          march.cast(x + (i % 2 == 0 ? 0.25 : 0.75), y + (i < 2 ? 0.25 : 0.75), freeAt(x, y));
      const bool is_thing = fine.part != -1 && is_edge;
      const Color color =
          is_thing ? mixed(fine.color, kWallInk, kEdgeShade * fine.opacity) : fine.color;
      sum.r += 0.25 * color.r;
      sum.g += 0.25 * color.g;
      sum.b += 0.25 * color.b;
    }
    return sum;
  }

  int width_, height_, columns_;
  int first_ = 0;  ///< first row in hits_, a multiple of kBlock
  std::vector<Hit> hits_;
  std::vector<double> free_;
  std::deque<RayMarch> marches_;
};

}  // namespace

Camera cameraOn(const CutPlane& plane) {
  return cameraFrom(
      std::cos(kPitch) * (std::cos(kYaw) * plane.normal() + std::sin(kYaw) * plane.right) +
          std::sin(kPitch) * plane.up,
      plane.up);
}

void fitCamera(Camera& camera, const SpaceScene& space, const std::vector<Vec3>& points, int width,
               int height) {
  camera.center = space.box.center();
  // First, a coarse picture of everything shows how much of it is empty.
  camera.width = kTrial;
  camera.height = kTrial;
  camera.step = glm::length(space.box.size()) / kTrial;
  const Paint plain(nullptr, space.scene, {});
  const SpaceScene trial{space.scene, plain, space.box, space.plane, space.opacity};
  RayMarch march(trial, camera);
  double left = kInfinity, right = -kInfinity, low = kInfinity, high = -kInfinity;
  const auto include = [&](double x, double y, double margin) {
    left = std::min(left, x - margin);
    right = std::max(right, x + margin);
    low = std::min(low, y - margin);
    high = std::max(high, y + margin);
  };
  for (int y = 0; y < kTrial; ++y) {
    for (int x = 0; x < kTrial; ++x) {
      if (march.cast(x + 0.5, y + 0.5).part == -1) continue;
      include((x + 0.5 - 0.5 * kTrial) * camera.step, (0.5 * kTrial - y - 0.5) * camera.step,
              camera.step);
    }
  }
  for (const Vec3& p : points) {
    include(glm::dot(p - camera.center, camera.right), glm::dot(p - camera.center, camera.up), 0.0);
  }
  if (left < right && low < high) {
    camera.center += 0.5 * (left + right) * camera.right + 0.5 * (low + high) * camera.up;
    camera.step = 1.04 * std::max((right - left) / width, (high - low) / height);
  } else {
    camera.step *= static_cast<double>(kTrial) / std::min(width, height);
  }
  camera.width = width;
  camera.height = height;
}

Raster drawSpace(const SpaceScene& space, const Camera& camera, const Progress& progress) {
  return Drawing(space, camera).draw(progress);
}

}  // namespace palpate::tools
