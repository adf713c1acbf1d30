#pragma once
// The scenes of the source paper's figures, described a second time: their regions by separate
// formulas, their ports by a separate machine, in order to check the renderer's trace. Lengths in
// mm, as in the scene files.

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "folders/folders.h"
#include "lib/render/drive.h"

namespace palpate::test {

/// The ports passed, as the scene file's documentation defines it: how often in one direction minus
/// the other.
class PassedNames {
 public:
  [[nodiscard]] bool has(const std::string& port) const {
    const auto found = net_.find(port);
    return found != net_.end() && found->second != 0;
  }
  void pass(const std::string& port, int from, int to) {
    if (to == 0) {
      net_.clear();
    } else {
      net_[port] += from < to ? 1 : -1;
    }
  }

 private:
  std::map<std::string, int> net_;
};

struct Figure {
  std::string name;
  /// Region at a point [mm], 0 is outside.
  int (*region)(const Vec3& p);
  /// Name of the port that leads from region a to b at a point of the wall [mm]; "" where there is
  /// no wall; no value where it is closed.
  std::optional<std::string> (*way)(int a, int b, const Vec3& p, const PassedNames& passed);

  [[nodiscard]] ScenePtr scene() const { return sceneNamed(name); }
  /// The same without friction, damping and contents, and with all walls at 1000 N/m: all forces
  /// are spring forces.
  [[nodiscard]] ScenePtr springs() const {
    SceneDescription description =
        readScene(test::sourceFolder() + "/data/scenes/" + name + ".yaml");
    for (Material& material : description.materials) {
      Material bare;
      bare.name = material.name;
      bare.stiffness = material.stiffness.range().most > 0.0 ? 1000.0 : 0.0;
      material = bare;
    }
    return compile(description);
  }
};

using Way = std::optional<std::string>;
inline const Way kShut = std::nullopt;

/// [mm] At a rim, rounding decides which of two faces is nearer.
constexpr double kRim = 1e-6;

inline int containerRegion(const Vec3& p) { return glm::length(p) < 40.0 && p.z < 15.0 ? 1 : 0; }
inline Way containerWay(int, int, const Vec3& p, const PassedNames&) {
  if (std::fabs(p.z - 15.0) > std::fabs(glm::length(p) - 40.0) + kRim) return kShut;
  return "mouth";
}

inline int tubeRegion(const Vec3& p) {
  if (std::hypot(p.y, p.z) >= 15.0 || std::fabs(p.x) >= 45.0) return 0;
  return p.x < -15.0 ? 1 : p.x < 15.0 ? 2 : 3;
}
inline Way tubeWay(int a, int b, const Vec3& p, const PassedNames& passed) {
  const double side = std::fabs(std::hypot(p.y, p.z) - 15.0) + kRim;
  if ((a == 0 || b == 0) && side < std::fabs(std::fabs(p.x) - 45.0)) return kShut;
  const int port = std::max(a, b) == 1   ? 1
                   : std::min(a, b) == 0 ? (std::max(a, b) == 3 ? 4 : 0)
                                         : std::max(a, b);
  if (port == 0) return kShut;
  if (port > 1 && !passed.has("port " + std::to_string(port - 1))) return kShut;
  return "port " + std::to_string(port);
}

inline int valveRegion(const Vec3& p) {
  if (std::hypot(p.y, p.z) >= 12.0 || std::fabs(p.x) >= 40.0) return 0;
  return p.x < 0.0 ? 1 : 2;
}
inline Way valveWay(int a, int b, const Vec3& p, const PassedNames& passed) {
  const double side = std::fabs(std::hypot(p.y, p.z) - 12.0) + kRim;
  if ((a == 0 || b == 0) && side < std::fabs(std::fabs(p.x) - 40.0)) return kShut;
  if (a == 0 && b == 1) return "inlet";
  if (a == 1 && b == 2 && passed.has("inlet")) return "valve";
  if (a == 2 && b == 0 && passed.has("valve")) return "outlet";
  return kShut;
}

inline int cupRegion(const Vec3& p) {
  const double rho = std::hypot(p.x, p.y);
  const bool in_hollow = rho < 29.0 && p.z > -36.0 && p.z < 84.0;
  if (in_hollow && p.z < 20.0) return 2;
  return rho < 32.0 && std::fabs(p.z) < 40.0 && !in_hollow ? 1 : 0;
}
inline Way cupWay(int a, int b, const Vec3&, const PassedNames&) {
  if (a + b != 2 || a == b) return kShut;  // outside and liquid
  return "";
}

inline Way noWay(int, int, const Vec3&, const PassedNames&) { return kShut; }

inline int metaballsRegion(const Vec3& p) {
  static const std::vector<std::vector<Vec3>> bodies = {
      {{-120, 0, 0}, {-96, 0, 0}},
      {{-35, 14, 0}, {-47.124, -7, 0}, {-22.876, -7, 0}},
      {{45, 10, 10}, {45, -10, -10}, {25, 10, -10}, {25, -10, 10}},
      {{110, 0, 0}, {130, 0, 0}, {90, 0, 0}, {110, 20, 0}, {110, -20, 0}}};
  for (std::size_t i = 0; i < bodies.size(); ++i) {
    const double radius = i == 0 ? 30.0 : 28.0;
    double sum = 0.0;
    for (const Vec3& center : bodies[i]) {
      const Vec3 q = (p - center) / radius;
      sum += std::pow(std::max(0.0, 1.0 - glm::dot(q, q)), 3);
    }
    if (sum > 0.4) return static_cast<int>(i) + 1;
  }
  return 0;
}

inline int heartRegion(const Vec3& p) {
  // (x^2 + 9/4 y^2 + z^2 - 1)^3 < x^2 z^3 + 9/80 y^2 z^3, 1.13901 wide to each side.
  const Vec3 q = p / (30.0 / 1.13901);
  const double u = q.x * q.x + 2.25 * q.y * q.y + q.z * q.z - 1.0;
  const double w = q.x * q.x + 9.0 / 80.0 * q.y * q.y;
  return u * u * u < w * q.z * q.z * q.z ? 1 : 0;
}

inline int csgRegion(const Vec3& p) {
  const auto ellipsoid = [&](const Vec3& center, const Vec3& radii) {
    const Vec3 q = (p - center) / radii;
    return glm::dot(q, q) < 1.0;
  };
  const auto cube = [&](double x, double half) {
    return std::fabs(p.x - x) < half && std::fabs(p.y) < half && std::fabs(p.z) < half;
  };
  if (ellipsoid({-70, 0, 0}, {26, 19, 13}) || cube(-70, 15)) return 1;
  if (ellipsoid({0, 0, 0}, {26, 20, 22}) && cube(0, 17)) return 2;
  return cube(70, 18) && !ellipsoid({70, 0, 18}, {14, 10, 12}) ? 3 : 0;
}

inline const std::vector<Figure>& figures() {
  static const std::vector<Figure> all = {{"container", containerRegion, containerWay},
                                          {"composite_tube", tubeRegion, tubeWay},
                                          {"valve_tube", valveRegion, valveWay},
                                          {"cup", cupRegion, cupWay},
                                          {"metaballs", metaballsRegion, noWay},
                                          {"heart", heartRegion, noWay},
                                          {"csg", csgRegion, noWay}};
  return all;
}

inline std::string figureName(const ::testing::TestParamInfo<Figure>& figure) {
  return figure.param.name;
}

/// A point where the straight way from a to b [mm] goes from one region into another.
struct Crossing {
  int from = 0;
  int to = 0;
  Vec3 point{0.0};  ///< [mm]
};
/// Found by equal steps, and at the places `more` (0 at a, 1 at b), where equal steps may miss a
/// corner.
inline std::vector<Crossing> crossingsOf(const Figure& figure, const Vec3& a, const Vec3& b,
                                         int samples, std::vector<double> more = {}) {
  std::vector<Crossing> all;
  Vec3 last = a;
  int region = figure.region(a);
  for (int i = 1; i <= samples; ++i) more.push_back(static_cast<double>(i) / samples);
  std::sort(more.begin(), more.end());
  for (const double at : more) {
    const Vec3 here = glm::mix(a, b, at);
    const int now = figure.region(here);
    while (region != now) {
      Vec3 before = last;
      Vec3 behind = here;
      for (int k = 0; k < 60; ++k) {
        const Vec3 middle = 0.5 * (before + behind);
        (figure.region(middle) == region ? before : behind) = middle;
      }
      const int next = figure.region(behind);
      all.push_back({region, next, behind});
      region = next;
      last = behind;
    }
    last = here;
  }
  return all;
}

/// The result of a free straight way: the ports passed and the last region, or no value if a wall
/// is in the way.
struct Passage {
  std::string events;
  int region = 0;
  PassedNames passed;
};
inline std::optional<Passage> passageOf(const Figure& figure, const Vec3& a, const Vec3& b,
                                        int region, PassedNames passed, int samples,
                                        const std::vector<double>& more = {}) {
  Passage out{{}, region, std::move(passed)};
  if (figure.region(a) != region) return std::nullopt;
  for (const Crossing& crossing : crossingsOf(figure, a, b, samples, more)) {
    const Way way = figure.way(crossing.from, crossing.to, crossing.point, out.passed);
    if (!way) return std::nullopt;
    if (!way->empty()) {
      out.passed.pass(*way, crossing.from, crossing.to);
      out.events += (out.events.empty() ? "" : " ") + *way;
    }
    out.region = crossing.to;
  }
  return out;
}

}  // namespace palpate::test
