#include "bench/path.h"

#include <algorithm>
#include <cmath>

namespace palpate::tools {

void PathMaker::go(const Vec3& target, double speed) {
  const Vec3 from = at();
  const auto ticks =
      static_cast<int>(std::ceil(glm::length(target - from) / (speed * kTickSeconds)));
  for (int i = 1; i <= ticks; ++i) {
    points_.push_back(from + (static_cast<double>(i) / ticks) * (target - from));
  }
}

void PathMaker::follow(const Curve& curve, double from, double to, double speed) {
  go(curve(from), speed);
  const double step = speed * kTickSeconds;
  double s = from;
  double stride = 1e-3;  // of the parameter; a first guess, corrected at once
  while (s < to) {
    // Find the stride that moves by `step`: a few secant steps from the last one.
    for (int i = 0; i < 8; ++i) {
      const double gone = glm::length(curve(s + stride) - at());
      if (std::fabs(gone - step) < 1e-3 * step) break;
      stride *= gone > 0.0 ? std::clamp(step / gone, 0.1, 10.0) : 10.0;
    }
    s += stride;
    points_.push_back(curve(s));
  }
}

void PathMaker::play(const Curve& curve, double from, double to, double stride) {
  const auto ticks = static_cast<int>(std::floor((to - from) / stride));
  for (int i = 0; i <= ticks; ++i) points_.push_back(curve(from + i * stride));
}

Vec3 windingDirection(double s) noexcept {
  const Vec3 u(std::cos(s), std::sin(s) * std::cos(0.5), std::sin(s) * std::sin(0.5));
  return rotationAbout(Vec3(0.0, 0.0, 1.0), s / 20.0) * u;
}

}  // namespace palpate::tools
