#pragma once
// Shapes as bare formulas, for testing the oracle and the closed forms.

#include <cmath>
#include <numbers>
#include <random>
#include <vector>

#include "support/function_field.h"
#include "support/oracle/feasible_set.h"

namespace palpate::oracle {

using testing::functionField;

class Random {
 public:
  double real(double lo, double hi) {
    return std::uniform_real_distribution<double>(lo, hi)(engine_);
  }
  Vec3 inCube(double half) { return {real(-half, half), real(-half, half), real(-half, half)}; }
  Vec3 unit() {
    while (true) {
      const Vec3 v = inCube(1.0);
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

 private:
  std::mt19937 engine_{11};
};

inline double radians(double degrees) { return degrees * std::numbers::pi / 180.0; }

inline FieldPtr ballField(const Vec3& center, double radius) {
  return functionField([=](const Vec3& p) { return glm::length(p - center) - radius; }, radius);
}

/// Negative behind `normal` (unit).
inline FieldPtr planeField(const Vec3& point, const Vec3& normal, double feature) {
  return functionField([=](const Vec3& p) { return glm::dot(p - point, normal); }, feature);
}

inline FieldPtr rodField(const Vec3& center, const Vec3& axis, double radius) {
  return functionField(
      [=](const Vec3& p) {
        const Vec3 d = p - center;
        return glm::length(d - glm::dot(d, axis) * axis) - radius;
      },
      radius);
}

inline FieldPtr torusField(const Vec3& center, const Vec3& axis, double major, double minor) {
  return functionField(
      [=](const Vec3& p) {
        const double up = glm::dot(p - center, axis);
        const double flat = glm::length(p - center - up * axis) - major;
        return std::hypot(flat, up) - minor;
      },
      minor);
}

/// Not a distance: the length of its gradient on the surface varies from 2 / largest to 2 /
/// smallest radius.
inline FieldPtr ellipsoidField(const Vec3& radii, double feature) {
  return functionField(
      [=](const Vec3& p) {
        const Vec3 q = p / radii;
        return glm::dot(q, q) - 1.0;
      },
      feature);
}

/// The inside of a box as six planes.
inline FeasibleSet roomSet(const Vec3& lo, const Vec3& hi) {
  std::vector<FeasibleSet> sides;
  for (int i = 0; i < 3; ++i) {
    Vec3 normal(0.0);
    normal[i] = 1.0;
    sides.push_back(FeasibleSet::inside(planeField(hi, normal, (hi - lo)[i])));
    sides.push_back(FeasibleSet::inside(planeField(lo, -normal, (hi - lo)[i])));
  }
  return FeasibleSet::allOf(sides);
}

/// The outside of a box as six planes.
inline FeasibleSet aroundBoxSet(const Vec3& lo, const Vec3& hi) {
  std::vector<FeasibleSet> sides;
  for (int i = 0; i < 3; ++i) {
    Vec3 normal(0.0);
    normal[i] = 1.0;
    sides.push_back(FeasibleSet::outside(planeField(hi, normal, (hi - lo)[i])));
    sides.push_back(FeasibleSet::outside(planeField(lo, -normal, (hi - lo)[i])));
  }
  return FeasibleSet::anyOf(sides);
}

}  // namespace palpate::oracle
