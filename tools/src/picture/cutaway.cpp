#include "picture/cutaway.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <numbers>
#include <optional>

#include "palpate/interior/port_machine.h"
#include "picture/palette.h"
#include "picture/parallel_rows.h"
#include "picture/section.h"

namespace palpate::tools {
namespace {

constexpr double kYaw = 35.0 * std::numbers::pi / 180.0;
constexpr double kPitch = 24.0 * std::numbers::pi / 180.0;
constexpr double kAmbient = 0.42;
constexpr double kFaceShade = 0.97;
constexpr int kMostSteps = 4000;
constexpr int kFiner = 2;   // rays a pixel, along each side
constexpr int kTrial = 64;  // [pixels] of the first look
constexpr double kEdgeShade = 0.45;
constexpr double kSheetInk = 0.25;  // share of ink in what belongs to no region
constexpr int kFirstSheet =
    -2;  // part of a hit on the first sheet; those of the others go down from it

/// The part of a ray within a box, as distances along it.
std::optional<std::pair<double, double>> within(const Box3& box, const Vec3& origin,
                                                const Vec3& way) {
  double enter = -kInfinity;
  double leave = kInfinity;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(way[i]) < 1e-12) {
      if (origin[i] < box.lo[i] || origin[i] > box.hi[i]) return {};
      continue;
    }
    const double a = (box.lo[i] - origin[i]) / way[i];
    const double b = (box.hi[i] - origin[i]) / way[i];
    enter = std::max(enter, std::min(a, b));
    leave = std::min(leave, std::max(a, b));
  }
  if (!(enter < leave)) return {};
  return std::pair{enter, leave};
}

/// What a ray met. Neighbors with different `part` are set apart by a dark edge, and so are those of the cut face
/// between which it cuts a sheet.
struct Hit {
  Color color = rgb(0xFFFFFF);
  int part = -1;          ///< region and whether it is the cut face; -1: nothing; below: a sheet
  SheetSides sides = {};  ///< of the cut face

  [[nodiscard]] bool isApartFrom(const Hit& other) const {
    return part != other.part || sides.crossedTo(other.sides) != 0;
  }
};

/// One ray after the other through the scene; owns the scratch.
class Marcher {
 public:
  Marcher(const Scene& scene, const CutPlane& plane, const Box3& box, const Camera& camera,
          const Paint& paint)
      : scene_(scene),
        plane_(plane),
        box_(box),
        camera_(camera),
        paint_(paint),
        here_(scene.partition().leaves().size()),
        there_(here_),
        middle_(here_),
        light_(glm::normalize(camera.toward + 0.6 * camera.up - 0.5 * camera.right)),
        has_sheets_(!scene.passages().sheets().empty()) {
    for (const Leaf& leaf : scene.partition().leaves()) bounds_.push_back(leaf.field->bounds());
  }

  Hit cast(double x, double y) {
    const Vec3 origin = camera_.center +
                        camera_.right * ((x - 0.5 * camera_.width) * camera_.step) +
                        camera_.up * ((0.5 * camera_.height - y) * camera_.step);
    const Vec3 way = -camera_.toward;
    const auto part = within(box_, origin, way);
    if (!part) return {};
    const double facing =
        glm::dot(way, plane_.normal());  // negative: the ray runs into the kept half
    const double cut = glm::dot(plane_.point - origin, plane_.normal()) / facing;
    double t = std::max(part->first, cut);
    if (t >= part->second) return {};

    const double step = probe(origin + t * way, here_);
    const RegionId first = scene_.partition().regionOf(here_);
    if (first != kOutside) {
      const Vec3 p = origin + t * way;
      if (t == cut) {
        return {scaled(paint_.at(first, p), kFaceShade), 2 * first, sheetSides(scene_, here_)};
      }
      // The box cuts an endless layer.
      return {shaded(paint_.at(first, p), glm::dot(-way, light_)), 2 * first + 1};
    }
    before_ = t;
    t += advance(step);
    for (int i = 0; i < kMostSteps && t < part->second; ++i) {
      const double distance = probe(origin + t * way, there_);
      if (scene_.partition().regionOf(there_) != kOutside) return surface(origin, way, t);
      if (has_sheets_ && here_ != there_) {
        if (const auto hit = sheet(origin, way, t)) return *hit;
      }
      std::swap(here_, there_);
      before_ = t;
      t += advance(distance);
    }
    return {};
  }

 private:
  /// Signs at `p` and a distance [m] within which no leaf changes its sign.
  double probe(const Vec3& p, Signs& out) const {
    double safe = kInfinity;
    const auto leaves = scene_.partition().leaves();
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const double away = bounds_[i].distanceTo(p);
      if (away > 0.0) {  // outside a leaf's box it is not worth a look
        out.set(static_cast<LeafId>(i), false);
        safe = std::min(safe, away);
        continue;
      }
      const double value = leaves[i].field->value(p);
      out.set(static_cast<LeafId>(i), value < 0.0);
      safe = std::min(safe, std::abs(value) / leaves[i].lipschitz);
    }
    return safe;
  }

  [[nodiscard]] double advance(double safe) const {
    return std::max(std::isfinite(safe) ? safe : 0.0, 0.5 * camera_.step);
  }

  /// here_ is outside, there_ (at `t`) is not: the surface is in between.
  Hit surface(const Vec3& origin, const Vec3& way, double t) {
    double low = std::min(before_, t);
    double high = t;
    Signs middle = there_;
    for (int i = 0; i < 12; ++i) {
      const double half = 0.5 * (low + high);
      probe(origin + half * way, middle);
      if (scene_.partition().regionOf(middle) == kOutside) {
        low = half;
        std::swap(here_, middle);
      } else {
        high = half;
        std::swap(there_, middle);
      }
    }
    const Vec3 p = origin + high * way;
    const Boundary met = classify(scene_, here_, there_);
    const RegionId region = scene_.partition().regionOf(there_);
    Vec3 normal = -way;
    const auto leaves = scene_.partition().leaves();
    for (std::size_t i = 0; i < leaves.size(); ++i) {
      const auto leaf = static_cast<LeafId>(i);
      if (here_.inside(leaf) == there_.inside(leaf)) continue;
      const Vec3 gradient = leaves[i].field->sample(p).gradient;
      normal = unitOr(there_.inside(leaf) ? gradient : -gradient, normal);
      break;
    }
    Color base = paint_.of(region);
    if (met.kind == Boundary::Kind::kPort) base = mixed(base, kPortInk, 0.35);
    if (met.kind == Boundary::Kind::kAbsent) base = mixed(base, kPaper, 0.4);
    return {shaded(base, std::abs(glm::dot(normal, light_))), 2 * region + 1};
  }

  /// The first sheet in the list that lies between here_ and there_ (at `t`), both in the same air.
  std::optional<Hit> sheet(const Vec3& origin, const Vec3& way, double t) {
    const std::uint64_t inner = sheetSides(scene_, here_).inner;
    std::uint64_t changed = inner ^ sheetSides(scene_, there_).inner;
    for (; changed != 0; changed &= changed - 1) {
      const auto index = static_cast<std::size_t>(std::countr_zero(changed));
      const std::uint64_t bit = std::uint64_t{1} << index;
      double low = std::min(before_, t);
      double high = t;
      SheetSides beyond = sheetSides(scene_, there_);
      for (int i = 0; i < 12; ++i) {
        const double half = 0.5 * (low + high);
        probe(origin + half * way, middle_);
        const SheetSides sides = sheetSides(scene_, middle_);
        const bool is_before = ((sides.inner ^ inner) & bit) == 0;
        (is_before ? low : high) = half;
        if (!is_before) beyond = sides;
      }
      if ((beyond.extent & bit) == 0) continue;
      return Hit{shaded(mixed(kPaper, kWallInk, kSheetInk),
                        std::abs(glm::dot(sheetNormal(index, origin + high * way, -way), light_))),
                 kFirstSheet - static_cast<int>(index)};
    }
    return {};
  }

  /// Of the sheet at `p`: of the leaf whose surface is nearest there.
  [[nodiscard]] Vec3 sheetNormal(std::size_t index, const Vec3& p, const Vec3& fallback) const {
    double nearest = kInfinity;
    Vec3 normal = fallback;
    for (const LeafId leaf : scene_.passages().sheets()[index].leaves) {
      const FieldSample sample = scene_.partition().leaves()[leaf].field->sample(p);
      if (std::abs(sample.value) >= nearest) continue;
      nearest = std::abs(sample.value);
      normal = unitOr(sample.gradient, fallback);
    }
    return normal;
  }

  static Color shaded(const Color& base, double lambert) {
    return scaled(base, kAmbient + (1.0 - kAmbient) * std::clamp(lambert, 0.0, 1.0));
  }

  const Scene& scene_;
  const CutPlane& plane_;
  const Box3& box_;
  const Camera& camera_;
  const Paint& paint_;
  Signs here_, there_, middle_;
  Vec3 light_;
  std::vector<Box3> bounds_;
  bool has_sheets_;
  double before_ = 0.0;
};

}  // namespace

Camera cameraFor(const Scene& scene, const CutPlane& plane, const Box3& box,
                 const std::vector<Vec3>& points, int width, int height) {
  Camera camera;
  const Vec3 n = plane.normal();
  camera.toward =
      glm::normalize(std::cos(kPitch) * (std::cos(kYaw) * n + std::sin(kYaw) * plane.right) +
                     std::sin(kPitch) * plane.up);
  camera.right = glm::normalize(glm::cross(plane.up, camera.toward));
  camera.up = glm::cross(camera.toward, camera.right);
  camera.center = box.center();

  // A first, coarse look at everything shows how much of the picture is empty.
  camera.width = kTrial;
  camera.height = kTrial;
  camera.step = glm::length(box.size()) / kTrial;
  const Paint plain(nullptr, scene, {});
  Marcher marcher(scene, plane, box, camera, plain);
  double left = kInfinity, right = -kInfinity, low = kInfinity, high = -kInfinity;
  const auto include = [&](double x, double y, double margin) {
    left = std::min(left, x - margin);
    right = std::max(right, x + margin);
    low = std::min(low, y - margin);
    high = std::max(high, y + margin);
  };
  for (int y = 0; y < kTrial; ++y) {
    for (int x = 0; x < kTrial; ++x) {
      if (marcher.cast(x + 0.5, y + 0.5).part == -1) continue;
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
  return camera;
}

Raster drawCutaway(const Scene& scene, const CutPlane& plane, const Box3& box, const Camera& camera,
                   const Paint& paint, const Progress& progress) {
  const int width = kFiner * camera.width;
  const int height = kFiner * camera.height;
  std::vector<Hit> hits(static_cast<std::size_t>(width) * static_cast<std::size_t>(height));
  const auto hit = [&](int x, int y) -> Hit& {
    return hits[static_cast<std::size_t>(x) +
                static_cast<std::size_t>(width) * static_cast<std::size_t>(y)];
  };
  std::vector<Marcher> marchers;
  for (std::size_t i = 0; i < workerCount(); ++i) {
    marchers.emplace_back(scene, plane, box, camera, paint);
  }
  parallelRows(height, progress, "shading the scene", [&](int y, std::size_t worker) {
    for (int x = 0; x < width; ++x) {
      hit(x, y) = marchers[worker].cast((x + 0.5) / kFiner, (y + 0.5) / kFiner);
    }
  });
  Raster raster(camera.width, camera.height);
  const double share = 1.0 / (kFiner * kFiner);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Hit& here = hit(x, y);
      const bool edge = (x + 1 < width && hit(x + 1, y).isApartFrom(here)) ||
                        (y + 1 < height && hit(x, y + 1).isApartFrom(here)) ||
                        (x > 0 && hit(x - 1, y).isApartFrom(here)) ||
                        (y > 0 && hit(x, y - 1).isApartFrom(here));
      const Color color = edge ? mixed(here.color, kWallInk, kEdgeShade) : here.color;
      Color& sum = raster.at(x / kFiner, y / kFiner);
      sum.r += share * color.r;
      sum.g += share * color.g;
      sum.b += share * color.b;
    }
  }
  return raster;
}

}  // namespace palpate::tools
