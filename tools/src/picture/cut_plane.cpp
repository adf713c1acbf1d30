#include "picture/cut_plane.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "palpate/core/error.h"
#include "palpate/scene/units.h"

namespace palpate::tools {
namespace {

constexpr double kAligned = 1e-6;  // sine below which a direction is an axis

Error usageError(const char* option, std::string message) {
  return Error(ErrorKind::kUsage,
               {"usage.plane", std::string(option) + ": " + std::move(message),
                "as in " + std::string(option) +
                    (std::string_view(option) == "--cut" ? " 0,0,10,1,0,1" : " x=12")});
}

Vec3 axisVector(int axis) {
  Vec3 v{0.0};
  v[axis] = 1.0;
  return v;
}

/// The world axis that `direction` runs along (either way), or -1.
int alignedAxis(const Vec3& direction) {
  for (int i = 0; i < 3; ++i) {
    if (glm::length(glm::cross(direction, axisVector(i))) < kAligned) return i;
  }
  return -1;
}

/// Principal directions of the points about their mean: eigenvectors of the covariance by Jacobi
/// rotations, the largest spread first.
struct Spread {
  Vec3 mean{0.0};
  std::array<Vec3, 3> direction{};
  std::array<double, 3> deviation{};  ///< [m]
};

Spread spreadOf(const Track& track) {
  Spread s;
  const auto count = static_cast<double>(track.points.size());
  for (const auto& p : track.points) s.mean += p.hip / count;
  double a[3][3] = {};
  for (const auto& p : track.points) {
    const Vec3 d = p.hip - s.mean;
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) a[i][j] += d[i] * d[j] / count;
    }
  }
  double v[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  constexpr int kSweeps = 16;  // quadratic convergence: 5 or so would do
  for (int sweep = 0; sweep < kSweeps; ++sweep) {
    for (int p = 0; p < 2; ++p) {
      for (int q = p + 1; q < 3; ++q) {
        if (std::abs(a[p][q]) < 1e-300) continue;
        const double angle = 0.5 * std::atan2(2.0 * a[p][q], a[p][p] - a[q][q]);
        const double c = std::cos(angle);
        const double n = std::sin(angle);
        for (auto& row : a) {
          const double x = row[p], y = row[q];
          row[p] = c * x + n * y;
          row[q] = -n * x + c * y;
        }
        for (int k = 0; k < 3; ++k) {
          const double x = a[p][k], y = a[q][k];
          a[p][k] = c * x + n * y;
          a[q][k] = -n * x + c * y;
          const double vx = v[k][p], vy = v[k][q];
          v[k][p] = c * vx + n * vy;
          v[k][q] = -n * vx + c * vy;
        }
      }
    }
  }
  std::array<int, 3> order = {0, 1, 2};
  std::sort(order.begin(), order.end(), [&](int i, int j) { return a[i][i] > a[j][j]; });
  for (std::size_t k = 0; k < 3; ++k) {
    const int i = order[k];
    s.direction[k] = Vec3(v[0][i], v[1][i], v[2][i]);
    s.deviation[k] = std::sqrt(std::fmax(a[i][i], 0.0));
  }
  return s;
}

}  // namespace

CutPlane planeAcross(int axis, double value, const LengthUnit& unit) {
  // Right and up as in most atlases: x or y to the right, z (or y) up.
  static constexpr int kRight[] = {1, 0, 0};
  static constexpr int kUp[] = {2, 2, 1};
  CutPlane plane;
  plane.point[axis] = value;
  plane.right_axis = kRight[axis];
  plane.up_axis = kUp[axis];
  plane.right = axisVector(plane.right_axis);
  plane.up = axisVector(plane.up_axis);
  plane.name = "at " + std::string(1, "xyz"[axis]) + " = " + formatNumber(value / unit.meters) +
               " " + unit.name;
  return plane;
}

CutPlane planeThrough(const Vec3& point, const Vec3& normal, const LengthUnit& unit) {
  // Scaled first, because the square of a very long or short vector leaves the range of doubles.
  const double most = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
  const Vec3 n = glm::normalize(normal / most);
  const int axis = alignedAxis(n);
  if (axis >= 0) {
    CutPlane plane = planeAcross(axis, point[axis], unit);
    if (glm::dot(plane.normal(), n) < 0.0) {  // seen from the other side: mirror left and right
      plane.right = -plane.right;
    }
    return plane;
  }
  CutPlane plane;
  plane.point = point;
  const Vec3 wish = std::abs(n.z) < 0.9 ? Vec3(0, 0, 1) : Vec3(0, 1, 0);
  plane.up = glm::normalize(wish - glm::dot(wish, n) * n);
  plane.right = glm::cross(plane.up, n);
  plane.name = "through " + formatVector(point / unit.meters, 3) + " " + unit.name + " across " +
               formatDirection(n);
  plane.right_axis = alignedAxis(plane.right);
  plane.up_axis = alignedAxis(plane.up);
  return plane;
}

CutPlane planeAlong(const Track& track, const LengthUnit& unit) {
  constexpr double kFlat = 1e-3;  // share of the longest spread below which a spread counts as none
  const Spread s = spreadOf(track);
  if (!(s.deviation[0] > 0.0)) return planeAcross(1, s.mean.y, unit);
  Vec3 normal{0.0};
  if (s.deviation[1] > kFlat * s.deviation[0]) {
    normal = s.direction[2];
  } else {
    const Vec3 along = s.direction[0];
    int best = -1;
    for (const int axis : {1, 0, 2}) {
      if (best < 0 || std::abs(along[axis]) < std::abs(along[best]) - 1e-9) best = axis;
    }
    normal = axisVector(best) - along[best] * along;
    if (best == 1) normal = -normal;  // for a cut across y one looks along y, with x to the right
  }
  // Choose the side that the standard views look from.
  const int main_axis =
      std::abs(normal.y) >= std::abs(normal.x) && std::abs(normal.y) >= std::abs(normal.z) ? 1
      : std::abs(normal.x) >= std::abs(normal.z)                                           ? 0
                                                                                           : 2;
  const double wanted = main_axis == 1 ? -1.0 : 1.0;
  if (normal[main_axis] * wanted < 0.0) normal = -normal;
  for (int i = 0; i < 3; ++i) {
    if (std::abs(normal[i]) < 1e-9) normal[i] = 0.0;
  }
  return planeThrough(s.mean, normal, unit);
}

CutPlane parsePlane(const std::string& text, const LengthUnit& unit, const char* option) {
  const auto equals = text.find('=');
  const auto axis = std::string("xyz").find(text.substr(0, equals));
  if (equals != 1 || axis == std::string::npos) {
    throw usageError(option, "'" + text + "' is not x=VALUE, y=VALUE or z=VALUE");
  }
  return planeAcross(static_cast<int>(axis), parseLength(text.substr(2), unit, option), unit);
}

CutPlane parseCut(const std::string& text, const LengthUnit& unit) {
  const auto parts = split(text, ',');
  double numbers[6] = {};
  bool good = parts.size() == 6;
  for (std::size_t i = 0; good && i < 6; ++i) {
    const auto number = parseNumber(parts[i]);
    good = number.has_value();
    if (good) numbers[i] = *number;
  }
  if (!good) throw usageError("--cut", "'" + text + "' is not six numbers");
  const Vec3 normal(numbers[3], numbers[4], numbers[5]);
  if (normal == Vec3(0.0)) throw usageError("--cut", "the normal has no direction");
  return planeThrough(Vec3(numbers[0], numbers[1], numbers[2]) * unit.meters, normal, unit);
}

}  // namespace palpate::tools
