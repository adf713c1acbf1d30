// Two regions that lead freely into each other both end at walls. At an edge formed by the two
// layers the hand draws the proxy from each region into the other: the proxy must cross once, and
// go on.

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// A solid wedge with its edge along y: it fills z < 0 and the space below a plane that falls by
/// `angle` [rad] beyond the edge, where `pit` begins. `opening` is between pit and outside.
ScenePtr wedge(double angle, const std::string& opening) {
  const std::string normal =
      "[" + std::to_string(-std::sin(angle)) + ", 0, " + std::to_string(-std::cos(angle)) + "]";
  return sceneOf(
      "palpate: 1\nlength: mm\nstart: {region: outside}\nlayers:\n"
      "  - {name: floor, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}}\n"
      "  - {name: pit, inside: {half_space: {point: [0, 0, 0], normal: " +
      normal + "}}}\n" + opening);
}

constexpr const char* kAbsent = "walls:\n  - {between: [outside, pit], wall: absent}\n";
constexpr const char* kPort = "ports:\n  - {name: p, between: [outside, pit]}\n";

/// [m] The place outside the wedge nearest to a hand at `x`, `z` [m], beyond the edge.
Vec3 nearestOnWedge(double angle, double x, double z) {
  const Vec3 down(std::cos(angle), 0.0, -std::sin(angle));
  const Vec3 hand(x, 0.0, z);
  if (glm::dot(hand, Vec3(std::sin(angle), 0.0, std::cos(angle))) >= 0.0) return hand;
  return std::max(0.0, glm::dot(hand, down)) * down;
}

/// Moves along z = -0.5 mm over the edge, then rests.
void expectOverTheEdge(const std::string& opening, double degrees, double offset) {
  const double angle = degrees * std::numbers::pi / 180.0;
  const auto renderer = makeRenderer(wedge(angle, opening));
  (void)renderer->update({mm(-2.0 + offset, 0, 0.1)});
  TickResult r;
  std::size_t passed = 0;
  const auto go = [&](double x) {
    r = renderer->update({mm(x, 0, -0.5)});
    passed += r.event_count;
    EXPECT_TRUE(r.settled) << degrees << " degrees, x " << x;
    const Vec3 due = 1000.0 * (r.proxy - mm(x, 0, -0.5));
    EXPECT_LT(glm::length(r.force - due), 1e-6) << degrees << " degrees, x " << x;
  };
  double x = -2.0 + offset;
  for (int i = 0; i < 23; ++i) go(x += 0.1);
  for (int i = 0; i < 5; ++i) go(x);
  const Vec3 want = nearestOnWedge(angle, 1e-3 * x, -0.5e-3);
  EXPECT_LT(glm::length(r.proxy - want), 1e-9) << degrees << " degrees, offset " << offset;
  EXPECT_LE(passed, 1U) << degrees << " degrees, offset " << offset;
}

TEST(EdgeOfTwoLayers, IsPassedIntoALayerWithoutAWall) {
  for (const double degrees : {10.0, 30.0, 45.0, 60.0, 80.0, 88.0}) {
    for (const double offset : {0.0, 0.017, 0.05, 0.083}) {
      expectOverTheEdge(kAbsent, degrees, offset);
    }
  }
}

TEST(EdgeOfTwoLayers, IsPassedThroughAnOpenPortOnce) {
  for (const double degrees : {10.0, 30.0, 45.0, 60.0, 80.0, 88.0}) {
    for (const double offset : {0.0, 0.017, 0.05, 0.083}) {
      expectOverTheEdge(kPort, degrees, offset);
    }
  }
}

// The proxy used to begin outside its region, at a corner of boxes, a cone and a half space, and
// felt nothing there.
TEST(EdgeOfTwoLayers, AStartAtACornerFindsItsPlace) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
start: {region: r0}
materials:
  m: {stiffness: 1000 N/m}
layers:
- name: r0
  inside:
    difference:
    - transform:
        field: {box: {center: [-3.1, 1.9, 1.3], size: [6.3, 8.3, 13.8]}}
        rotate: {axis: [0, 0.7, -0.7], degrees: 134.9}
        translate: [2.4, -1.0, -4.3]
    - transform:
        field: {box: {center: [-4.6, -0.7, 0.2], size: [9.2, 11.4, 6.5]}}
        rotate: {axis: [0, 0.2, -1.0], degrees: 121.8}
        translate: [2.5, -1.3, -4.7]
  wall: m
- name: r1
  inside: {cone: {base: [-6.2, -1.4, -10.0], axis: [0.6, -0.5, -0.6], radius: 12.1, height: 7.5}}
  wall: m
- name: r3
  inside: {half_space: {point: [2.4, -1.0, -4.3], normal: [0.0, 0.9, -0.4]}}
  wall: m
walls:
- {between: [r0, outside], wall: absent}
)");
  const auto renderer = makeRenderer(scene);
  const Vec3 hand = mm(0.6, 0.4, -4.2);
  TickResult r;
  for (int i = 0; i < 10; ++i) r = renderer->update({hand});
  EXPECT_TRUE(r.settled);
  EXPECT_TRUE(r.contact);
  EXPECT_LT(glm::length(r.force - 1000.0 * (r.proxy - hand)), 1e-6);
  // The force used to begin at 3.5 N.
  EXPECT_LT(glm::length(r.force), 2.0);
}

}  // namespace
}  // namespace palpate::test
