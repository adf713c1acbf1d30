// Published renderers, each with one property or figure that its publication or a derivation
// states.

#include "support/rivals/rivals.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"
#include "support/energy_meter.h"

namespace palpate::rivals {
namespace {

constexpr double kTick = 1e-3;   // [s]
constexpr double kSpring = 1e3;  // [N/m]
constexpr double kDegree = std::numbers::pi / 180.0;

/// Lengths in mm; every wall 1000 N/m.
ScenePtr sceneOf(const std::string& layers) {
  return compile(
      parseScene("palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: 1000 N/m}\n"
                 "layers:\n" +
                     layers,
                 "rivals.yaml"));
}

std::string ball(double radius) {
  return "  - {name: ball, inside: {sphere: {center: [0, 0, 0], radius: " + std::to_string(radius) +
         "}}, wall: wall}\n";
}

TickResult tick(HapticRenderer& renderer, const Vec3& p) {
  return renderer.update({p, Vec3(0.0), kTick});
}

double angleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

TEST(ClosestPoint, APlateHoldsHalfItsThicknessAndThenPushesOn) {
  const auto renderer = closestPoint(sceneOf(
      "  - {name: plate, inside: {box: {center: [0, 0, 0], size: [50, 50, 1]}}, wall: wall}\n"));
  double most = 0.0;
  for (double z = 0.6e-3; z > -0.6e-3; z -= 1e-6) {
    const double force = tick(*renderer, Vec3(0.001, 0.002, z)).force.z;
    most = std::max(most, force);
    if (z < -1e-9 && z > -0.5e-3 + 1e-9) {
      EXPECT_NEAR(force, -kSpring * (0.5e-3 + z), 1e-9);
    }
  }
  // 1 mm, 1000 N/m: 0.5 N at the most, and then the hand is through.
  EXPECT_NEAR(most, 0.5, 1e-3);
}

TEST(ClosestPoint, ARightEdgeStepsOnTheDiagonal) {
  const auto renderer = closestPoint(sceneOf(
      "  - {name: block, inside: {box: {center: [0, 0, 0], size: [50, 50, 50]}}, wall: wall}\n"));
  const double d = 2e-3;
  const Vec3 on(0.025 - d, 0.0, 0.025 - d);
  const Vec3 one = tick(*renderer, on + Vec3(1e-9, 0.0, 0.0)).force;
  const Vec3 other = tick(*renderer, on + Vec3(0.0, 0.0, 1e-9)).force;
  EXPECT_NEAR(glm::length(one - other), std::sqrt(2.0) * kSpring * d, 1e-5);
}

TEST(PotentialField, WhereTwoSolidsOverlapTheStiffnessDoubles) {
  const auto renderer = potentialField(sceneOf(
      "  - {name: a, inside: {box: {center: [0, 0, -10], size: [60, 60, 20]}}, wall: wall}\n"
      "  - {name: b, inside: {box: {center: [0, 0, -10], size: [20, 20, 20]}}, wall: wall}\n"));
  EXPECT_NEAR(tick(*renderer, Vec3(0.02, 0.0, -1e-3)).force.z, kSpring * 1e-3, 1e-9);
  EXPECT_NEAR(tick(*renderer, Vec3(0.0, 0.0, -1e-3)).force.z, 2.0 * kSpring * 1e-3, 1e-9);
}

TEST(TangentTracking, LagsOnASphereAsDerived) {
  // The contact point lags behind the probe by an angle a with a' = a (1 - 1 / (1 - kd)) + v T / (R
  // - d); at rest a = (v T / (R - d)) kd / (1 - kd), k = 1 / R; it is behind in the direction of
  // the step.
  constexpr double kRadius = 0.05;
  const ScenePtr scene = sceneOf(ball(50.0));
  for (const auto& [depth, degrees] : {std::pair(1e-3, 0.0048), {25e-3, 0.458}}) {
    const auto renderer = tangentTracking(scene);
    const double r = kRadius - depth;
    const double step = 0.2 * kTick / r;
    const double expected = step * (depth / kRadius) / (1.0 - depth / kRadius);
    EXPECT_NEAR(expected / kDegree, degrees, 0.01 * degrees);
    double off = 0.0;
    for (int k = 0; k < 400; ++k) {
      const Vec3 p = r * Vec3(std::sin(step * k), 0.0, std::cos(step * k));
      off = angleBetween(tick(*renderer, p).proxy, p);
    }
    // Errors of second order in the step.
    EXPECT_NEAR(off, expected, 0.01 * expected);
  }
}

TEST(TangentTracking, BuzzesInAHollowThatIsPressedDeeperThanItsRadius) {
  // The hand is pressed from inside a ball, d beyond its wall. A tick changes the proxy's angle a
  // to a - atan((1 + kd) sin a), so for kd above 1 it oscillates between +a and -a with 2 cos a /
  // cos 2a = 1 + kd.
  constexpr double kRadius = 0.02;
  const ScenePtr scene =
      compile(parseScene("palpate: 1\nlength: mm\nmaterials:\n  wall: {stiffness: 1000 "
                         "N/m}\nfields:\n  b: {sphere: {center: [0, 0, 0], "
                         "radius: 20}}\nlayers:\n  - {name: rock, inside: {difference: [{box: "
                         "{center: [0, 0, 0], size: [200, 200, 200]}}, b]}, wall: wall}\n",
                         "hollow.yaml"));
  for (const auto& [kd, degrees] : {std::pair(0.9, 0.0), {1.05, 7.30}, {1.2, 14.07}}) {
    const auto renderer = tangentTracking(scene);
    const double d = kd * kRadius;
    (void)tick(*renderer, Vec3(0.0, 0.0, 0.9 * kRadius));
    (void)tick(*renderer, (kRadius + 1e-6) * Vec3(std::sin(0.02), 0.0, std::cos(0.02)));
    std::vector<double> angles;
    for (int k = 0; k < 4000; ++k) {
      const Vec3 x = tick(*renderer, Vec3(0.0, 0.0, kRadius + d)).proxy;
      angles.push_back(std::atan2(x.x, x.z) / kDegree);
    }
    EXPECT_NEAR(std::fabs(angles.back()), degrees, degrees > 0.0 ? 0.005 : 1e-6);
    EXPECT_NEAR(angles[angles.size() - 2], -angles.back(), 0.005);
  }
}

/// Two faces that meet at x = 0: flat for x < 0, falling by `fold` for x > 0.
TriangleMesh foldOf(double fold) {
  const double c = std::cos(fold);
  const double s = std::sin(fold);
  TriangleMesh mesh;
  mesh.points = {{-0.1, -0.1, 0.0}, {0.0, -0.1, 0.0},          {0.0, 0.1, 0.0},
                 {-0.1, 0.1, 0.0},  {0.1 * c, -0.1, -0.1 * s}, {0.1 * c, 0.1, -0.1 * s}};
  mesh.normals.assign(6, Vec3(0.0, 0.0, 1.0));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}};
  return mesh;
}

TEST(GodObject, AConvexFoldCostsEnergyAndJumps) {
  // Face A releases the proxy at the edge, face B at d tan(phi) before it: between them the force
  // is that of the face it came from. Directions differ by phi, lengths are K d and, at the edge, K
  // d cos(phi); a loop loses K d^2 (sin^2 + tan^2)(phi) / 2.
  constexpr double kFold = 15.0 * kDegree;
  constexpr double kDepth = 1e-3;
  const auto renderer = godObject(sceneOf(ball(5.0)), foldOf(kFold));
  testing::EnergyMeter meter;
  const auto at = [&](double x) {
    const Vec3 p(x, 0.01, -kDepth);
    const Vec3 force = tick(*renderer, p).force;
    meter.add(p, force);
    return force;
  };
  (void)tick(*renderer, Vec3(-1e-3, 0.01, 1e-4));
  constexpr double kStep = 1e-7;
  Vec3 last = at(-1e-3);
  Vec3 before(0.0);
  Vec3 after(0.0);
  for (double x = -1e-3; x < 1e-3; x += kStep) {
    const Vec3 force = at(x);
    if (angleBetween(force, last) > 0.5 * kFold) before = last, after = force;
    last = force;
  }
  EXPECT_NEAR(angleBetween(before, after), kFold, 1e-3);
  EXPECT_NEAR(glm::length(before), kSpring * kDepth, 1e-3);
  EXPECT_NEAR(glm::length(after), kSpring * kDepth * std::cos(kFold), 1e-3);
  double back_at = 0.0;
  for (double x = 1e-3; x > -1e-3; x -= kStep) {
    const Vec3 force = at(x);
    if (angleBetween(force, last) > 0.5 * kFold) back_at = x;
    last = force;
  }
  EXPECT_NEAR(back_at, -kDepth * std::tan(kFold), 2e-6);
  const double s = std::sin(kFold);
  const double t = std::tan(kFold);
  const double lost = 0.5 * kSpring * kDepth * kDepth * (s * s + t * t);
  EXPECT_NEAR(lost, 0.0694e-3, 0.0001e-3);
  // The two jumps of the force are each held for a tick.
  EXPECT_NEAR(meter.work(), -lost, 5e-7);
}

TEST(GodObject, ThreeFacetsHoldItInACorner) {
  // The inside corner of a room, of three facets; the hand is far behind all of them.
  TriangleMesh mesh;
  mesh.points = {{0, 0, 0}, {0.1, 0, 0}, {0, 0.1, 0}, {0, 0, 0.1}};
  mesh.normals.assign(4, Vec3(1.0, 0.0, 0.0));
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}};
  const auto renderer = godObject(sceneOf(ball(5.0)), mesh);
  (void)tick(*renderer, Vec3(0.01, 0.012, 0.014));
  Vec3 p(0.0);
  for (int k = 0; k < 50; ++k) p = tick(*renderer, Vec3(-0.003, -0.002, -0.001)).proxy;
  EXPECT_LT(glm::length(p), 1e-8);
}

TEST(ForceShading, AStrokeAcrossAFacetGivesEnergyAndTheWayBackTakesIt) {
  // The interpolated normal of a facet is tilted by x / R at x. At rest, the proxy q is where the
  // plane through it with that normal contains the hand's foot: q - h = d tan(q / R). In at h = 0,
  // a stroke, and out: the force along it, K d tan(q / R), does the work W = K d R ln(1 / cos a) -
  // K d^2 tan^2(a) / 2 between a = 0 and a = q / R.
  constexpr double kRadius = 0.05;
  constexpr double kLength = 0.01;
  constexpr double kDepth = 2e-3;
  TriangleMesh mesh;
  const double lean = kLength / kRadius;
  const Vec3 leaning(std::sin(lean), 0.0, std::cos(lean));
  mesh.points = {{0, -0.1, 0}, {kLength, -0.1, 0}, {kLength, 0.1, 0}, {0, 0.1, 0}};
  mesh.normals = {{0, 0, 1}, leaning, leaning, {0, 0, 1}};
  mesh.triangles = {{0, 1, 2}, {0, 2, 3}};
  double q = 5e-3;
  for (int i = 0; i < 100; ++i) q = 5e-3 + kDepth * std::tan(q / kRadius);
  const double a = q / kRadius;
  const double expected = -kSpring * kDepth * kRadius * std::log(std::cos(a)) -
                          0.5 * kSpring * kDepth * kDepth * std::tan(a) * std::tan(a);
  constexpr int kSteps = 20000;
  for (const bool forward : {true, false}) {
    const auto renderer = forceShading(sceneOf(ball(5.0)), mesh);
    testing::EnergyMeter meter;
    const auto go = [&](const Vec3& from, const Vec3& to) {
      for (int k = 0; k <= kSteps; ++k) {
        const Vec3 p = from + (to - from) * (static_cast<double>(k) / kSteps);
        meter.add(p, tick(*renderer, p).force);
      }
    };
    // The facet begins at 0, so begin slightly inside.
    const Vec3 begin(forward ? 1e-6 : 5e-3, 0.01, 1e-5);
    const Vec3 end(forward ? 5e-3 : 1e-6, 0.01, 1e-5);
    const Vec3 down(0.0, 0.0, -kDepth - 1e-5);
    go(begin, begin + down);
    go(begin + down, end + down);
    go(end + down, end);
    // The normal is interpolated along a chord, not along the arc (0.3 %), and forces are held for
    // a tick.
    EXPECT_NEAR(meter.work(), forward ? expected : -expected, 0.01 * expected) << forward;
  }
}

TEST(SlowPlane, StepsByTheAngleThatTheHandWentInAPeriod) {
  // On a ball at depth d the hand turns by phi = v T_s / (R - d) from plane to plane. The depth
  // changes from d' = R - (R - d) cos(phi') in the old plane, a tick before the new one comes, to d
  // in the new one.
  constexpr double kRadius = 0.02;
  constexpr double kDepth = 1e-3;
  const ScenePtr scene = sceneOf(ball(20.0));
  for (const auto& [rate, newtons] : {std::pair(100.0, 0.057), {20.0, 0.71}}) {
    const auto renderer = slowPlane(scene, {.period = 1.0 / rate});
    const auto recovering = slowPlane(scene, {.period = 1.0 / rate, .recovery = 0.5 / rate});
    const double r = kRadius - kDepth;
    const double turn = 0.1 * kTick / r;
    double most = 0.0;
    double most_recovering = 0.0;
    Vec3 last(0.0);
    Vec3 last_recovering(0.0);
    for (int k = 0; k < 500; ++k) {
      const Vec3 p = r * Vec3(std::sin(turn * k), 0.0, std::cos(turn * k));
      const Vec3 force = tick(*renderer, p).force;
      const Vec3 soft = tick(*recovering, p).force;
      if (k > 100) {
        most = std::max(most, glm::length(force - last));
        most_recovering = std::max(most_recovering, glm::length(soft - last_recovering));
      }
      last = force;
      last_recovering = soft;
    }
    const double ticks = 1000.0 / rate;
    const double phi = turn * ticks;
    const double deep = kRadius - r * std::cos(turn * (ticks - 1.0));
    const double step =
        kSpring * std::sqrt(kDepth * kDepth + deep * deep - 2.0 * kDepth * deep * std::cos(phi));
    EXPECT_NEAR(step, newtons, 0.01 * newtons);
    EXPECT_NEAR(most, step, 1e-9);
    EXPECT_LT(most_recovering, most);
  }
}

TEST(Rivals, AllHoldOnASphereAndAreFreeBesideIt) {
  const ScenePtr scene = sceneOf(ball(20.0));
  const Field& field = *scene->regions()[1].field;
  const TriangleMesh mesh = meshOf(field, field.bounds().grownBy(2e-3), 1e-3);
  std::vector<std::pair<std::string, std::unique_ptr<HapticRenderer>>> all;
  all.emplace_back("closest point", closestPoint(scene));
  all.emplace_back("potential field", potentialField(scene));
  all.emplace_back("tangent tracking", tangentTracking(scene));
  all.emplace_back("slow plane", slowPlane(scene, {}));
  all.emplace_back("god-object", godObject(scene, mesh));
  all.emplace_back("force shading", forceShading(scene, mesh));
  all.emplace_back("voxels", voxelOccupancy(scene, {.size = 1e-3, .ramp = 6.0}));
  for (auto& [name, renderer] : all) {
    EXPECT_EQ(tick(*renderer, Vec3(0.0, 0.0, 0.03)).force, Vec3(0.0)) << name;
    Vec3 force(0.0);
    const testing::AllocGuard guard;
    for (int k = 0; k <= 1000; ++k) {
      force = tick(*renderer, Vec3(0.0, 0.0, 0.021 - 3e-6 * k)).force;
    }
    EXPECT_EQ(guard.violations(), 0) << name;
    // Facets of 1 mm on 20 mm are up to 1 mm^2 / (4 R) inside the surface; voxels report their
    // depth to a few hundredths of a voxel.
    EXPECT_NEAR(force.z, 2.0, 0.06) << name;
    EXPECT_LT(angleBetween(force, Vec3(0.0, 0.0, 1.0)), 0.06) << name;
    renderer->reset();
    EXPECT_EQ(tick(*renderer, Vec3(0.0, 0.0, 0.03)).force, Vec3(0.0)) << name;
  }
  EXPECT_THROW((void)closestPoint(sceneOf("  - {name: a, inside: {sphere: {center: [0, 0, 0], "
                                          "radius: 5}}, wall: absent}\n")),
               Error);
}

TEST(TriangleMesh, IsClosedAndOnTheSurface) {
  const FieldPtr field = sphere(Vec3(0.0), 0.02);
  const TriangleMesh mesh = meshOf(*field, field->bounds().grownBy(2e-3), 2e-3);
  double volume = 0.0;
  for (const auto& t : mesh.triangles) {
    volume += glm::dot(mesh.points[t[0]], glm::cross(mesh.points[t[1]], mesh.points[t[2]])) / 6.0;
  }
  for (const Vec3& p : mesh.points) EXPECT_NEAR(field->value(p), 0.0, 1e-12);
  // Chords of 2 mm cut off a small part of the ball.
  const double whole = 4.0 / 3.0 * std::numbers::pi * 8e-6;
  EXPECT_LT(volume, whole);
  EXPECT_GT(volume, 0.99 * whole);
}

}  // namespace
}  // namespace palpate::rivals
