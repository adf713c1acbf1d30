#include <algorithm>
#include <cmath>
#include <numbers>

#include "bench/contact_case.h"
#include "bench/path.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/bake.h"

namespace palpate::tools {
namespace {

using oracle::Held;
using oracle::Minima;

constexpr double kTurn = 2.0 * std::numbers::pi;
constexpr double kStroke = 0.2;  // [m/s]
constexpr double kDepth = 1e-3;  // [m]
const Vec3 kOrigin(0.0);
const Vec3 kUp(0.0, 0.0, 1.0);

/// `rounds` rounds at `depth` below the surface of a ball about the origin; in a hollow, `depth`
/// beyond its surface. The angle along the great circle grows by `speed` / distance from the
/// center.
ContactCase ball(FieldPtr field, double radius, double depth, double speed, Held held,
                 double rounds = 10.0) {
  const bool hollow = held == Held::kInside;
  const double at = hollow ? radius + depth : radius - depth;
  const auto curve = [=](double s) { return at * windingDirection(s); };
  PathMaker maker(windingDirection(0.0) * (hollow ? 0.5 * radius : radius + 10.0 * kDepth));
  maker.go(curve(0.0), std::min(kApproachSpeed, speed));
  ContactCase out;
  out.first = maker.size();
  maker.play(curve, 0.0, rounds * kTurn, speed * kTickSeconds / at);
  out.end = maker.size();
  out.path = maker.take();
  out.scene = solidScene(std::move(field), hollow ? StartIn::kSolid : StartIn::kOutside);
  out.judge =
      judgeByFormula([=](const Vec3& p) { return oracle::sphereMinima(p, kOrigin, radius, held); });
  return out;
}

ContactCase analyticBall(double radius, double depth, double speed, Held held) {
  return ball(sphere(kOrigin, radius), radius, depth, speed, held);
}

ContactCase bakedBall() {
  const double radius = 0.05;
  vdb::BakeOptions options;
  options.voxel_size = 0.5e-3;
  const vdb::LevelSet grid = vdb::bake(*sphere(kOrigin, radius), options);
  return ball(vdb::gridField(grid), radius, kDepth, kStroke, Held::kOutside);
}

const Vec3 kRadii(0.030, 0.020, 0.015);  // [m] smallest radius of curvature 7.5 mm

ContactCase egg(FieldPtr field) {
  const auto curve = [](double s) {
    const Vec3 u = windingDirection(s);
    return kRadii * u - kDepth * glm::normalize(u / kRadii);
  };
  return along(solidScene(std::move(field)), Vec3(0.04, 0.0, 0.0), curve, 0.0, 10.0 * kTurn,
               kStroke, judgeByFormula([](const Vec3& p) {
                 const Vec3 q = p / kRadii;
                 if (glm::dot(q, q) >= 1.0) return Minima{p};
                 return Minima{oracle::closestOnEllipsoid(p, kRadii)};
               }));
}

ContactCase eggAsQuadric() {
  QuadricCoefficients q;
  q.xx = 1.0 / (kRadii.x * kRadii.x);
  q.yy = 1.0 / (kRadii.y * kRadii.y);
  q.zz = 1.0 / (kRadii.z * kRadii.z);
  q.constant = -1.0;
  return egg(quadric(kOrigin, q));
}

ContactCase ring() {
  const double radius = 0.04;
  const double tube = 0.01;
  const auto curve = [=](double s) {
    const double around = 3.7 * s;
    const double rho = radius + (tube - kDepth) * std::cos(around);
    return Vec3(rho * std::cos(s), rho * std::sin(s), (tube - kDepth) * std::sin(around));
  };
  return along(solidScene(torus(kOrigin, kUp, radius, tube)), Vec3(0.06, 0.0, 0.0), curve, 0.0,
               10.0 * kTurn, kStroke, judgeByFormula([=](const Vec3& p) {
                 return oracle::torusMinima(p, kOrigin, kUp, radius, tube, Held::kOutside);
               }));
}

const Vec3 kHalfBox(0.03, 0.02, 0.01);  // [m]

Judge boxJudge(Held held) {
  return judgeByFormula(
      [=](const Vec3& p) { return oracle::boxMinima(p, -kHalfBox, kHalfBox, held); });
}

/// A path along the top face and over its edge, into the side face, and back up over the edge.
ContactCase boxEdge() {
  PathMaker maker(Vec3(0.0, 0.0, 0.012));
  maker.go(Vec3(0.01, 0.0, 0.009), kApproachSpeed);
  ContactCase out;
  out.first = maker.size();
  for (int round = 0; round < 20; ++round) {
    const double y = 0.001 * round - 0.01;
    maker.go(Vec3(0.0323, y, 0.009), kStroke);
    maker.go(Vec3(0.0323, y, 0.002), kStroke);
    maker.go(Vec3(0.029, y, 0.001), kStroke);
    maker.go(Vec3(0.029, y, 0.0123), kStroke);
    maker.go(Vec3(0.01, y, 0.0123), kStroke);
    maker.go(Vec3(0.01, y, 0.009), kStroke);
  }
  out.end = maker.size();
  out.path = maker.take();
  out.scene = solidScene(box(kOrigin, 2.0 * kHalfBox));
  out.judge = boxJudge(Held::kOutside);
  return out;
}

/// A hand inside a box: along its walls, edges and corners.
ContactCase room() {
  const auto curve = [](double s) {
    return 1.3 * kHalfBox * Vec3(std::sin(s), std::sin(1.31 * s + 0.4), std::sin(1.73 * s + 0.9));
  };
  return along(solidScene(box(kOrigin, 2.0 * kHalfBox), StartIn::kSolid), kOrigin, curve, 0.0,
               10.0 * kTurn, kStroke, boxJudge(Held::kInside));
}

/// A path around the crease between two balls, to and fro across it.
ContactCase crease() {
  const oracle::Ball a{Vec3(-0.02, 0.0, 0.0), 0.03};
  const oracle::Ball b{Vec3(0.02, 0.0, 0.0), 0.03};
  const double ring = std::sqrt(0.03 * 0.03 - 0.02 * 0.02);
  const auto curve = [=](double s) {
    const double rho = ring - 2.0 * kDepth;
    return Vec3(0.002 * std::sin(7.3 * s), rho * std::cos(s), rho * std::sin(s));
  };
  return along(solidScene(unite({sphere(a.center, a.radius), sphere(b.center, b.radius)})),
               Vec3(0.0, 0.03, 0.0), curve, 0.0, 10.0 * kTurn, kStroke,
               judgeByFormula([=](const Vec3& p) { return oracle::twoBallUnionOutside(p, a, b); }));
}

/// A path along the bottom of a groove of 10 degrees, swaying from wall to wall.
ContactCase groove() {
  const double half = std::numbers::pi / 36.0;
  const Vec3 n1(std::cos(half), 0.0, std::sin(half));
  const Vec3 n2(-std::cos(half), 0.0, std::sin(half));
  const auto curve = [](double s) {
    return Vec3(0.5e-3 * std::sin(9.0 * s), 0.02 * std::sin(s), 3e-3 + 4e-3 * std::cos(3.1 * s));
  };
  return along(
      solidScene(unite({halfSpace(kOrigin, n1), halfSpace(kOrigin, n2)})), Vec3(0.0, 0.0, 0.02),
      curve, 0.0, 10.0 * kTurn, kStroke,
      judgeByFormula([=](const Vec3& p) { return oracle::grooveMinima(p, kOrigin, n1, n2); }));
}

/// A path around the waist of two metaballs, where the surface is a saddle.
ContactCase saddle() {
  const FieldPtr field =
      metaballs({{Vec3(-0.015, 0.0, 0.0), 0.03, 1.0}, {Vec3(0.015, 0.0, 0.0), 0.03, 1.0}},
                FallOff::kWyvill, 0.5);
  const auto curve = [field](double s) {
    const Vec3 middle(0.006 * std::sin(3.7 * s), 0.0, 0.0);
    const Vec3 u(0.0, std::cos(s), std::sin(s));
    double in = 0.0;
    double out = 0.03;
    while (out - in > 1e-12) {
      const double half = 0.5 * (in + out);
      (field->value(middle + half * u) < 0.0 ? in : out) = half;
    }
    const Vec3 surface = middle + in * u;
    return surface - kDepth * glm::normalize(field->sample(surface).gradient);
  };
  return along(solidScene(field), Vec3(0.0, 0.04, 0.0), curve, 0.0, 4.0 * kTurn, kStroke,
               judgeByOracle(oracle::FeasibleSet::outside(field), 16));
}

/// Adds balls with one opening each, in rows well away from the container, until the scene has
/// `count` ports.
void addPortsElsewhere(SceneDescription& scene, std::size_t count) {
  const auto source = [](FieldPtr field) {
    return std::make_shared<FieldSource>(std::move(field));
  };
  for (std::size_t i = 1; i < count; ++i) {
    const std::size_t plane = i / 100;
    const std::size_t row = i / 10 % 10;
    const Vec3 center = Vec3(0.2) + 0.01 * Vec3(i % 10, row, plane);
    LayerDescription layer;
    layer.name = "ball " + std::to_string(i);
    layer.inside = source(sphere(center, 4e-3));
    PortDescription port;
    port.name = "port " + std::to_string(i);
    port.from = "outside";
    port.to = layer.name;
    port.where = source(sphere(center + Vec3(0.0, 0.0, 4e-3), 2e-3));
    scene.layers.push_back(std::move(layer));
    scene.ports.push_back(std::move(port));
  }
}

/// A path into the paper's container through its mouth, around its wall from within, out again, and
/// around it from outside; in a scene of `ports` ports.
ContactCase container(std::size_t ports) {
  const double radius = 0.04;
  PathMaker maker(Vec3(0.0, 0.0, 0.03));
  maker.go(Vec3(0.0, 0.0, -0.005), kApproachSpeed);
  const auto round = [=](double rho) {
    return [=](double s) {
      const double z = -5e-3 + 0.012 * std::sin(0.31 * s);
      const double flat = std::sqrt(rho * rho - z * z);
      return Vec3(flat * std::cos(s), flat * std::sin(s), z);
    };
  };
  ContactCase out;
  maker.go(round(radius + kDepth)(0.0), kStroke);
  out.first = maker.size();
  maker.follow(round(radius + kDepth), 0.0, 5.0 * kTurn, kStroke);
  const std::size_t inside_ends = maker.size();
  maker.go(Vec3(0.0, 0.0, -0.005), kStroke);
  maker.go(Vec3(0.0, 0.0, 0.03), kStroke);
  maker.go(Vec3(0.06, 0.0, 0.03), kStroke);
  maker.go(Vec3(0.06, 0.0, -0.005), kStroke);
  maker.go(round(radius - kDepth)(0.0), kStroke);
  const std::size_t outside_begins = maker.size();
  maker.follow(round(radius - kDepth), 0.0, 5.0 * kTurn, kStroke);
  out.end = maker.size();
  out.path = maker.take();
  SceneDescription scene = parseScene(R"({palpate: 1, length: mm,
    fields: {bowl: {sphere: {center: [0, 0, 0], radius: 40}},
             brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}},
    materials: {glass: {stiffness: 1000 N/m}},
    layers: [{name: liquid, inside: {intersection: [bowl, brim]}, wall: glass}],
    ports: [{name: mouth, between: [outside, liquid], on: brim}]})",
                                      "container");
  addPortsElsewhere(scene, ports);
  out.scene = compile(scene);
  out.judge = [=](std::span<const Vec3> path, std::span<const TickResult>, const Progress&) {
    Truth truth(path.size());
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i >= inside_ends && i < outside_begins) continue;
      const Held held = i < inside_ends ? Held::kInside : Held::kOutside;
      truth[i] = oracle::sphereMinima(path[i], kOrigin, radius, held).front();
    }
    return truth;
  };
  return out;
}

/// `count` balls of 5 mm, 12 mm apart; the middle one is touched.
ContactCase manyBalls(std::size_t count) {
  const double radius = 5e-3;
  const double apart = 12e-3;
  std::vector<Vec3> centers;
  const int reach = static_cast<int>(std::ceil(0.5 * std::cbrt(static_cast<double>(count)))) + 1;
  for (int x = -reach; x <= reach; ++x) {
    for (int y = -reach; y <= reach; ++y) {
      for (int z = -reach; z <= reach; ++z) centers.push_back(apart * Vec3(x, y, z));
    }
  }
  const auto extent = [](const Vec3& c) {
    return std::max({std::fabs(c.x), std::fabs(c.y), std::fabs(c.z)});
  };
  std::stable_sort(centers.begin(), centers.end(),
                   [&](const Vec3& a, const Vec3& b) { return extent(a) < extent(b); });
  centers.resize(count);
  std::vector<FieldPtr> balls;
  for (const Vec3& center : centers) balls.push_back(sphere(center, radius));
  return ball(unite(std::move(balls)), radius, 0.5e-3, kStroke, Held::kOutside, 40.0);
}

}  // namespace

const std::vector<CaseEntry>& contactCases() {
  static const std::vector<CaseEntry> all = {
      {"sphere", "R 50 mm, 1 mm deep, ten rounds at 0.2 m/s",
       [] { return analyticBall(0.05, kDepth, kStroke, Held::kOutside); }},
      {"sphere-baked", "the same, baked at 0.5 mm", bakedBall},
      {"sphere-deep", "R 5 mm, 4.5 mm deep, 50 rad/s",
       [] { return analyticBall(5e-3, 4.5e-3, 50.0 * 0.5e-3, Held::kOutside); }},
      {"sphere-small", "R 0.5 mm, 0.25 mm deep, 50 rad/s",
       [] { return analyticBall(0.5e-3, 0.25e-3, 50.0 * 0.25e-3, Held::kOutside); }},
      {"sphere-hollow", "from within, R 5 mm, 10 mm deep, 50 rad/s",
       [] { return analyticBall(5e-3, 10e-3, 50.0 * 15e-3, Held::kInside); }},
      {"ellipsoid", "30 x 20 x 15 mm, 1 mm deep, 0.2 m/s",
       [] { return egg(ellipsoid(kOrigin, kRadii)); }},
      {"quadric", "the same ellipsoid as an implicit quadric", eggAsQuadric},
      {"torus", "40 and 10 mm, 1 mm deep, 0.2 m/s", ring},
      {"box-edge", "over an edge of a box, face to face", boxEdge},
      {"box-room", "within a box: faces, edges, corners", room},
      {"box-corner", "about a corner of that box, from within", boxCorner},
      {"three-balls", "where a ball of 20 mm, from within, and two of 15 and 12 mm meet",
       [] { return threeBalls(false); }},
      {"three-hollow", "where balls of 20, 15 and 12 mm meet, all from within",
       [] { return threeBalls(true); }},
      {"cone-tip", "about the tip of a hollow cone of 18.4 degrees to each side",
       [] { return coneTip(std::atan2(1.0, 3.0)); }},
      {"cone-wide", "the same, of 60 degrees", [] { return coneTip(std::numbers::pi / 3.0); }},
      {"csg-nested", "within eight solids joined and cut, four levels deep", nestedCsg},
      {"crease", "between two balls of 30 mm", crease},
      {"groove", "a groove of 10 degrees", groove},
      {"saddle", "the waist of two metaballs", saddle},
      {"container", "the paper's: in by the mouth, out, around", [] { return container(1); }},
      {"ports-10", "the same, with 9 ports elsewhere", [] { return container(10); }},
      {"ports-100", "with 99 ports elsewhere", [] { return container(100); }},
      {"ports-1000", "with 999 ports elsewhere", [] { return container(1000); }},
      {"balls-1", "a ball of 5 mm, 0.5 mm deep", [] { return manyBalls(1); }},
      {"balls-1000", "one of 1000 balls", [] { return manyBalls(1000); }},
      {"balls-10000", "one of 10 000 balls", [] { return manyBalls(10000); }},
      {"five-layers", "grids for shapes and materials; a needle to the bone, not judged",
       fiveLayers},
      {"lump", "a lump felt through the skin over it, not judged", lumpUnderSkin},
  };
  return all;
}

}  // namespace palpate::tools
