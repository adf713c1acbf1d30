#include "picture/distance_lines.h"

#include <algorithm>
#include <cmath>

#include "palpate/core/error.h"
#include "text.h"

namespace palpate::tools {
namespace {

constexpr double kWidth = 1.3;   // [pixels]
constexpr double kFaint = 0.4;   // ink of a line ...
constexpr double kDark = 0.8;    // ... and of every fifth
constexpr double kFewest = 3.0;  // least number of pixels from line to line
// Slope below which the plane is parallel to the surface, so that no lines are drawn
constexpr double kFlat = 0.05;

}  // namespace

void DistanceLines::check(double pixel) const {
  if (spacing_ >= kFewest * pixel) return;
  throw Error(ErrorKind::kUsage,
              {"usage.render", "--iso: lines as close as that would merge in this picture",
               "at least " + formatNumber(kFewest * pixel / scene_.metersPerUnit(), 2) + " " +
                   scene_.lengthUnit()});
}

double DistanceLines::inkAt(const Vec3& p, const Vec3& normal, double pixel) const {
  double distance = kInfinity;
  Vec3 away(0.0);
  for (const Region& region : scene_.regions()) {
    if (!region.field || region.field->bounds().distanceTo(p) >= distance) continue;
    const FieldSample sample = region.field->sample(p);
    const double slope = glm::length(sample.gradient);
    // Beyond the band of a grid only a bound of the distance is known, and this bound may still be
    // the least of all regions.
    const double value = std::abs(sample.value) / (slope > 0.0 ? slope : 1.0);
    if (value >= distance) continue;
    distance = value;
    away = slope > 0.0 ? sample.gradient / slope : Vec3(0.0);
  }
  const double slope = glm::length(away - glm::dot(away, normal) * normal);
  if (!std::isfinite(distance) || slope < kFlat) return 0.0;
  const double line = std::round(distance / spacing_);
  if (line < 1.0) return 0.0;
  const double off = std::abs(distance - line * spacing_) / (slope * pixel);
  const double ink = std::fmod(line, 5.0) == 0.0 ? kDark : kFaint;
  return ink * std::clamp(0.5 + 0.5 * kWidth - off, 0.0, 1.0);
}

}  // namespace palpate::tools
