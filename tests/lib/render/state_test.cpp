// How content fades at openings, a tick with many crossings, and where a scene starts.

#include <gtest/gtest.h>

#include <cmath>

#include "lib/render/drive.h"
#include "palpate/fields/implicit.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

TEST(Content, IsFullBehindAValveThatHasShut) {
  std::string text = containerText();
  text.replace(text.find("on: brim"), 8, "on: brim, direction: in");
  Drive drive(sceneOf(text));
  (void)drive.walk(mm(0, 0, 30));
  (void)drive.walk(mm(0, 0, 5));
  ASSERT_EQ(drive.region(), "liquid");
  (void)drive.walk(mm(0, 0, 16), 0.1e-3);  // against the shut valve, 1 mm deep
  ASSERT_EQ(drive.region(), "liquid");
  const TickResult& out = drive.to(mm(0.1, 0, 16));  // 0.1 m/s along the valve
  EXPECT_NEAR(out.force.x, -4.0 * 0.1, 1e-9);
  EXPECT_NEAR(out.force.z, -1500.0 * 1e-3, 1e-6);
}

TEST(Content, DoesNotJumpFromTheMouthToTheWallBesideIt) {
  Drive drive(sceneOf(R"(
palpate: 1
length: mm
fields: {gate: {sphere: {center: [0, 0, 40], radius: 10}}}
materials: {glass: {stiffness: 1500 N/m}, syrup: {viscosity: 4 N.s/m}}
layers: [{name: liquid, inside: {sphere: {center: [0, 0, 0], radius: 40}}, content: syrup, wall: glass}]
ports: [{name: mouth, between: [outside, liquid], where: gate}]
)"));
  (void)drive.walk(mm(0, 0, 60));
  (void)drive.walk(mm(0, 0, 39.95));
  ASSERT_EQ(drive.region(), "liquid");
  double last = 0.0;
  double largest = 0.0;
  for (int i = 0; i <= 400; ++i) {
    const double angle = 0.4 * i / 400;
    const TickResult& out = drive.to(0.03995 * Vec3(std::sin(angle), 0, std::cos(angle)));
    const double drag = glm::length(out.force) / (4.0 * 0.03995 * 0.4 / 400 / 1e-3);
    if (i > 1) {
      EXPECT_LE(std::fabs(drag - last), 0.04e-3 / 0.25e-3 + 1e-3) << i;
    }
    last = drag;
    largest = std::max(largest, drag);
  }
  EXPECT_NEAR(largest, 1.0, 1e-3) << "beside the mouth the drag is there in full";
}

TEST(Events, NoneOfManyCrossingsIsLost) {
  // Forty nested shells, with a port between each two: where a tick's list or budget is full, the
  // proxy waits for the next tick.
  std::string text = "palpate: 1\nlength: mm\nlayers:\n";
  std::string ports = "ports: [{name: p0, between: [outside, s0]}";
  for (int i = 0; i < 40; ++i) {
    const std::string own = std::to_string(i);
    text += "  - {name: s" + own +
            ", inside: {sphere: {center: [0, 0, 0], radius: " + std::to_string(41 - i) + "}}}\n";
    if (i > 0) {
      ports += ", {name: p" + own + ", between: [s" + std::to_string(i - 1) + ", s" + own + "]}";
    }
  }
  Drive drive(sceneOf(text + ports + "]\n"));
  (void)drive.to(mm(-50, 0.3, 0.2));
  int passed = 0;
  for (int tick = 0; tick < 4; ++tick) {
    const TickResult& out = drive.to(mm(0, 0.3, 0.2));
    for (int k = 0; k < out.event_count; ++k, ++passed) {
      EXPECT_EQ(out.events[static_cast<std::size_t>(k)], passed) << "in order, none left out";
    }
  }
  EXPECT_EQ(passed, 40);
  EXPECT_EQ(drive.region(), "s39");
}

TEST(Start, TheNearestPointOfSimpleRegions) {
  Random random(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 p = random.in({Vec3(-0.1), Vec3(0.1)});
    const Vec3 half(0.03, 0.02, 0.01);
    Drive in_box(
        sceneOf("palpate: 1\nlength: mm\nlayers: [{name: room, inside: {box: {center: [0, 0, 0], "
                "size: [60, "
                "40, 20]}}}]\nstart: {region: room}\n"));
    EXPECT_TRUE(isNear(in_box.to(p).proxy, glm::clamp(p, -half, half), 1e-8)) << i;
    EXPECT_EQ(in_box.region(), "room");
    Drive around(
        sceneOf("palpate: 1\nlength: mm\nlayers: [{name: ball, inside: {sphere: {center: [0, 0, "
                "0], radius: "
                "80}}}]\n"));
    const double r = std::max(glm::length(p), 0.08);
    EXPECT_TRUE(isNear(around.to(p).proxy, r * glm::normalize(p), 1e-8)) << i;
    EXPECT_EQ(around.region(), "outside");
  }
}

TEST(LipschitzDomain, OutsideOfItTheBoundIsNotTrusted) {
  // A ball whose value is quadratic: the bound of 1 holds only within 20 mm.
  UserFunction function;
  function.value = [](const Vec3& p) { return (glm::dot(p, p) - 1e-4) / 0.04; };
  function.bounds = {Vec3(-0.01), Vec3(0.01)};
  function.lipschitz = 1.0;
  function.lipschitz_domain = {Vec3(-0.01), Vec3(0.01)};
  function.feature_size = 0.01;
  SceneDescription description;
  LayerDescription layer;
  layer.name = "ball";
  layer.inside = std::make_shared<FieldSource>(userField(function));
  description.layers.push_back(layer);
  for (const double from : {0.03, 0.1, 0.5, 3.0}) {
    Drive drive(compile(description));
    (void)drive.to(Vec3(-from, 0.001, 0.0));
    // If the bound were trusted out there, the value at the start would permit the whole way into
    // the ball.
    const TickResult& out = drive.to(Vec3(-0.002, 0.001, 0.0));
    EXPECT_EQ(out.region, kOutside) << from;
    EXPECT_TRUE(isNear(out.proxy, 0.01 * glm::normalize(Vec3(-2, 1, 0)), 1e-7)) << from;
  }
}

}  // namespace
}  // namespace palpate::test
