#include "palpate/render/contrast.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "palpate/contact/contact_patch.h"
#include "palpate/contact/planes.h"

namespace palpate {
namespace {

constexpr int kLines = 192;
constexpr int kSteps = 256;  // samples along a line
constexpr int kHalvings = 24;
/// A step over which the relative change of the map is larger than this is halved.
constexpr double kMuch = 0.05;
/// If there are no bounds, the lines extend this many units of the scene to each side.
constexpr double kUnits = 100.0;
constexpr int kDoublings = 5;

struct Steepest {
  double length = kInfinity;  // [m]
  Vec3 at{0.0, 0.0, 0.0};
  Vec3 way{0.0, 0.0, 0.0};
};

/// Looks at the step from `a` to `b`, halving it towards the part with most of its change.
void lookAt(const MaterialMap& map, Vec3 a, Vec3 b, Steepest& out) {
  double from = map.value(a);
  double to = map.value(b);
  for (int i = 0; i < kHalvings; ++i) {
    const double change = std::fabs(std::log(to / from));
    if (change > 0.0 && glm::length(b - a) < out.length * change) {
      out = {glm::length(b - a) / change, 0.5 * (a + b), unitOr(b - a, Vec3(0.0))};
    }
    if (!(change > kMuch)) return;
    const Vec3 middle = 0.5 * (a + b);
    const double half = map.value(middle);
    const bool is_first = std::fabs(std::log(half / from)) > 0.5 * change;
    (is_first ? b : a) = middle;
    (is_first ? to : from) = half;
  }
}

Steepest steepestOf(const MaterialMap& map, const Box3& box) {
  Steepest out;
  std::mt19937_64 engine(1);
  std::uniform_real_distribution<double> share(0.0, 1.0);
  const auto within = [&] {
    const Vec3 t(share(engine), share(engine), share(engine));
    return box.lo + t * box.size();
  };
  for (int line = 0; line < kLines; ++line) {
    Vec3 from = within();
    Vec3 to = within();
    if (line % 4 != 3) {
      // A line along an axis, from side to side.
      const int axis = line % 4;
      to = from;
      from[axis] = box.lo[axis];
      to[axis] = box.hi[axis];
    }
    Vec3 last = from;
    for (int i = 1; i <= kSteps; ++i) {
      const Vec3 next = from + (static_cast<double>(i) / kSteps) * (to - from);
      lookAt(map, last, next, out);
      last = next;
    }
  }
  return out;
}

double sidewaysOf(const Parameter& stiffness, const Steepest& steepest) {
  double most = 0.0;
  Vec3 t1(0.0);
  Vec3 t2(0.0);
  tangentsOf(steepest.way, t1, t2);
  double depth = steepest.length;
  for (int i = 0; i <= kDoublings; ++i, depth *= 2.0) {
    for (const Vec3& along : {t1, t2}) {
      const PatchSample s = overPatch(stiffness, steepest.at, depth * along, steepest.length);
      const Vec3 rise = s.by_place - glm::dot(s.by_place, along) * along;
      most = std::max(most, 0.5 * depth * glm::length(rise) / s.value);
    }
  }
  return most;
}

}  // namespace

std::vector<Contrast> contrastsOf(const Scene& scene) {
  std::vector<Contrast> out;
  Box3 box = scene.bounds();
  if (!box.isBounded()) {
    const Vec3 half(kUnits * scene.metersPerUnit());
    box = {-half, half};
  }
  for (std::size_t i = 0; i < scene.materials().size(); ++i) {
    const Parameter& stiffness = scene.materials()[i].stiffness;
    if (stiffness.isConstant() || !(stiffness.range().least > 0.0)) continue;
    const Steepest steepest = steepestOf(*stiffness.map(), box);
    if (!std::isfinite(steepest.length)) continue;
    out.push_back(
        {static_cast<int>(i), steepest.at, steepest.length, sidewaysOf(stiffness, steepest)});
  }
  return out;
}

}  // namespace palpate
