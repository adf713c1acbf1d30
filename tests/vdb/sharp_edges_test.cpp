// Curved meshes with sharp edges: exact triangles near edges, bricks elsewhere, no step in between.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numbers>
#include <random>

#include "lib/render/hard_judge.h"
#include "palpate/core/error.h"
#include "palpate/fields/primitives.h"
#include "palpate/vdb/bake.h"
#include "palpate/vdb/mesh.h"
#include "vdb/shapes.h"

namespace palpate::vdb {
namespace {

using namespace palpate::vdb::test;  // NOLINT(google-build-using-namespace)
using palpate::test::Drive;
using palpate::test::kDegree;
using palpate::test::sceneOfSolid;

constexpr double kMm = 1e-3;
constexpr double kVoxel = 0.5 * kMm;
constexpr double kAngle = 30.0 * kDegree;
constexpr double kRadius = 15 * kMm;
constexpr double kHalf = 10 * kMm;

/// A can about z with `sides` facets around, whose rims are sharp; its walls are strips as high as
/// they are wide.
Mesh can(int sides) {
  Mesh mesh;
  mesh.source = "can";
  const int strips =
      std::max(1, static_cast<int>(std::lround(kHalf * sides / (std::numbers::pi * kRadius))));
  for (int k = 0; k <= strips; ++k) {
    for (int i = 0; i < sides; ++i) {
      const double a = 2.0 * std::numbers::pi * i / sides;
      mesh.vertices.emplace_back(kRadius * std::cos(a), kRadius * std::sin(a),
                                 kHalf * (2.0 * k / strips - 1.0));
    }
  }
  const auto at = [&](int i, int k) { return static_cast<std::uint32_t>(i % sides + sides * k); };
  for (int k = 0; k < strips; ++k) {
    for (int i = 0; i < sides; ++i) {
      mesh.triangles.push_back({at(i, k), at(i + 1, k), at(i + 1, k + 1)});
      mesh.triangles.push_back({at(i, k), at(i + 1, k + 1), at(i, k + 1)});
    }
  }
  mesh.vertices.emplace_back(0.0, 0.0, -kHalf);
  mesh.vertices.emplace_back(0.0, 0.0, kHalf);
  const auto low = static_cast<std::uint32_t>(mesh.vertices.size() - 2);
  for (int i = 0; i < sides; ++i) {
    mesh.triangles.push_back({low, at(i + 1, 0), at(i, 0)});
    mesh.triangles.push_back({low + 1, at(i, strips), at(i + 1, strips)});
  }
  return mesh;
}

struct Fields {
  FieldPtr bricks, sharp;
};

Fields fieldsOf(const Mesh& mesh) {
  Fields fields;
  fields.bricks = gridField(bakeMesh(mesh, voxels(kVoxel)));
  fields.sharp = withSharpEdges(fields.bricks, mesh, kAngle, kVoxel).field;
  return fields;
}

double angle(const Vec3& a, const Vec3& b) {
  return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) / kDegree;
}

/// The true can; the facets of 0.6 mm deviate from it by 3 um.
FieldPtr trueCan() { return cylinder(Vec3(0.0), Vec3(0.0, 0.0, 1.0), kRadius, 2.0 * kHalf); }

TEST(SharpEdges, ARimIsWhereItIsAndHasItsNormals) {
  const Fields fields = fieldsOf(can(160));
  const FieldPtr truth = trueCan();
  double place[2] = {0.0, 0.0};
  double normal[2] = {0.0, 0.0};
  for (int n = 0; n < 4000; ++n) {
    const double turn = n * 0.61;
    const Vec3 out(std::cos(turn), std::sin(turn), 0.0);
    const double along = (n % 40 - 20) * 0.05 * kMm;  // up to a voxel and a half beside the rim
    const bool on_top = along < 0.0;
    const Vec3 at = on_top ? (kRadius + along) * out + Vec3(0.0, 0.0, kHalf)
                           : kRadius * out + Vec3(0.0, 0.0, kHalf - along);
    const Vec3 wanted = on_top ? Vec3(0.0, 0.0, 1.0) : out;
    const Field* const both[] = {fields.bricks.get(), fields.sharp.get()};
    for (int i = 0; i < 2; ++i) {
      place[i] = std::max(place[i], std::abs(both[i]->value(at) - truth->value(at)));
      // Within a tenth of a voxel of the edge itself, the normal of either side is right.
      if (std::abs(along) < 0.1 * kVoxel) continue;
      const FieldSample here = both[i]->sample(at + 0.02 * kVoxel * wanted);
      normal[i] = std::max(normal[i], angle(here.gradient, wanted));
    }
  }
  std::printf("rim at voxels of 0.5 mm: bricks %.3f mm, %.1f degree; sharp %.4f mm, %.2f degree\n",
              place[0] * 1e3, normal[0], place[1] * 1e3, normal[1]);
  // The error of the facets: R (1 - cos(pi / 160)), and half the turn between two of them.
  EXPECT_LE(place[1], kRadius * (1.0 - std::cos(std::numbers::pi / 160.0)) + 1e-9);
  EXPECT_LE(normal[1], 180.0 / 160.0 + 1e-3);
  EXPECT_GT(normal[0], 10.0);
}

TEST(SharpEdges, BricksAndTrianglesJoinWithoutAStep) {
  const Fields fields = fieldsOf(can(320));
  // Away from the rim across the transition, on both faces: value and gradient change no more than
  // the triangles' own facets make them (half the turn between two of them, in a step).
  double step = 0.0;
  double turn = 0.0;
  for (int line = 0; line < 50; ++line) {
    const double a = 0.1234 * line;
    const Vec3 out(std::cos(a), std::sin(a), 0.0);
    for (const bool on_top : {false, true}) {
      FieldSample before{};
      for (int n = 0; n <= 600; ++n) {
        const double along = 0.005 * kMm * n;
        const Vec3 at = on_top ? (kRadius - along) * out + Vec3(0.0, 0.0, kHalf)
                               : kRadius * out + Vec3(0.0, 0.0, kHalf - along);
        const FieldSample here = fields.sharp->sample(at);
        if (n > 20) {  // a fifth of a voxel from the rim
          step = std::max(step, std::abs(here.value - before.value));
          turn = std::max(turn, angle(here.gradient, before.gradient));
        }
        before = here;
      }
    }
  }
  std::printf("across the join, 5 um at a time: %.2e mm, %.3f degree\n", step * 1e3, turn);
  EXPECT_LE(step, 1e-3 * kVoxel);
  EXPECT_LE(turn, 180.0 / 320.0);
}

TEST(SharpEdges, ValueAndGradientAgree) {
  const Fields fields = fieldsOf(can(160));
  std::mt19937 random(7);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  double off = 0.0;
  for (int n = 0; n < 20000; ++n) {
    const double a = 3.2 * any(random);
    const Vec3 rim(kRadius * std::cos(a), kRadius * std::sin(a), kHalf);
    const Vec3 p = rim + 6.0 * kVoxel * Vec3(any(random), any(random), any(random));
    const FieldSample here = fields.sharp->sample(p);
    if (!here.in_band) continue;
    EXPECT_EQ(fields.sharp->jet(p).value, here.value);
    const Vec3 d = 1e-3 * kVoxel * Vec3(any(random), any(random), any(random));
    const FieldSample ahead = fields.sharp->sample(p + d);
    const FieldSample behind = fields.sharp->sample(p - d);
    // Exact values end where the band ends: beyond it, a value is only a lower bound of the
    // distance.
    if (!ahead.in_band || !behind.in_band) continue;
    const double change = ahead.value - behind.value;
    EXPECT_LE(std::abs(change), fields.sharp->lipschitz() * 2.0 * glm::length(d) * (1.0 + 1e-6));
    if (std::abs(change - 2.0 * glm::dot(here.gradient, d)) > 0.02 * glm::length(d)) off += 1.0;
  }
  // Only if the difference crosses a fold inside the solid, or the side of a facet.
  EXPECT_LT(off, 0.01 * 20000);
}

TEST(SharpEdges, WithoutSharpEdgesNothingChanges) {
  const Mesh mesh = ballMesh(Vec3(0.0), 10 * kMm, 4);
  const FieldPtr bricks = gridField(bakeMesh(mesh, voxels(kVoxel)));
  EXPECT_EQ(withSharpEdges(bricks, mesh, kAngle, kVoxel).field, bricks);
}

TEST(SharpEdges, WhatIsNotOneClosedSurfaceIsRefused) {
  const auto code = [](const Mesh& mesh, const Mesh& broken) -> std::string {
    try {
      const FieldPtr bricks = gridField(bakeMesh(mesh, voxels(kVoxel)));
      static_cast<void>(withSharpEdges(bricks, broken, kAngle, kVoxel));
    } catch (const Error& error) {
      return error.problem().code;
    }
    return "none";
  };
  const Mesh cube = boxMesh(Vec3(0.0), Vec3(15 * kMm));
  Mesh open = cube;
  open.triangles.pop_back();
  EXPECT_EQ(code(cube, open), "mesh.sharp_open");
  // Small boxes: within five voxels of every edge there is a wall of the other box, inside.
  const Vec3 small(4 * kMm);
  const Mesh overlapping = together(boxMesh(Vec3(0.0), small), boxMesh(Vec3(1 * kMm), small));
  EXPECT_EQ(code(overlapping, overlapping), "mesh.sharp_inner");
}

TEST(SharpEdges, AWallWithinTheSolidBesideASharpEdgeIsNotFelt) {
  // The ball is inside the can, three and a half voxels from its rim, deeper than the grid rounds
  // anything off: such a separate part is left out.
  const Vec3 within(13.4 * kMm, 0.0, 8.4 * kMm);
  const Fields fields = fieldsOf(together(can(160), ballMesh(within, 0.4 * kMm, 2)));
  for (int n = 0; n < 100; ++n) {
    const Vec3 p = within + 0.4 * kMm * Vec3(std::cos(n), std::sin(n), 0.0);
    EXPECT_LT(fields.sharp->value(p), -1.0 * kMm) << "the can's own walls are 1.2 mm and more away";
  }
}

TEST(SharpEdges, BesideAWallThatPassesThroughAnotherTheGridAnswers) {
  // The ball passes through the side of the can just below its rim; the rim itself stays outside
  // the ball.
  const Vec3 middle(15.0 * kMm, 0.0, 7.0 * kMm);
  const Mesh mesh = together(can(160), ballMesh(middle, 2.0 * kMm, 3));
  const FieldPtr bricks = gridField(bakeMesh(mesh, voxels(kVoxel)));
  const SharpField sharp = withSharpEdges(bricks, mesh, kAngle, kVoxel);
  EXPECT_EQ(sharp.edges, 2U * 160U);
  EXPECT_GT(sharp.left_to_grid, 0U);
  EXPECT_LT(sharp.left_to_grid, 40U);
  EXPECT_LT(glm::length(sharp.place - middle), 2.5 * kMm + 5.0 * kVoxel);
  // The part of the ball inside the can, and of the can inside the ball, is never felt; a tolerance
  // of 0.2 mm covers the grid's rounding of the crease between them.
  for (int n = 0; n < 2000; ++n) {
    const Vec3 way(std::cos(n) * std::sin(0.7 * n), std::sin(n) * std::sin(0.7 * n),
                   std::cos(0.7 * n));
    const Vec3 p = middle + 2.0 * kMm * way;
    const FieldSample grid = bricks->sample(p);
    if (!grid.in_band || grid.value > -0.5 * kVoxel) continue;
    EXPECT_LT(sharp.field->value(p), -0.2 * kMm) << p.x << " " << p.y << " " << p.z;
  }
  // Away from the ball the rim is exact.
  const Vec3 rim(-kRadius, 0.0, kHalf);
  EXPECT_NEAR(sharp.field->value(rim + Vec3(-0.3 * kMm, 0.0, 0.4 * kMm)), 0.5 * kMm, 4e-6);
  // If no sharp edge is near, a ball through the side does no harm: the grid answers there anyway.
  const Mesh aside = together(can(160), ballMesh(Vec3(15.0, 0.0, 0.0) * kMm, 3.0 * kMm, 3));
  const FieldPtr others = gridField(bakeMesh(aside, voxels(kVoxel)));
  EXPECT_EQ(withSharpEdges(others, aside, kAngle, kVoxel).left_to_grid, 0U);
}

TEST(SharpEdges, PartsThatAreInsideOutOrWithinOthersAreTheSolidThatWasBaked) {
  // A can with a cavity, and a cube beside it.
  const Mesh hollow = together(can(160), boxMesh(Vec3(0.0), Vec3(8 * kMm)), true);
  const Vec3 beside(40 * kMm, 0.0, 0.0);
  const Fields clean = fieldsOf(together(hollow, boxMesh(beside, Vec3(10 * kMm))));
  // The same with the cube inside out, and with a wall inside the can's solid that has sharp edges
  // of its own.
  const Mesh wall = boxMesh(Vec3(9.5 * kMm, 0.0, 0.0), Vec3(4 * kMm));
  const Fields dirty =
      fieldsOf(together(together(hollow, boxMesh(beside, Vec3(10 * kMm)), true), wall));
  std::mt19937 random(9);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  int near = 0;
  for (int n = 0; n < 40000; ++n) {
    const Vec3 p = (n % 2 == 0 ? Vec3(0.0) : beside) +
                   Vec3(any(random), any(random), any(random)) * Vec3(18 * kMm, 18 * kMm, 13 * kMm);
    const FieldSample wanted = clean.sharp->sample(p);
    if (!wanted.in_band || std::abs(wanted.value) > 2.0 * kVoxel) continue;
    ++near;
    const FieldSample here = dirty.sharp->sample(p);
    ASSERT_TRUE(here.in_band);
    ASSERT_NEAR(here.value, wanted.value, 1e-3 * kVoxel);
  }
  EXPECT_GT(near, 2000);
  // The value is right inside the cube near one of its edges, and outside it.
  const Vec3 edge = beside + Vec3(5 * kMm, 5 * kMm, 0.0);
  EXPECT_NEAR(dirty.sharp->value(edge - Vec3(0.2 * kMm, 0.2 * kMm, 0.0)), -0.2 * kMm, 1e-9);
  EXPECT_NEAR(dirty.sharp->value(edge + Vec3(0.3 * kMm, 0.4 * kMm, 0.0)), 0.5 * kMm, 1e-9);
}

TEST(SharpEdgesContact, AroundTheRimOfACanAsAroundTheTrueOne) {
  const Fields fields = fieldsOf(can(320));
  Drive sharp(sceneOfSolid(fields.sharp));
  Drive rounded(sceneOfSolid(fields.bricks));
  Drive truth(sceneOfSolid(trueCan()));
  // The hand goes over the rim from the side to the top, a millimeter deep, 0.1 mm per tick, at 40
  // places around the can.
  double worst[2] = {0.0, 0.0};
  int contacts = 0;
  for (int line = 0; line < 40; ++line) {
    const double a = 0.157 * line;
    const Vec3 out(std::cos(a), std::sin(a), 0.0);
    for (int n = 0; n <= 80; ++n) {
      const double t = 0.1 * kMm * n;
      const Vec3 hip = n < 40 ? (kRadius - 1 * kMm) * out + Vec3(0.0, 0.0, kHalf - 4 * kMm + t)
                              : (kRadius - 1 * kMm - (t - 4 * kMm)) * out + Vec3(0.0, 0.0, kHalf);
      const TickResult wanted = truth.to(hip - Vec3(0.0, 0.0, 1 * kMm));
      const TickResult got[] = {rounded.to(hip - Vec3(0.0, 0.0, 1 * kMm)),
                                sharp.to(hip - Vec3(0.0, 0.0, 1 * kMm))};
      if (!wanted.contact) continue;
      ++contacts;
      for (int i = 0; i < 2; ++i) {
        worst[i] = std::max(worst[i], glm::distance(got[i].proxy, wanted.proxy));
      }
    }
    const Vec3 away(0.0, 0.0, 30 * kMm);
    (void)truth.to(away);
    (void)sharp.to(away);
    (void)rounded.to(away);
    const Vec3 start = 30 * kMm * out;
    (void)truth.to(start);
    (void)sharp.to(start);
    (void)rounded.to(start);
  }
  std::printf("proxy over a rim, %d ticks: bricks %.3f mm off, sharp %.4f mm\n", contacts,
              worst[0] * 1e3, worst[1] * 1e3);
  EXPECT_GT(contacts, 1000);
  EXPECT_LT(worst[1], 0.25 * kMm);
  EXPECT_LT(worst[1], worst[0]);
}

}  // namespace
}  // namespace palpate::vdb
