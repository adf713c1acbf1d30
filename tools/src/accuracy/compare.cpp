#include "accuracy/compare.h"

#include <cmath>

namespace palpate::tools {
namespace {

constexpr double kDegrees = 57.29577951308232;

/// Uses sine and cosine together, so that small angles keep their digits.
double degreesBetween(const Vec3& a, const Vec3& b) noexcept {
  return kDegrees * std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

}  // namespace

Errors errorsAt(const Field& field, std::span<const JudgedPoint> points, bool smooth,
                ValueIs value_is) {
  Errors out;
  SpreadMeter value;
  SpreadMeter normal;
  SpreadMeter curvature;
  for (const JudgedPoint& point : points) {
    if (point.smooth != smooth) continue;
    const FieldJet jet = field.jet(point.at);
    if (!jet.in_band) {
      ++out.out_of_band;
      continue;
    }
    ++out.points;
    const double slope = value_is == ValueIs::kOverSlope ? glm::length(jet.gradient) : 1.0;
    value.add(jet.value / slope - point.truth.value);
    normal.add(degreesBetween(jet.gradient, point.truth.normal));
    curvature.add(meanCurvature(jet) - point.truth.curvature);
  }
  out.value = value.spread();
  out.normal = normal.spread();
  out.curvature = curvature.spread();
  return out;
}

Jitter jitterOf(const Field& field, std::span<const Stroke> strokes) {
  Jitter out;
  SpreadMeter found;
  SpreadMeter truth;
  for (const Stroke& stroke : strokes) {
    const auto& points = stroke.points;
    std::vector<std::optional<Vec3>> normals(points.size());
    for (std::size_t i = 0; i < points.size(); ++i) {
      const FieldSample s = field.sample(points[i].at);
      const double slope = glm::length(s.gradient);
      if (points[i].smooth && s.in_band && slope > 0.0) normals[i] = s.gradient / slope;
    }
    for (std::size_t i = 1; i + 1 < points.size(); ++i) {
      if (!normals[i - 1] || !normals[i] || !normals[i + 1]) continue;
      ++out.points;
      found.add(glm::length(*normals[i + 1] - 2.0 * *normals[i] + *normals[i - 1]));
      truth.add(glm::length(points[i + 1].truth.normal - 2.0 * points[i].truth.normal +
                            points[i - 1].truth.normal));
    }
  }
  out.field = found.spread();
  out.truth = truth.spread();
  return out;
}

std::optional<double> fittedOrder(std::span<const double> h, std::span<const double> error) {
  const auto n = static_cast<double>(h.size());
  double x = 0.0;
  double y = 0.0;
  double xx = 0.0;
  double xy = 0.0;
  for (std::size_t i = 0; i < h.size(); ++i) {
    if (!(error[i] > 0.0)) return std::nullopt;
    const double a = std::log(h[i]);
    const double b = std::log(error[i]);
    x += a;
    y += b;
    xx += a * a;
    xy += a * b;
  }
  const double spread = n * xx - x * x;
  if (h.size() < 2 || !(spread > 1e-12)) return std::nullopt;
  return (n * xy - x * y) / spread;
}

}  // namespace palpate::tools
