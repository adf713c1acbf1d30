// Layers that a scene does not need are not made: those beyond the device's workspace, and those
// that a probe never reaches.

#include "scene/need.h"

#include <gtest/gtest.h>

#include <cmath>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/scene_file.h"

namespace palpate {
namespace {

/// A registry whose `costly: {center, radius}` is a ball that counts as costly; it counts how often
/// it is made.
class Need : public ::testing::Test {
 protected:
  Need() {
    registry_.fields["costly"] = [this](MapReader& reader) {
      const Vec3 center = reader.requirePoint("center");
      const double radius = reader.requireLength("radius");
      return std::make_shared<FieldSource>(
          "costly",
          [this, center, radius](const Progress&) {
            ++made_;
            return sphere(center, radius);
          },
          [center, radius](const Progress&) {
            return Box3{center - Vec3(radius), center + Vec3(radius)};
          });
    };
  }
  SceneDescription read(const std::string& body) {
    return parseScene("palpate: 1\nlength: mm\n" + body, "test.yaml", registry_);
  }
  /// Names of the layers that were left out.
  static std::string leftOut(const Scene& scene) {
    std::string names;
    for (const Region& region : scene.regions()) {
      if (!region.left_out.empty()) names += (names.empty() ? "" : " ") + region.name;
    }
    return names;
  }

  SceneRegistry registry_;
  int made_ = 0;
};

/// Bone with marrow and a nail in it; both are enclosed unless a port leads there.
std::string bone(const std::string& more = {}) {
  return "layers:\n"
         "  - {name: bone, inside: {costly: {center: [0, 0, 0], radius: 40}}}\n"
         "  - {name: marrow, inside: {costly: {center: [0, 0, 0], radius: 20}}}\n"
         "  - {name: nail, inside: {sphere: {center: [0, 0, 0], radius: 3}}}\n" +
         more;
}

TEST_F(Need, WhatIsClosedInByWhatCannotBeEnteredIsNotMade) {
  const SceneDescription description = read(bone());
  const ScenePtr scene = compile(description);
  EXPECT_EQ(leftOut(*scene), "marrow");
  EXPECT_EQ(made_, 1);
  EXPECT_NE(scene->regions()[2].left_out.find("bone"), std::string::npos);
  EXPECT_EQ(scene->regions()[2].field, nullptr);
  EXPECT_FALSE(scene->regions()[2].reachable);
  EXPECT_EQ(scene->regionAt({0.01, 0.0, 0.0}), 1) << "its place belongs to what is around";
  EXPECT_EQ(scene->regionAt({0.0, 0.0, 0.0}), 3) << "what costs nothing stays";
}

TEST_F(Need, APortOrAnAbsentWallIntoItMakesIt) {
  for (const char* way :
       {"ports: [{name: p, between: [outside, bone]}]\n",
        "ports: [{name: p, between: [outside, \"*\"]}]\n",
        "walls: [{between: [outside, bone], wall: absent}]\n", "start: {region: bone}\n"}) {
    made_ = 0;
    EXPECT_EQ(leftOut(*compile(read(bone(way)))), "") << way;
    EXPECT_EQ(made_, 2) << way;
  }
  // A one-way port in the wrong direction: the layer still cannot be entered.
  made_ = 0;
  const SceneDescription one_way =
      read(bone("ports: [{name: p, between: [outside, bone], direction: out}]\n"));
  EXPECT_EQ(leftOut(*compile(one_way)), "marrow");
}

TEST_F(Need, APortThatNamesSeveralRegionsMakesThem) {
  for (const char* way : {"ports: [{name: p, between: [[nail, outside], bone]}]\n",
                          "walls: [{between: [[nail, outside], bone], wall: absent}]\n"}) {
    EXPECT_EQ(leftOut(*compile(read(bone(way)))), "") << way;
  }
}

TEST_F(Need, WhatOnlyPortsThatAreNeverDueLeadIntoIsNotMade) {
  // A hall that must be left to get to the bone: outside, no port counts as passed any more.
  const auto rooms = [&](const std::string& memory) {
    return read(memory +
                bone("  - {name: hall, inside: {sphere: {center: [100, 0, 0], radius: 9}}}\n"
                     "ports:\n"
                     "  - {name: in, between: [outside, hall]}\n"
                     "  - {name: p, between: [outside, bone], after: [in]}\n"));
  };
  EXPECT_EQ(leftOut(*compile(rooms(""))), "marrow");
  EXPECT_EQ(leftOut(*compile(rooms("memory: keep\n"))), "");
}

TEST_F(Need, WhatSticksOutIsMade) {
  for (const double x : {19.0, 21.0, 100.0}) {
    made_ = 0;
    const ScenePtr scene =
        compile(read("layers:\n"
                     "  - {name: bone, inside: {costly: {center: [0, 0, 0], radius: 40}}}\n"
                     "  - {name: marrow, inside: {costly: {center: [" +
                     std::to_string(x) + ", 0, 0], radius: 20}}}\n"));
    // The corners of its box are sqrt(20^2 + 20^2 + (x + 20)^2) from the middle: 48 mm for x = 19.
    EXPECT_EQ(leftOut(*scene), "") << x;
  }
  made_ = 0;
  const ScenePtr scene =
      compile(read("layers:\n"
                   "  - {name: bone, inside: {costly: {center: [0, 0, 0], radius: 40}}}\n"
                   "  - {name: marrow, inside: {costly: {center: [9, 0, 0], radius: 10}}}\n"));
  EXPECT_EQ(leftOut(*scene), "marrow") << "corners at 24 mm";
}

TEST_F(Need, ATunnelThatComesNearItMakesIt) {
  const std::string tunnel =
      "  - {name: tunnel, inside: {cylinder: {center: [0, 0, 30], axis: [0, 0, 1], radius: 5, "
      "height: 60}}}\n";
  EXPECT_EQ(leftOut(*compile(read(bone(tunnel)))), "marrow") << "shut";
  EXPECT_EQ(
      leftOut(*compile(read(bone(tunnel + "ports: [{name: p, between: [outside, tunnel]}]\n")))),
      "")
      << "its wall is touched from the tunnel";
}

TEST_F(Need, FromWithinOnlyWhatIsNearCounts) {
  // A probe that starts in a closed room never feels the house next door.
  const ScenePtr scene =
      compile(read("layers:\n"
                   "  - {name: room, inside: {costly: {center: [0, 0, 0], radius: 40}}}\n"
                   "  - {name: stove, inside: {costly: {center: [10, 0, 0], radius: 5}}}\n"
                   "  - {name: neighbor, inside: {costly: {center: [100, 0, 0], radius: 40}}}\n"
                   "start: {region: room}\n"));
  EXPECT_EQ(leftOut(*scene), "neighbor");
  EXPECT_EQ(made_, 2);
}

TEST_F(Need, BeyondTheDevicesWorkspaceNothingIsMade) {
  const auto scene = [&](const std::string& device) {
    made_ = 0;
    return compile(
        read("layers:\n"
             "  - {name: near, inside: {costly: {center: [0, 0, 0], radius: 40}}}\n"
             "  - {name: far, inside: {costly: {center: [300, 0, 0], radius: 40}}}\n"
             "ports: [{name: p, between: [outside, far]}, {name: q, between: [outside, near]}]\n" +
             device));
  };
  const std::string box = "workspace: {box: {center: [0, 0, 0], size: [100, 100, 100]}}";
  EXPECT_EQ(leftOut(*scene("")), "");
  EXPECT_EQ(leftOut(*scene("device: {" + box + "}\n")), "far");
  EXPECT_EQ(made_, 1);
  EXPECT_EQ(leftOut(*scene("device: {scale: 6, " + box + "}\n")), "");
  EXPECT_EQ(leftOut(*scene("device: {offset: [300, 0, 0], " + box + "}\n")), "near");
  EXPECT_EQ(leftOut(*scene("device: {clutch: true, " + box + "}\n")), "");
  // The port into a layer that was left out leads nowhere; the other port keeps its number.
  const ScenePtr made = scene("device: {" + box + "}\n");
  ASSERT_EQ(made->ports().size(), 2U);
  EXPECT_TRUE(made->passages().portsOf(kOutside).size() == 1);
  EXPECT_EQ(made->passages().portsOf(kOutside)[0], 1);
  EXPECT_EQ(made->device().reach().hi.x, 0.05);
  // A workspace that is long along the device's z axis, which a rotation maps to the world's x
  // axis.
  const std::string tall = "workspace: {box: {center: [0, 0, 150], size: [100, 100, 400]}}";
  EXPECT_EQ(leftOut(*scene("device: {" + tall + "}\n")), "far");
  EXPECT_EQ(leftOut(*scene("device: {rotate: {axis: [0, 1, 0], degrees: 90}, " + tall + "}\n")),
            "");
  EXPECT_EQ(leftOut(*scene("device: {rotate: {axis: [0, 1, 0], degrees: -90}, " + tall + "}\n")),
            "far");
}

TEST_F(Need, WhatIsFeltThroughAClosedWallIsMade) {
  // The skin cannot be entered, and the marrow is 20 mm below it.
  const auto body = [](double depth) {
    return "materials:\n  skin: {stiffness: 400 N/m, composite: {radius: 2, depth: " +
           std::to_string(depth) +
           "}}\n"
           "layers:\n"
           "  - {name: bone, inside: {costly: {center: [0, 0, 0], radius: 40}}, wall: skin}\n"
           "  - {name: marrow, inside: {costly: {center: [0, 0, 0], radius: 10}}}\n";
  };
  EXPECT_EQ(leftOut(*compile(read(body(35.0)))), "");
  EXPECT_EQ(leftOut(*compile(read(body(5.0)))), "marrow");
  // Nor is it left out if it is beyond the workspace but felt through the wall.
  const std::string device =
      "device: {workspace: {box: {center: [0, 0, 55], size: [10, 10, 40]}}}\n";
  EXPECT_EQ(leftOut(*compile(read(body(35.0) + device))), "");
}

/// A registry whose `parts: {center, radius}` is a ball that can be made in part, and that records
/// the requested box.
class NeedInPart : public ::testing::Test {
 protected:
  NeedInPart() {
    registry_.fields["parts"] = [this](MapReader& reader) {
      const Vec3 center = reader.requirePoint("center");
      const double radius = reader.requireLength("radius");
      return std::make_shared<FieldSource>(
          "parts",
          [this, center, radius](const Box3& within, const Progress&) {
            asked_.push_back(within);
            const FieldPtr whole = sphere(center, radius);
            return within.isBounded() ? knownWithin(whole, within) : whole;
          },
          [center, radius](const Progress&) {
            return Box3{center - Vec3(radius), center + Vec3(radius)};
          });
    };
  }
  SceneDescription read(const std::string& body) {
    return parseScene("palpate: 1\nlength: mm\n" + body, "test.yaml", registry_);
  }
  SceneRegistry registry_;
  std::vector<Box3> asked_;
};

const char* const kHalfInReach =
    "fields:\n"
    "  bowl: {parts: {center: [0, 0, 0], radius: 40}}\n"
    "  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}\n"
    "layers:\n"
    "  - {name: liquid, inside: {intersection: [bowl, brim]}}\n"
    "  - {name: ball, inside: {parts: {center: [10, 0, 0], radius: 8}}}\n"
    "ports: [{name: mouth, between: [outside, liquid], on: brim}]\n"
    "device: {workspace: {box: {center: [30, 0, 10], size: [60, 50, 40]}}}\n";

TEST_F(NeedInPart, OnlyWhatTheDeviceReachesIsAskedFor) {
  const ScenePtr scene = compile(read(kHalfInReach));
  ASSERT_EQ(asked_.size(), 2U);
  const double more = 0.05 * std::sqrt(0.06 * 0.06 + 0.05 * 0.05 + 0.04 * 0.04);
  EXPECT_NEAR(asked_[0].lo.x, -more, 1e-12);
  EXPECT_NEAR(asked_[0].hi.x, 0.06 + more, 1e-12);
  EXPECT_EQ(scene->ports().size(), 1U);
  EXPECT_TRUE(scene->regions()[1].reachable);
  EXPECT_TRUE(scene->bounds().isBounded());
  asked_.clear();
  (void)compile(read(kHalfInReach), {}, Purpose::kShow);
  ASSERT_EQ(asked_.size(), 2U);
  EXPECT_FALSE(asked_[0].isBounded());
}

// In the workspace the force is the same, bit for bit; on its border too, for a hand that presses
// no deeper than the margin kept beyond it: 4.4 mm here.
TEST_F(NeedInPart, TheTraceIsThatOfTheWhole) {
  const ScenePtr felt = compile(read(kHalfInReach));
  const ScenePtr all = compile(read(kHalfInReach), {}, Purpose::kShow);
  const Box3 reach = felt->device().reach();
  const auto a = makeRenderer(felt);
  const auto b = makeRenderer(all);
  int touched = 0;
  int within = 0;
  bool is_lost = false;
  for (int i = 0; i < 60000; ++i) {
    const double t = 0.001 * i;
    const Vec3 wave(std::sin(3.1 * t), std::cos(2.3 * t), std::sin(1.7 * t + 1.0));
    const HipState hip{glm::clamp(reach.center() + 0.6 * reach.size() * wave, reach.lo, reach.hi),
                       Vec3(0.0)};
    if (is_lost && all->regionAt(hip.position) == kOutside) {
      a->reset();
      b->reset();
      is_lost = false;
    }
    const TickResult two = b->update(hip);
    is_lost = is_lost || glm::distance(two.proxy, hip.position) > 0.0043;
    if (is_lost) continue;
    const TickResult one = a->update(hip);
    ASSERT_EQ(one.force, two.force) << i;
    ASSERT_EQ(one.proxy, two.proxy) << i;
    ASSERT_EQ(one.region, two.region) << i;
    touched += one.contact ? 1 : 0;
    within += one.region == 1 ? 1 : 0;
  }
  EXPECT_GT(touched, 1000);
  EXPECT_GT(within, 1000);
}

TEST_F(NeedInPart, BeyondItTheForceStaysFinite) {
  const auto renderer = makeRenderer(compile(read(kHalfInReach)));
  int touched = 0;
  for (int i = 0; i < 20000; ++i) {
    const double t = 0.001 * i;
    const Vec3 hip(0.1 * std::sin(3.1 * t), 0.09 * std::cos(2.3 * t), 0.1 * std::sin(1.7 * t));
    const TickResult out = renderer->update({hip, Vec3(0.0)});
    ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy)) << i;
    touched += out.contact ? 1 : 0;
  }
  EXPECT_GT(touched, 1000);
}

TEST_F(Need, ToBeShownAllIsMade) {
  EXPECT_EQ(leftOut(*compile(read(bone()), {}, Purpose::kShow)), "");
  EXPECT_EQ(made_, 2);
}

// The force is the same, bit for bit, with and without the layers that were left out.
TEST_F(Need, TheForceIsTheSame) {
  const ScenePtr felt = compile(read(bone()));
  const ScenePtr all = compile(read(bone()), {}, Purpose::kShow);
  ASSERT_EQ(leftOut(*felt), "marrow");
  const auto a = makeRenderer(felt);
  const auto b = makeRenderer(all);
  for (int i = 0; i < 3000; ++i) {
    const double t = 0.003 * i;
    const HipState hip{{0.06 * std::sin(3.0 * t), 0.05 * std::cos(2.0 * t), 0.05 * std::sin(t)},
                       Vec3(0.0)};
    const TickResult one = a->update(hip);
    const TickResult two = b->update(hip);
    ASSERT_EQ(one.force, two.force) << i;
    ASSERT_EQ(one.proxy, two.proxy) << i;
    ASSERT_EQ(one.region, two.region) << i;
  }
}

TEST_F(Need, ThePapersRendererWantsThemAll) {
  const ScenePtr scene = compile(read(bone()));
  RendererSettings settings;
  settings.kind = RendererKind::kPaper;
  try {
    (void)makeRenderer(scene, settings);
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.problem().code, "render.paper_left_out");
  }
  EXPECT_NO_THROW((void)makeRenderer(compile(read(bone()), {}, Purpose::kShow), settings));
}

TEST_F(Need, ABoxIsMeasuredOnce) {
  int measured = 0;
  const auto costly = [&](double radius) {
    return std::make_shared<FieldSource>(
        "costly", [radius](const Progress&) { return sphere(Vec3(0.0), radius); },
        [&measured, radius](const Progress&) {
          ++measured;
          return Box3{Vec3(-radius), Vec3(radius)};
        });
  };
  SceneDescription description;
  for (const double radius : {0.04, 0.02, 0.01}) {
    LayerDescription layer;
    layer.name = "layer" + std::to_string(description.layers.size());
    layer.inside = costly(radius);
    description.layers.push_back(layer);
  }
  EXPECT_EQ(reasonsToLeaveOut(description, {}).size(), 3U);
  EXPECT_EQ(measured, 3) << "to measure may mean to read a file";
}

}  // namespace
}  // namespace palpate
