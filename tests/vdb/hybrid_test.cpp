// Hybrid CSG: which parts become grids, and that edges and thin parts stay as exact as they were.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <numbers>
#include <random>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

constexpr double kMm = 1e-3;
constexpr double kDegree = std::numbers::pi / 180.0;
/// Rounding of a value computed from coordinates of some centimeters: 1e-16 of them, a few
/// operations.
constexpr double kRounding = 1e-12;  // [m]

Hybrid made(const FieldPtr& field, double voxel, Parts parts, Sampler sampler = Sampler::kCubic) {
  HybridOptions options;
  options.bake = test::voxels(voxel);
  options.parts = parts;
  options.sampler = sampler;
  return bakeHybrid(field, options);
}

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) / kDegree;
}

struct Errors {
  double value = 0.0;    // [m] largest
  double normal = 0.0;   // [degrees] RMS
  double largest = 0.0;  // [degrees]
  int count = 0;

  void add(const FieldSample& got, double value_there, const Vec3& normal_there) {
    const double slope = glm::length(got.gradient);
    value = std::max(value, std::fabs(got.value - value_there));
    const double turn = slope > 0.0 ? angle(got.gradient, normal_there) : 180.0;
    normal = std::sqrt((normal * normal * count + turn * turn) / (count + 1));
    largest = std::max(largest, turn);
    ++count;
  }
};

class Scattered {
 public:
  Vec3 in(const Vec3& half) {
    return half * Vec3(share_(engine_), share_(engine_), share_(engine_));
  }

 private:
  std::mt19937 engine_{7};
  std::uniform_real_distribution<double> share_{-1.0, 1.0};
};

const Vec3 kHalf(30 * kMm, 20 * kMm, 25 * kMm);
const Pose kTurned{rotationAbout(Vec3(1.0, 2.0, 3.0), 0.7), Vec3(1.3, -0.4, 0.6) * kMm};

FieldPtr turnedBox() { return place(box(Vec3(0.0), 2.0 * kHalf), kTurned); }

/// Distance to the rotated box and its gradient, in closed form.
FieldSample boxAt(const Vec3& p) {
  const Vec3 q = kTurned.applyInverse(p);
  const Vec3 w = glm::abs(q) - kHalf;
  const Vec3 sign = glm::sign(q);
  const Vec3 out = glm::max(w, Vec3(0.0));
  const double far = glm::length(out);
  if (far > 0.0) return {far, kTurned.rotate(sign * out / far)};
  int axis = 0;
  for (int i = 1; i < 3; ++i) {
    if (w[i] > w[axis]) axis = i;
  }
  Vec3 n(0.0);
  n[axis] = sign[axis];
  return {w[axis], kTurned.rotate(n)};
}

/// Errors within a voxel of the rotated box's surface and within four voxels of one of its edges.
Errors errorsAtEdges(const Field& field, double voxel) {
  Errors errors;
  Scattered points;
  while (errors.count < 20000) {
    const Vec3 q = points.in(kHalf + Vec3(voxel));
    const Vec3 gap = glm::abs(glm::abs(q) - kHalf);
    const int near = (gap.x < 4 * voxel) + (gap.y < 4 * voxel) + (gap.z < 4 * voxel);
    const Vec3 p = kTurned.apply(q);
    const FieldSample truth = boxAt(p);
    if (near < 2 || std::fabs(truth.value) > voxel) continue;
    // Where two faces are equally near, up to rounding, the gradient may be that of either.
    const Vec3 w = glm::abs(q) - kHalf;
    std::array<double, 3> ways{w.x, w.y, w.z};
    std::sort(ways.begin(), ways.end());
    if (ways[2] - ways[1] < 1e-9) continue;
    errors.add(field.sample(p), truth.value, truth.gradient);
  }
  return errors;
}

TEST(Hybrid, EdgesOfATurnedBoxStayExactWhereAGridIsTenDegreesOff) {
  const double voxel = 1 * kMm;
  const Hybrid hybrid = made(turnedBox(), voxel, Parts::kAuto);
  const Hybrid pure = made(turnedBox(), voxel, Parts::kWhole);
  ASSERT_EQ(hybrid.parts.size(), 1U);
  EXPECT_FALSE(hybrid.parts[0].grid);
  EXPECT_NE(hybrid.parts[0].reason.find("edges"), std::string::npos) << hybrid.parts[0].reason;
  EXPECT_TRUE(pure.parts[0].grid);
  const Errors exact = errorsAtEdges(*hybrid.field, voxel);
  const Errors grid = errorsAtEdges(*pure.field, voxel);
  std::printf(
      "box edges, voxel 1 mm: hybrid %.1e mm, %.1e degree RMS, %.1e max; grid %.3f mm, %.1f, "
      "%.0f\n",
      exact.value / kMm, exact.normal, exact.largest, grid.value / kMm, grid.normal, grid.largest);
  EXPECT_LE(exact.value, kRounding);
  EXPECT_LE(exact.largest, 1e-6);
  // Known for every interpolant, whatever the voxel size: some 10 degrees RMS, some 50 at worst.
  EXPECT_GT(grid.normal, 8.0);
  EXPECT_LT(grid.normal, 15.0);
  EXPECT_GT(grid.largest, 30.0);
  EXPECT_GT(pure.parts[0].turn, 30.0);
  EXPECT_GT(grid.value, 0.1 * voxel);
}

TEST(Hybrid, AShellOfOneVoxelStaysExactWhereAGridRoundsIt) {
  const double voxel = 1 * kMm;
  const Vec3 center(0.31 * kMm, 0.47 * kMm, -0.22 * kMm);
  const double outer = 20 * kMm;
  const double inner = outer - voxel;
  const FieldPtr shell = subtract({sphere(center, outer), sphere(center, inner)});
  const Hybrid hybrid = made(shell, voxel, Parts::kOperands);
  const auto errors = [&](const Field& field) {
    Errors out;
    Scattered points;
    while (out.count < 20000) {
      const Vec3 p = center + points.in(Vec3(outer + voxel));
      const double r = glm::length(p - center);
      const double truth = std::max(r - outer, inner - r);
      if (std::fabs(truth) > voxel || std::fabs((r - outer) - (inner - r)) < 1e-9) continue;
      const Vec3 away = (p - center) / r;
      out.add(field.sample(p), truth, r - outer > inner - r ? away : -away);
    }
    return out;
  };
  const Hybrid pure = made(shell, voxel, Parts::kWhole);
  const Errors exact = errors(*hybrid.field);
  const Errors grid = errors(*pure.field);
  std::printf(
      "shell of a voxel, 1 mm: hybrid %.1e mm, %.1e degree max; grid %.3f mm, "
      "%.1f "
      "degree RMS, %.0f max\n",
      exact.value / kMm, exact.largest, grid.value / kMm, grid.normal, grid.largest);
  EXPECT_LE(exact.value, kRounding);
  EXPECT_LE(exact.largest, 1e-6);
  EXPECT_GT(grid.value, 0.05 * voxel);
  EXPECT_GT(grid.largest, 30.0);
}

class HybridSamplers : public ::testing::TestWithParam<Sampler> {};
INSTANTIATE_TEST_SUITE_P(All, HybridSamplers,
                         ::testing::Values(Sampler::kCubic, Sampler::kTrilinear));

TEST_P(HybridSamplers, AGyroidInABoxIsAGridOfTheGyroidCutByExactFaces) {
  const double voxel = 1 * kMm;
  const FieldPtr wall = turnedBox();
  const FieldPtr wave = gyroid(Vec3(0.0), 40 * kMm);
  const Hybrid hybrid = made(intersect({wall, wave}), voxel, Parts::kOperands, GetParam());
  ASSERT_EQ(hybrid.parts.size(), 2U);
  EXPECT_EQ(hybrid.parts[0].name, "1");
  EXPECT_FALSE(hybrid.parts[0].grid);
  EXPECT_EQ(hybrid.parts[1].name, "2");
  ASSERT_TRUE(hybrid.parts[1].grid) << hybrid.parts[1].reason;
  EXPECT_EQ(hybrid.parts[1].grid.info().name, "surface/2");
  const FieldStructure structure = hybrid.field->structure();
  ASSERT_EQ(structure.kind, FieldStructure::Kind::kIntersection);
  EXPECT_EQ(structure.operands[0], wall);  // the same object: ports find it
  EXPECT_NE(structure.operands[1], wave);

  Scattered points;
  int on_box = 0;
  int on_wave = 0;
  double off = 0.0;
  double turn = 0.0;
  for (int i = 0; i < 40000; ++i) {
    const Vec3 p = kTurned.apply(points.in(1.05 * kHalf));
    const FieldSample face = boxAt(p);
    const FieldSample s = wave->sample(p);
    const double slope = glm::length(s.gradient);
    const FieldSample got = hybrid.field->sample(p);
    // Everywhere, both agree about the side of the surface, except within the grid's error.
    const double whole = std::max(face.value, s.value / slope);
    if (std::fabs(whole) > 0.1 * voxel) {
      ASSERT_EQ(got.value < 0.0, whole < 0.0) << whole;
    }
    if (face.value > 0.0) {
      // Outside the box the box decides, even where the wave is less.
      if (s.value / slope < face.value - 0.2 * voxel) {
        ++on_box;
        ASSERT_NEAR(got.value, face.value, kRounding);
        ASSERT_LE(angle(got.gradient, face.gradient), 1e-6);
      }
    } else if (std::fabs(s.value) < 0.5 * voxel * slope && face.value < -2 * voxel) {
      ++on_wave;
      Vec3 foot = p;
      for (int n = 0; n < 5; ++n) {
        const FieldSample at = wave->sample(foot);
        foot -= at.value / glm::dot(at.gradient, at.gradient) * at.gradient;
      }
      const FieldSample there = hybrid.field->sample(foot);
      off = std::max(off, std::fabs(there.value));
      turn = std::max(turn, angle(there.gradient, wave->sample(foot).gradient));
    }
  }
  EXPECT_GT(on_box, 2000);
  EXPECT_GT(on_wave, 200);
  // Queries have the error that was measured at set-up.
  EXPECT_LE(off, 1.3 * hybrid.parts[1].off);
  if (GetParam() == Sampler::kCubic) {
    EXPECT_LE(turn, 0.05);  // [degrees] an error of third order, at 15 voxels per radius
  }
  EXPECT_GE(off, 0.3 * hybrid.parts[1].off);
  EXPECT_LE(turn, 1.3 * hybrid.parts[1].turn);
  std::printf("gyroid of 40 mm in a box, voxel 1 mm: wave off by %.1e mm, %.2g degree\n", off / kMm,
              turn);
}

/// A ball that is slow to evaluate.
FieldPtr slowBall(double radius) {
  test::FunctionField::Claims claims;
  claims.bounds = {Vec3(-radius), Vec3(radius)};
  claims.metric = Metric::kBound;
  claims.feature_size = radius;
  return std::make_shared<test::FunctionField>(
      [radius](const Vec3& p) {
        double idle = 1.0;
        for (int i = 0; i < 3000; ++i) idle = std::sqrt(idle + 1.0);  // some 20 us
        const double r = glm::length(p);
        return FieldSample{r - radius + 1e-300 * idle, unitOr(p, Vec3(1.0, 0.0, 0.0))};
      },
      claims);
}

TEST(Hybrid, WhatIsSlowBecomesAGridAndWhatIsFastDoesNot) {
  const FieldPtr slow = slowBall(6 * kMm);
  const FieldPtr fast = sphere(Vec3(10 * kMm, 0.0, 0.0), 6 * kMm);
  const Hybrid hybrid = made(unite({fast, slow}), 0.5 * kMm, Parts::kAuto);
  ASSERT_EQ(hybrid.parts.size(), 2U);
  EXPECT_FALSE(hybrid.parts[0].grid) << hybrid.parts[0].reason;
  EXPECT_TRUE(hybrid.parts[1].grid) << hybrid.parts[1].reason;
  EXPECT_GT(hybrid.parts[1].analytic_ns, 10.0 * hybrid.parts[1].grid_ns);
  EXPECT_GT(hybrid.parts[1].off, 0.0);
  // On request every part that is not exact becomes a grid, whatever a query costs.
  const Hybrid forced = made(unite({fast, test::implicitBall(0.01)}), 0.5 * kMm, Parts::kOperands);
  EXPECT_FALSE(forced.parts[0].grid);
  EXPECT_TRUE(forced.parts[1].grid);
  EXPECT_EQ(forced.parts[1].analytic_ns, 0.0);
}

TEST(Hybrid, APartIsBakedOnceInItsOwnFrameAndWhatDidNotChangeStaysTheSameObject) {
  const FieldPtr drops = metaballs({{Vec3(0.0), 0.012, 1.0}, {Vec3(0.008, 0.0, 0.0), 0.012, 1.0}},
                                   FallOff::kWyvill, 0.4);
  const Pose aside{rotationAbout(Vec3(0.0, 0.0, 1.0), 0.5), Vec3(30 * kMm, 0.0, 0.0)};
  const FieldPtr plain = subtract(
      {box(Vec3(0.0, 30 * kMm, 0.0), Vec3(10 * kMm)), sphere(Vec3(0.0, 30 * kMm, 0.0), 6 * kMm)});
  const FieldPtr tree = unite({drops, place(drops, aside), plain});
  const Hybrid hybrid = made(tree, 0.5 * kMm, Parts::kOperands);
  const auto baked = std::count_if(hybrid.parts.begin(), hybrid.parts.end(),
                                   [](const HybridPart& part) { return bool(part.grid); });
  EXPECT_EQ(baked, 1);
  const FieldStructure structure = hybrid.field->structure();
  EXPECT_EQ(structure.operands[2], plain);
  const FieldStructure placed = structure.operands[1]->structure();
  ASSERT_EQ(placed.kind, FieldStructure::Kind::kTransform);
  EXPECT_EQ(placed.operands.front(), structure.operands[0]);
  EXPECT_EQ(placed.pose.translation, aside.translation);
  // The grid is aligned with the drops' own axes: after a rotation, it answers just as well.
  Scattered points;
  for (int i = 0; i < 2000; ++i) {
    const Vec3 p = points.in(Vec3(12 * kMm));
    EXPECT_NEAR(structure.operands[0]->value(p), structure.operands[1]->value(aside.apply(p)),
                1e-12);
  }
  EXPECT_EQ(made(plain, 0.5 * kMm, Parts::kOperands).field, plain);
}

TEST(Hybrid, ABallThatTouchesItsBoundsIsHeldByAGrid) {
  const FieldPtr ball = metaballs({{Vec3(0.31 * kMm), 0.012, 1.0}}, FallOff::kWyvill, 0.4);
  const Hybrid hybrid = made(ball, 0.5 * kMm, Parts::kOperands);
  ASSERT_EQ(hybrid.parts.size(), 1U);
  EXPECT_TRUE(hybrid.parts[0].grid) << hybrid.parts[0].reason;
  EXPECT_LT(hybrid.parts[0].turn, 0.1) << hybrid.parts[0].reason;
}

TEST(Hybrid, WhatIsToStayStays) {
  const FieldPtr drop = test::implicitBall(0.012);
  const FieldPtr other = place(drop, {Mat3(1.0), Vec3(0.03, 0.0, 0.0)});
  const FieldPtr third = test::implicitBall(0.011);
  HybridOptions options;
  options.bake = test::voxels(kMm);
  options.parts = Parts::kOperands;
  options.keep = {unite({other, box(Vec3(0.0), Vec3(kMm))})};  // everything in the union
  const Hybrid hybrid =
      bakeHybrid(unite({drop, place(third, {Mat3(1.0), Vec3(0.0, 0.03, 0.0)})}), options);
  ASSERT_EQ(hybrid.parts.size(), 2U);
  EXPECT_FALSE(hybrid.parts[0].grid) << hybrid.parts[0].reason;
  EXPECT_TRUE(hybrid.parts[1].grid) << hybrid.parts[1].reason;
  EXPECT_EQ(hybrid.field->structure().operands[0], drop);
}

TEST(Hybrid, GridsMadeOnceTakeTheirPlacesAgain) {
  const auto tree = [](double period) {
    return subtract({intersect({turnedBox(), gyroid(Vec3(0.0), period)}),
                     place(test::implicitBall(8 * kMm), kTurned)});
  };
  const FieldPtr field = tree(30 * kMm);
  const Hybrid hybrid = made(field, 1 * kMm, Parts::kOperands);
  std::map<std::string, LevelSet> grids;
  for (const HybridPart& part : hybrid.parts) {
    if (!part.grid) continue;
    EXPECT_EQ(part.grid.info().name, "surface/" + part.name);
    EXPECT_EQ(part.grid.info().metadata.at("part"), part.name);
    grids[part.name] = part.grid;
  }
  ASSERT_EQ(grids.size(), 2U);
  // The ball has its own frame.
  EXPECT_EQ(grids.rbegin()->second.info().metadata.at("frame"), "part");
  EXPECT_EQ(grids.begin()->second.info().metadata.at("frame"), "world");
  const FieldPtr again = recombined(field, grids, Sampler::kCubic);
  Scattered points;
  for (int i = 0; i < 5000; ++i) {
    const Vec3 p = points.in(kHalf * 1.2);
    const FieldSample a = hybrid.field->sample(p);
    const FieldSample b = again->sample(p);
    ASSERT_EQ(a.value, b.value);
    ASSERT_EQ(a.gradient, b.gradient);
  }
  EXPECT_EQ(recombined(field, {}, Sampler::kCubic), field);

  const auto expect_other = [](const FieldPtr& of, const std::map<std::string, LevelSet>& these,
                               const std::string& says) {
    try {
      (void)recombined(of, these, Sampler::kCubic);
      ADD_FAILURE() << "taken without complaint";
    } catch (const Error& error) {
      EXPECT_EQ(error.problem().code, "bake.other_field");
      EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
    }
  };
  expect_other(tree(30.3 * kMm), grids, "is off its part");
  expect_other(turnedBox(), grids, "the field does not have");
}

TEST(Hybrid, WhatAGridCannotHoldStaysAnalyticAndSaysWhy) {
  const FieldPtr drop = test::implicitBall(0.012);
  struct Case {
    FieldPtr field;
    std::string says;
  };
  const FieldPtr cusp = heart(Vec3(0.0), 0.02);
  const FieldPtr plate =
      smoothIntersect({box(Vec3(0.0, 0.0, 0.5 * kMm), Vec3(20 * kMm, 20 * kMm, 0.3 * kMm)),
                       sphere(Vec3(0.0), 0.02)},
                      0.0001);
  for (const Case& each :
       {Case{gyroid(Vec3(0.0), 0.02), "endless"}, Case{cusp, "off by up to"}, Case{plate, "thin"},
        Case{gridField(bake(*drop, test::voxels(kMm))), "a grid already"}}) {
    const Hybrid hybrid = made(each.field, 1 * kMm, Parts::kOperands);
    ASSERT_EQ(hybrid.parts.size(), 1U);
    EXPECT_NE(hybrid.parts[0].reason.find(each.says), std::string::npos) << hybrid.parts[0].reason;
    EXPECT_FALSE(hybrid.parts[0].grid);
    EXPECT_EQ(hybrid.field, each.field);
  }
  // The tolerance is the one that the author gave.
  HybridOptions options;
  options.bake = test::voxels(kMm);
  options.parts = Parts::kOperands;
  EXPECT_TRUE(bakeHybrid(drop, options).parts[0].grid);
  options.tolerance = 1e-9;
  EXPECT_FALSE(bakeHybrid(drop, options).parts[0].grid);
  options.tolerance = -1.0;
  EXPECT_THROW((void)bakeHybrid(drop, options), Error);
  EXPECT_THROW((void)bakeHybrid(nullptr, {}), Error);
}

TEST(Hybrid, OnlyWhatTheWholeNeedsIsBaked) {
  // A big blob, of which only a small ball is needed.
  const double radius = 0.05;
  const FieldPtr blob = test::implicitBall(radius);
  const FieldPtr window = sphere(Vec3(radius, 0.0, 0.0), 5 * kMm);
  const Hybrid whole = made(blob, 1 * kMm, Parts::kOperands);
  const FieldPtr tree = subtract({window, blob});
  const Hybrid part = made(tree, 1 * kMm, Parts::kOperands);
  ASSERT_TRUE(part.parts[1].grid) << part.parts[1].reason;
  EXPECT_LT(part.parts[1].grid.info().active_voxels, whole.parts[0].grid.info().active_voxels / 4);
  // The part that was cut away is not missed.
  Scattered points;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = Vec3(radius, 0.0, 0.0) + points.in(Vec3(60 * kMm));
    const double truth = tree->value(p);
    if (std::fabs(truth) < 0.05 * kMm) continue;
    ASSERT_EQ(part.field->value(p) < 0.0, truth < 0.0);
  }
}

TEST(Hybrid, ABoxCutsWithExactFaces) {
  HybridOptions options;
  options.bake = test::voxels(0.5 * kMm);
  options.bake.box = Box3{Vec3(-10 * kMm), Vec3(10 * kMm)};
  options.parts = Parts::kOperands;
  const FieldPtr wave = gyroid(Vec3(0.0), 20 * kMm);
  const Hybrid hybrid = bakeHybrid(wave, options);
  EXPECT_EQ(hybrid.field->structure().kind, FieldStructure::Kind::kIntersection);
  EXPECT_TRUE(hybrid.field->bounds().isBounded());
  Scattered points;
  int seen = 0;
  for (int i = 0; i < 5000; ++i) {
    Vec3 p = points.in(Vec3(9 * kMm));
    p.x = 10 * kMm + 1e-9;
    if (wave->value(p) > -1e-4) continue;
    ++seen;
    const FieldSample s = hybrid.field->sample(p);
    ASSERT_NEAR(s.value, 1e-9, kRounding);
    ASSERT_LE(angle(s.gradient, Vec3(1.0, 0.0, 0.0)), 1e-6);
  }
  EXPECT_GT(seen, 1000);
}

}  // namespace
}  // namespace palpate::vdb
