#include <algorithm>
#include <cmath>

#include "picture/palette.h"
#include "picture/sheet.h"

namespace palpate::tools {
namespace {

constexpr double kLongest = 1.5;  // share of the arrows' spacing

}  // namespace

void feelPlane(Sheet& s, const Box3& box, const Progress& progress) {
  if (s.options.forces <= 0) return;
  s.felt = restForces(s.scene, s.plane, box, s.options.forces, progress);
  s.felt_spacing = restSpacing(s.plane, box, s.options.forces);
}

void drawFelt(Sheet& s, const std::function<Pixel(const Vec3&)>& at, double step) {
  double most = 0.0;
  for (const RestForce& f : s.felt) most = std::max(most, glm::length(f.force));
  if (!(most > 0.0)) return;
  const double spacing = s.felt_spacing / step;
  // A dot marks every force, also one too short for an arrow, so that a small force is not mistaken
  // for none.
  const double dot = std::min(s.px(2.2), 0.12 * spacing);
  for (const RestForce& f : s.felt) {
    const Pixel from = at(f.at);
    const Pixel to = at(f.at + (kLongest * s.felt_spacing / most) * f.force);
    const double length = std::hypot(to.x - from.x, to.y - from.y);
    const double head = std::min({s.px(8), 0.35 * spacing, 0.5 * length});
    s.canvas.disk(from, dot, kForceInk);
    if (length > 2.0 * dot) s.canvas.arrow(from, to, {kForceInk, s.px(1.4)}, head);
  }
}

}  // namespace palpate::tools
