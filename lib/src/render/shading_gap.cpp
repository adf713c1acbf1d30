#include "palpate/render/shading_gap.h"

#include <algorithm>
#include <random>

#include "palpate/interior/port_machine.h"

namespace palpate {
namespace {

/// Relative to the radius: no node of the smoothed field that counts is further from the surface
/// (contact/felt_height.h).
constexpr double kLooks = 1.5;
constexpr int kLines = 48;
constexpr int kSteps = 128;  // samples along a line
constexpr int kHalvings = 40;
constexpr int kShares = 16;  // samples over the needed distance
constexpr int kShareHalvings = 8;

/// The widest shading of the walls on either side of the layer's surface; -1: there is none.
int shadedMaterial(const Scene& scene, RegionId region) {
  int out = -1;
  double most = 0.0;
  const auto look = [&](const Wall& wall) {
    if (wall.absent || wall.material < 0) return;
    const double own = scene.materials()[static_cast<std::size_t>(wall.material)].shading;
    if (!(own > most)) return;
    most = own;
    out = wall.material;
  };
  for (std::size_t i = 0; i < region; ++i) {
    const auto other = static_cast<RegionId>(i);
    if (!scene.touches(other, region)) continue;
    look(scene.passages().wall(other, region));
    look(scene.passages().wall(region, other));
  }
  return out;
}

/// [m] The distance from its surface at `p` up to which the field answers on both sides; at most
/// `needed`.
double knownAt(const Field& field, const Vec3& p, double needed) {
  const Vec3 n = unitOr(field.sample(p).gradient, Vec3(0.0));
  const auto answers = [&](double away) {
    return field.sample(p + away * n).in_band && field.sample(p - away * n).in_band;
  };
  for (int i = 1; i <= kShares; ++i) {
    double above = needed * i / kShares;
    if (answers(above)) continue;
    double known = needed * (i - 1) / kShares;
    for (int k = 0; k < kShareHalvings; ++k) {
      const double middle = 0.5 * (known + above);
      (answers(middle) ? known : above) = middle;
    }
    return known;
  }
  return needed;
}

void lookAlong(const Field& field, const Vec3& from, const Vec3& to, ShadingGap& out) {
  Vec3 last = from;
  bool was_inside = field.value(from) < 0.0;
  for (int i = 1; i <= kSteps; ++i) {
    const Vec3 next = glm::mix(from, to, static_cast<double>(i) / kSteps);
    const bool is_inside = field.value(next) < 0.0;
    if (is_inside != was_inside) {
      Vec3 a = last;
      Vec3 b = next;
      for (int k = 0; k < kHalvings; ++k) {
        const Vec3 middle = 0.5 * (a + b);
        ((field.value(middle) < 0.0) == was_inside ? a : b) = middle;
      }
      const double known = knownAt(field, a, out.needed);
      if (known < out.known) {
        out.known = known;
        out.at = a;
      }
    }
    was_inside = is_inside;
    last = next;
  }
}

}  // namespace

std::vector<ShadingGap> shadingGaps(const Scene& scene) {
  std::vector<ShadingGap> all;
  for (std::size_t i = 1; i < scene.regions().size(); ++i) {
    const auto region = static_cast<RegionId>(i);
    const FieldPtr& field = scene.regions()[region].field;
    const int material = field ? shadedMaterial(scene, region) : -1;
    if (material < 0 || !field->bounds().isBounded()) continue;
    ShadingGap gap;
    gap.material = material;
    gap.region = region;
    gap.needed = kLooks * scene.materials()[static_cast<std::size_t>(material)].shading;
    gap.known = gap.needed;
    const Box3 box = field->bounds();
    std::mt19937_64 engine(1);
    std::uniform_real_distribution<double> share(0.0, 1.0);
    for (int line = 0; line < kLines; ++line) {
      const Vec3 t(share(engine), share(engine), share(engine));
      Vec3 from = box.lo + t * box.size();
      Vec3 to = from;
      const int axis = line % 3;
      // Begin slightly outside the box, so that its faces are met too.
      from[axis] = box.lo[axis] - 0.01 * box.size()[axis];
      to[axis] = box.hi[axis] + 0.01 * box.size()[axis];
      lookAlong(*field, from, to, gap);
    }
    if (gap.known < gap.needed) all.push_back(gap);
  }
  return all;
}

}  // namespace palpate
