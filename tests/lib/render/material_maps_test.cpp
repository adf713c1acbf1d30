// Parameters that differ from place to place: the hand feels the map's value at the proxy.

#include <cmath>
#include <numbers>

#include "lib/render/drive.h"
#include "palpate/fields/primitives.h"
#include "support/alloc_guard.h"
#include "support/error_of.h"
#include "support/test_maps.h"

namespace palpate::test {
namespace {

using testing::flatMap;
using testing::linearMap;

/// The half-space z < 0 as the layer `body`, with `material` for its wall and content.
SceneDescription body(const Material& material) {
  SceneDescription description;
  description.materials = {material};
  LayerDescription layer;
  layer.name = "body";
  layer.inside = std::make_shared<FieldSource>(halfSpace(Vec3(0.0), Vec3(0, 0, 1)));
  layer.wall.material = material.name;
  layer.content = material.name;
  description.layers = {layer};
  return description;
}

Material named(const std::string& name) {
  Material material;
  material.name = name;
  material.stiffness = 1000.0;
  return material;
}

TEST(MaterialMaps, FlatMapsFeelAsTheirConstantsBitForBit) {
  Material plain = named("skin");
  plain.damping = 2.0;
  plain.friction = {0.4, 0.3};
  plain.texture = {0.2e-3, 3e-3};
  plain.viscosity = 3.0;
  Material mapped = plain;
  mapped.stiffness = flatMap(1000.0);
  mapped.damping = flatMap(2.0);
  mapped.friction = {flatMap(0.4), flatMap(0.3)};
  mapped.texture.amplitude = flatMap(0.2e-3);
  mapped.viscosity = flatMap(3.0);
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    SceneDescription constants = body(plain);
    SceneDescription maps = body(mapped);
    if (kind == RendererKind::kConstraint) {
      for (SceneDescription* d : {&constants, &maps}) {
        PortDescription port;
        port.name = "cut";
        port.from = "outside";
        port.to = "body";
        d->ports = {port};
      }
      constants.ports[0].opens_at = 2.5;
      maps.ports[0].opens_at = flatMap(2.5);
    }
    Drive a(compile(constants), kind);
    Drive b(compile(maps), kind);
    bool was_inside = false;
    for (int i = 0; i < 4000; ++i) {
      const double s = 0.001 * i;
      const Vec3 hip(0.03 * std::sin(5.0 * s), 0.02 * std::cos(3.0 * s), 3e-3 * std::cos(2.0 * s));
      const TickResult one = a.to(hip);
      const TickResult two = b.to(hip);
      ASSERT_EQ(one.force, two.force) << i;
      ASSERT_EQ(one.proxy, two.proxy) << i;
      ASSERT_EQ(one.region, two.region) << i;
      was_inside = was_inside || one.region != kOutside;
    }
    EXPECT_EQ(was_inside, kind == RendererKind::kConstraint) << "the port opened";
  }
}

TEST(MaterialMaps, StiffnessIsThatOfThePlaceTouched) {
  Material wall = named("skin");
  wall.stiffness = linearMap(1000.0, {2e4, 0, 0}, {200.0, 1800.0});
  Drive hand(compile(body(wall)));
  for (const double x : {-0.06, -0.03, 0.0, 0.01, 0.035, 0.05}) {
    (void)hand.to({x, 0, 0.01});
    const TickResult out = hand.walk({x, 0, -1e-3});
    const double expected = std::clamp(1000.0 + 2e4 * x, 200.0, 1800.0);
    EXPECT_NEAR(out.force.z, expected * 1e-3, 1e-9) << x;
    (void)hand.walk({x, 0, 0.01});
  }
}

TEST(MaterialMaps, DampingAndViscosityAreThoseOfThePlace) {
  Material fluid = named("gel");
  fluid.damping = linearMap(2.0, {50, 0, 0}, {0.0, 4.0});
  fluid.viscosity = linearMap(3.0, {0, 0, 100}, {0.0, 3.0});
  SceneDescription description = body(fluid);
  Drive hand(compile(description));
  (void)hand.to({0.02, 0, -1e-3});
  const TickResult still = hand.last();
  const TickResult moving = hand.to({0.02, 0.1e-3, -1e-3});  // 0.1 m/s along y
  // The proxy is at x = 20 mm: 3 N s/m against 0.1 m/s.
  EXPECT_NEAR(moving.force.y - still.force.y, -0.3, 1e-9);

  description.start_region = "body";
  Drive diver(compile(description));
  (void)diver.to({0, 0, -0.02});
  EXPECT_NEAR(diver.to({0.1e-3, 0, -0.02}).force.x, -0.1, 1e-12) << "1 N s/m at 20 mm below";
  (void)diver.to({0, 0, -0.025});
  EXPECT_NEAR(diver.to({0.1e-3, 0, -0.025}).force.x, -0.05, 1e-12) << "0.5 N s/m at 25 mm";
}

TEST(MaterialMaps, FrictionIsThatOfThePlace) {
  Material wall = named("skin");
  wall.friction = {linearMap(0.3, {5, 0, 0}, {0.1, 0.5}), 0.1};
  Drive hand(compile(body(wall)));
  for (const double x : {-0.03, 0.0, 0.03}) {
    (void)hand.to({x, 0, 0.01});
    (void)hand.walk({x, 0, -2e-3});
    // The proxy stays where it is up to the cone: the largest lag is static * depth.
    double lag = 0.0;
    for (int i = 1; i < 2000; ++i) {
      const TickResult out = hand.to({x, 1e-6 * i, -2e-3});
      if (out.proxy.y > 1e-9) break;
      lag = 1e-6 * i;
    }
    EXPECT_NEAR(lag, (0.3 + 5.0 * x) * 2e-3, 2e-6) << x;
    (void)hand.walk({x, 0, 0.01});
  }
}

TEST(MaterialMaps, KineticFrictionNeverExceedsStatic) {
  Material wall = named("skin");
  // At x = -30 mm the kinetic map has 0.25, more than the static one, which has 0.15.
  wall.friction = {linearMap(0.3, {5, 0, 0}, {0.1, 0.5}), flatMap(0.25)};
  wall.friction.static_ratio = linearMap(0.3, {5, 0, 0}, {0.1, 0.5});
  wall.friction.kinetic_ratio = linearMap(0.25, {0, 0, 0}, {0.1, 0.25});
  Drive hand(compile(body(wall)));
  (void)hand.to({-0.03, 0, 0.01});
  (void)hand.walk({-0.03, 0, -2e-3});
  for (int i = 1; i < 400; ++i) (void)hand.to({-0.03, 1e-5 * i, -2e-3});
  EXPECT_NEAR(-hand.last().force.y / hand.last().force.z, 0.15, 1e-6);
}

TEST(MaterialMaps, TextureIsAsHighAsThePlaceHasIt) {
  Material wall = named("file");
  wall.texture = {linearMap(0.05e-3, {1e-3, 0, 0}, {0.0, 0.1e-3}), 2e-3};
  Drive hand(compile(body(wall)));
  for (const double x : {-0.05, -0.02, 0.02, 0.05}) {
    (void)hand.to({x, 0, 0.01});
    const double force = hand.walk({x, 0.5e-3, -1e-3}).force.z;
    const double k = 2.0 * std::numbers::pi / 2e-3;
    const double wave = (std::sin(k * x) + std::sin(k * 0.5e-3)) / 3.0;
    const double amplitude = std::clamp(0.05e-3 + 1e-3 * x, 0.0, 0.1e-3);
    // The proxy is on the plane to 1e-9 m, and the waves along z are zero there.
    EXPECT_NEAR(force, 1000.0 * (1e-3 + amplitude * wave), 2e-8) << x;
    (void)hand.walk({x, 0, 0.01});
  }
}

PortDescription cut() {
  PortDescription port;
  port.name = "cut";
  port.from = "outside";
  port.to = "body";
  return port;
}

TEST(MaterialMaps, APortOpensAtTheForceOfThePlace) {
  SceneDescription description = body(named("skin"));
  PortDescription port = cut();
  port.opens_at = linearMap(2.0, {50, 0, 0}, {0.0, 4.0});
  port.back = linearMap(0.5, {10, 0, 0}, {0.1, 1.0});
  description.ports = {port};
  const ScenePtr scene = compile(description);
  for (const double x : {-0.05, -0.02, 0.0, 0.02, 0.05}) {
    Drive hand(scene);
    (void)hand.to({x, 0, 0.001});
    double most = 0.0;
    for (int i = 0; i < 6000 && hand.region() == "outside"; ++i) {
      most = std::max(most, hand.last().force.z);
      (void)hand.to({x, 0, -1e-6 * i});
    }
    EXPECT_EQ(hand.region(), "body") << x;
    EXPECT_NEAR(most, std::clamp(2.0 + 50.0 * x, 0.0, 4.0), 2e-3) << x;
    double back = 0.0;
    (void)hand.to({x, 0, -1e-6});
    for (int i = 0; i < 6000 && hand.region() == "body"; ++i) {
      back = std::max(back, -hand.last().force.z);
      (void)hand.to({x, 0, 1e-6 * i});
    }
    EXPECT_EQ(hand.region(), "outside") << x;
    EXPECT_NEAR(back, std::max(0.1, 0.5 + 10.0 * x), 2e-3) << x;
  }
}

TEST(MaterialMaps, AHoleReopensAtTheForceOfThePlaceWhereItWasMade) {
  SceneDescription description = body(named("skin"));
  PortDescription port = cut();
  port.opens_at = 3.0;
  port.hole_radius = 2e-3;
  port.reopens_at = linearMap(1.0, {50, 0, 0}, {0.0, 4.0});
  description.ports = {port};
  const ScenePtr scene = compile(description);
  // The force [N] at which the wall ruptures at `x`, from outside.
  const auto gives_way = [](Drive& hand, double x) {
    (void)hand.walk({x, 0, 1e-3});
    double most = 0.0;
    for (int i = 0; i < 6000 && hand.region() == "outside"; ++i) {
      (void)hand.to({x, 0, -1e-6 * i});
      if (hand.region() == "outside") most = std::max(most, hand.last().force.z);
    }
    EXPECT_EQ(hand.region(), "body") << x;
    return most;
  };
  for (const double x : {-0.03, -0.01, 0.0, 0.02}) {
    Drive hand(scene);
    (void)hand.to({x, 0, 0.001});
    EXPECT_NEAR(gives_way(hand, x), 3.0, 2e-3) << x;
    // The hand goes out, and in again beside the middle of the hole: the hole keeps the force of
    // the place where it was made.
    (void)hand.walk({x, 0, 8e-3});
    ASSERT_EQ(hand.region(), "outside");
    EXPECT_NEAR(gives_way(hand, x + 1e-3), std::clamp(1.0 + 50.0 * x, 0.0, 4.0), 2e-3) << x;
    (void)hand.walk({x + 1e-3, 0, 8e-3});
    ASSERT_EQ(hand.region(), "outside");
    EXPECT_NEAR(gives_way(hand, x + 9e-3), 3.0, 2e-3) << "no hole there: " << x;
  }
}

TEST(MaterialMaps, TheMediumFlowsAsTheMapOfThePlaceSays) {
  Material stream = named("stream");
  stream.viscosity = 3.0;
  // The flow has components along two axes, with negative values too; the third component is zero.
  stream.flow = {linearMap(0.1, {20, 0, 0}, {-1.0, 1.0}), linearMap(-0.05, {0, 0, 10}, {-2.0, 2.0}),
                 0.0};
  for (const RendererKind kind : {RendererKind::kConstraint, RendererKind::kPaper}) {
    SceneDescription description = body(stream);
    PortDescription port;  // always open
    port.name = "mouth";
    port.from = "outside";
    port.to = "body";
    description.ports = {port};
    Drive hand(compile(description), kind);
    (void)hand.to({0, 0, 0.002});
    (void)hand.walk({0, 0, -0.01});
    ASSERT_EQ(hand.region(), "body");
    for (int i = 0; i < 200; ++i) {
      const Vec3 p(0.03 * std::sin(0.1 * i), 0.01 * std::cos(0.2 * i),
                   -0.02 - 0.01 * std::sin(0.3 * i));
      (void)hand.walk(p);
      // At rest, only the push of the medium is left.
      const TickResult tick = hand.to(p);
      const Vec3 flow(0.1 + 20.0 * p.x, -0.05 + 10.0 * p.z, 0.0);
      EXPECT_TRUE(isNear(tick.force, 3.0 * flow, 1e-12)) << i;
    }
  }
}

TEST(MaterialMaps, AFlowOfOneValueIsFeltAsTheConstantBitForBit) {
  Material plain = named("stream");
  plain.viscosity = 2.0;
  plain.flow = Vec3(0.1, -0.2, 0.3);
  Material mapped = plain;
  mapped.flow = {flatMap(0.1), flatMap(-0.2), flatMap(0.3)};
  Drive one(compile(body(plain)));
  Drive two(compile(body(mapped)));
  for (int i = 0; i < 500; ++i) {
    const Vec3 p(1e-3 * i, -2e-4 * i, 3e-3 * std::cos(0.1 * i));
    EXPECT_EQ(one.to(p).force, two.to(p).force);
  }
}

TEST(MaterialMaps, OnePressedFacetOpensWhereItsForceFallsWhileSliding) {
  // Pressed with 2 N and drawn along the wall: it ruptures where the map has fallen to that.
  SceneDescription description = body(named("skin"));
  PortDescription port = cut();
  port.opens_at = linearMap(3.0, {-50, 0, 0}, {0.5, 6.0});
  description.ports = {port};
  Drive hand(compile(description));
  (void)hand.to({0, 0, 0.001});
  (void)hand.walk({0, 0, -2e-3});
  EXPECT_EQ(hand.region(), "outside");
  double x = 0.0;
  while (hand.region() == "outside" && x < 0.05) (void)hand.to({x += 1e-5, 0, -2e-3});
  EXPECT_NEAR(x, 0.02, 2e-5);
}

TEST(MaterialMaps, WhatAParameterCannotBeIsRefusedAtSetUp) {
  const auto code = [](const Material& material) {
    return errorOf([&] { (void)compile(body(material)); }).problem().code;
  };
  Material wall = named("skin");
  wall.stiffness = linearMap(0.0, {1, 0, 0}, {0.0, 900.0});
  EXPECT_EQ(code(wall), "scene.wall_without_stiffness") << "0 somewhere";
  wall.stiffness = linearMap(0.0, {1, 0, 0}, {-1.0, 900.0});
  EXPECT_EQ(code(wall), "scene.parameter");
  wall.stiffness = linearMap(0.0, {1, 0, 0}, {1.0, INFINITY});
  EXPECT_EQ(code(wall), "scene.parameter");
  wall.stiffness = 900.0;
  wall.friction = {flatMap(0.2), flatMap(0.3)};
  EXPECT_EQ(code(wall), "scene.parameter");
  wall.friction = {};
  wall.texture = {linearMap(0.0, {1, 0, 0}, {0.0, 1.0e-3}), 6e-3};
  EXPECT_EQ(code(wall), "scene.texture");
  wall.texture = {};
  wall.damping = -1.0;
  EXPECT_EQ(code(wall), "scene.parameter");

  wall.damping = 0.0;
  wall.flow = {0.0, linearMap(0.0, {1, 0, 0}, {-INFINITY, 1.0}), 0.0};
  EXPECT_EQ(code(wall), "scene.parameter");
  wall.flow = {};

  SceneDescription description = body(named("skin"));
  PortDescription port = cut();
  port.back = flatMap(-1.0);
  description.ports = {port};
  EXPECT_EQ(errorOf([&] { (void)compile(description); }).problem().code, "scene.parameter");
  description.ports[0].back = {};
  description.ports[0].opens_at = 2.0;
  description.ports[0].hole_radius = 1e-3;
  description.ports[0].reopens_at = linearMap(0.0, {1, 0, 0}, {-0.1, 1.0});
  EXPECT_EQ(errorOf([&] { (void)compile(description); }).problem().code, "scene.parameter");
}

TEST(MaterialMaps, TheTickAllocatesNothing) {
  Material wall = named("skin");
  wall.stiffness = linearMap(1000.0, {2e4, 0, 0}, {200.0, 1800.0});
  wall.friction = {linearMap(0.3, {5, 0, 0}, {0.1, 0.5}), 0.1};
  SceneDescription description = body(wall);
  PortDescription port = cut();
  port.opens_at = linearMap(2.0, {50, 0, 0}, {0.0, 4.0});
  description.ports = {port};
  Drive hand(compile(description));
  (void)hand.to({0, 0, 0.001});
  const testing::AllocGuard guard;
  for (int i = 0; i < 2000; ++i) {
    const double s = 0.005 * i;
    (void)hand.renderer().update({{0.04 * std::sin(s), 0.0, 4e-3 * std::cos(3.0 * s)}, Vec3(0.0)});
  }
  EXPECT_EQ(guard.violations(), 0);
}

}  // namespace
}  // namespace palpate::test
