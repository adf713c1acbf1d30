// What compile() refuses, and the result of what it accepts: walls, reachability, shared labels.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/interior/port_machine.h"
#include "palpate/scene/scene.h"
#include "support/error_of.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

FieldSourcePtr source(FieldPtr field) { return std::make_shared<FieldSource>(std::move(field)); }

LayerDescription layer(const std::string& name, FieldPtr field, const std::string& wall = {}) {
  LayerDescription out;
  out.name = name;
  out.inside = source(std::move(field));
  out.wall.material = wall;
  out.place = {"test.yaml", 7, 3, name};
  return out;
}

PortDescription port(const std::string& name, const std::string& from, const std::string& to) {
  PortDescription out;
  out.name = name;
  out.from = from;
  out.to = to;
  out.place = {"test.yaml", 9, 5, name};
  return out;
}

Material material(const std::string& name, double stiffness) {
  Material out;
  out.name = name;
  out.stiffness = stiffness;
  return out;
}

FieldPtr ball(double x, double radius) { return sphere(Vec3(x, 0, 0), radius); }

/// A scene with a shell, a core in it, and a far ball that touches neither.
SceneDescription onion() {
  SceneDescription out;
  out.materials = {material("bone", 2000), material("air", 0)};
  out.layers = {layer("shell", ball(0, 0.03)), layer("core", ball(0, 0.02), "bone"),
                layer("far", ball(0.2, 0.03))};
  return out;
}

struct Refused {
  const char* name;
  std::function<void(SceneDescription&)> spoil;
  const char* code;
  const char* told;  ///< part of the message or hint
};

// A scene file is refused with the place of such a value; a description from code has no place.
TEST(Compile, RefusesTexturesThatAreTooSteep) {
  const auto code = [](const Texture& texture) {
    SceneDescription description = onion();
    description.materials[0].texture = texture;
    try {
      (void)compile(description);
    } catch (const Error& error) {
      return error.problem().code;
    }
    return std::string("accepted");
  };
  EXPECT_EQ(code({.amplitude = 0.0009, .wavelength = 0.006}), "accepted");
  EXPECT_EQ(code({.amplitude = 0.0, .wavelength = 0.0}), "accepted");
  EXPECT_EQ(code({.amplitude = 0.001, .wavelength = 0.006}), "scene.texture");
  EXPECT_EQ(code({.amplitude = 0.001}), "scene.texture");
  EXPECT_EQ(code({.amplitude = -0.001, .wavelength = 1.0}), "scene.texture");
  EXPECT_EQ(code({.amplitude = 0.001, .wavelength = NAN}), "scene.texture");
}

TEST(Compile, RefusesWithCodePlaceAndRemedy) {
  const std::vector<Refused> all{
      {"no field", [](auto& s) { s.layers[1].inside = nullptr; }, "scene.layer_without_field",
       "core"},
      {"name twice", [](auto& s) { s.layers[1].name = "shell"; }, "scene.duplicate_layer", "shell"},
      {"named outside", [](auto& s) { s.layers[1].name = "outside"; }, "scene.duplicate_layer",
       "outside"},
      {"wall material", [](auto& s) { s.layers[1].wall.material = "bon"; },
       "scene.unknown_material", "did you mean 'bone'"},
      {"content", [](auto& s) { s.layers[1].content = "marrow"; }, "scene.unknown_material",
       "marrow"},
      {"soft wall", [](auto& s) { s.layers[1].wall.material = "air"; },
       "scene.wall_without_stiffness", "stiffness"},
      {"port from", [](auto& s) { s.ports = {port("p", "shel", "core")}; }, "scene.unknown_layer",
       "did you mean 'shell'"},
      {"port to a glob of nothing", [](auto& s) { s.ports = {port("p", "shell", "x*")}; },
       "scene.unknown_layer", "x*"},
      {"start", [](auto& s) { s.start_region = "cor"; }, "scene.unknown_layer",
       "did you mean 'core'"},
      {"apart", [](auto& s) { s.ports = {port("p", "core", "far")}; }, "scene.regions_do_not_touch",
       "'core' and 'far'"},
      {"not neighbors", [](auto& s) { s.ports = {port("p", "outside", "core")}; },
       "scene.regions_do_not_touch", "outside"},
      {"sheet on nothing",
       [](auto& s) { s.sheets = {{.name = "foil", .on = nullptr, .place = s.layers[0].place}}; },
       "scene.sheet_without_field", "foil"},
      {"sheet of nothing",
       [](auto& s) {
         s.sheets = {{.name = "foil",
                      .on = source(ball(0, 1)),
                      .material = "bon",
                      .place = s.layers[0].place}};
       },
       "scene.unknown_material", "did you mean 'bone'"},
      {"after nothing",
       [](auto& s) {
         s.ports = {port("door", "shell", "core")};
         s.ports[0].after = {"dor"};
       },
       "scene.unknown_port", "did you mean 'door'"},
      {"after itself",
       [](auto& s) {
         s.ports = {port("p", "shell", "core")};
         s.ports[0].after = {"p"};
       },
       "scene.port_cycle", "'p'"},
      {"circle of three",
       [](auto& s) {
         s.ports = {port("p", "shell", "core"), port("q", "outside", "shell"),
                    port("r", "outside", "far")};
         s.ports[0].after = {"q"};
         s.ports[1].after = {"r"};
         s.ports[2].after = {"p"};
       },
       "scene.port_cycle", "after itself"},
      {"on a field of no layer",
       [](auto& s) {
         s.ports = {port("p", "shell", "core")};
         s.ports[0].on = source(ball(0, 0.02));
         s.ports[0].on_name = "lid";
       },
       "scene.port_face", "'lid'"},
      {"on a face of another layer",
       [](auto& s) {
         s.ports = {port("p", "shell", "core")};
         s.ports[0].on = s.layers[2].inside;
         s.ports[0].on_name = "far";
       },
       "scene.port_face", "which is not part of 'shell' or 'core'"},
      {"override of nothing",
       [](auto& s) {
         s.walls = {{"shell", "cor", {false, "bone"}, {}, {"test.yaml", 4, 2, {}}}};
       },
       "scene.unknown_layer", "cor"},
      {"override where there is no wall",
       [](auto& s) {
         s.walls = {{"shell", "core", {false, "air"}, {}, {"test.yaml", 4, 2, {}}}};
       },
       "scene.wall_without_stiffness", "air"},
  };
  for (const Refused& row : all) {
    SceneDescription spoilt = onion();
    spoilt.start_place = {"test.yaml", 2, 1, {}};
    ASSERT_NO_THROW((void)compile(spoilt));
    row.spoil(spoilt);
    try {
      (void)compile(spoilt);
      ADD_FAILURE() << row.name << " was accepted";
    } catch (const Error& error) {
      const Problem& problem = error.problem();
      EXPECT_EQ(error.kind(), ErrorKind::kInput) << row.name;
      EXPECT_EQ(problem.code, row.code) << row.name;
      EXPECT_NE((problem.message + problem.hint).find(row.told), std::string::npos)
          << row.name << ": " << error.what();
      EXPECT_EQ(problem.file, "test.yaml") << row.name;
      EXPECT_GT(problem.line, 0) << row.name;
    }
  }
}

TEST(Compile, WallsAreTheInnerLayersAndOverridesMayDifferBySide) {
  SceneDescription s = onion();
  s.materials.push_back(material("soft", 300));
  s.layers[2].wall = {true, {}};
  s.walls = {{"*", "core", {false, "soft"}, "core", {}}};
  const ScenePtr scene = compile(s);
  const auto felt = [&](RegionId from, RegionId to) {
    const Wall& wall = scene->passages().wall(from, to);
    if (wall.absent) return std::string("absent");
    return scene->materials()[static_cast<std::size_t>(wall.material)].name;
  };
  EXPECT_EQ(felt(0, 1), "default wall");
  EXPECT_EQ(felt(1, 0), "default wall");
  EXPECT_EQ(felt(1, 2), "bone") << "the inner layer's";
  EXPECT_EQ(felt(2, 1), "soft") << "overridden as felt from the core";
  EXPECT_EQ(felt(2, 0), "soft") << "the glob is meant literally";
  EXPECT_EQ(felt(0, 3), "absent");
  EXPECT_EQ(felt(3, 1), "absent");
  const Material& standard = scene->materials()[static_cast<std::size_t>(scene->regions()[1].wall)];
  EXPECT_EQ(standard.stiffness, 1000.0) << "documented";
  EXPECT_TRUE(scene->regions()[3].wall_absent);
}

TEST(Compile, LaterOverridesWin) {
  SceneDescription s = onion();
  s.walls = {{"outside", "*", {true, {}}, {}, {}}, {"outside", "shell", {false, "bone"}, {}, {}}};
  const ScenePtr scene = compile(s);
  EXPECT_FALSE(scene->passages().wall(0, 1).absent);
  EXPECT_TRUE(scene->passages().wall(0, 3).absent);
}

TEST(Compile, TouchAndReachability) {
  SceneDescription s = onion();
  s.ports = {port("a", "outside", "shell"), port("b", "shell", "core")};
  const auto reachable = [](const SceneDescription& description) {
    std::string out;
    const ScenePtr made = compile(description);
    for (const Region& region : made->regions()) out += region.reachable ? '1' : '0';
    return out;
  };
  const ScenePtr scene = compile(s);
  EXPECT_TRUE(scene->touches(0, 1));
  EXPECT_TRUE(scene->touches(1, 2));
  EXPECT_TRUE(scene->touches(0, 3));
  EXPECT_FALSE(scene->touches(0, 2));
  EXPECT_FALSE(scene->touches(2, 3));
  EXPECT_FALSE(scene->touches(1, 1));
  EXPECT_EQ(reachable(s), "1110");
  s.ports[1].after = {"a"};
  EXPECT_EQ(reachable(s), "1110");
  s.ports[0].direction = PortDirection::kOut;
  EXPECT_EQ(reachable(s), "1000") << "a way out only";
  s.start_region = "core";
  EXPECT_EQ(reachable(s), "0010") << "b wants a first, which is behind it";
  s.ports[1].after = {};
  EXPECT_EQ(reachable(s), "1110");
  s.layers[2].wall.absent = true;
  EXPECT_EQ(reachable(s), "1111") << "an absent wall needs no port";
  const ScenePtr open = compile(s);
  for (const Region& region : open->regions()) {
    ASSERT_TRUE(region.has_seed) << region.name;
    EXPECT_EQ(open->regions()[open->regionAt(region.seed)].name, region.name);
  }
}

TEST(Compile, APortMayLeadInFromSeveralRegions) {
  // Side by side on the x axis: a, b and c; b touches both, and outside.
  SceneDescription s;
  s.layers = {layer("a", ball(0, 0.5)), layer("c", ball(1.6, 0.5)), layer("b", ball(0.8, 0.5))};
  s.ports = {port("in", "a, c", "b"), port("all", "a, o*", "b, c")};
  const ScenePtr scene = compile(s);
  EXPECT_EQ(scene->ports()[0].from, (std::vector<RegionId>{1, 2}));
  EXPECT_EQ(scene->ports()[1].from, (std::vector<RegionId>{0, 1}));
  EXPECT_EQ(scene->ports()[1].to, (std::vector<RegionId>{2, 3}));
  // One pair that touches is sufficient, but each name must exist.
  s.ports = {port("in", "a, b", "c")};
  EXPECT_NO_THROW((void)compile(s));
  s.ports = {port("in", "a, d", "b")};
  EXPECT_EQ(errorOf([&] { (void)compile(s); }).problem().code, "scene.unknown_layer");
}

TEST(Compile, SmallAndThinNeighborsAreStillFound) {
  // A pea in a barrel, and a shell of 20 um.
  SceneDescription s;
  s.layers = {layer("barrel", ball(0, 0.5)), layer("pea", ball(0.3, 0.004)),
              layer("skin", ball(-0.2, 0.03)), layer("flesh", ball(-0.2, 0.02998))};
  s.ports = {port("a", "barrel", "pea"), port("b", "barrel", "skin"), port("c", "skin", "flesh")};
  const ScenePtr scene = compile(s);
  EXPECT_TRUE(scene->touches(1, 2));
  EXPECT_TRUE(scene->touches(3, 4));
  EXPECT_FALSE(scene->touches(1, 4)) << "the skin is everywhere between";
  for (const Region& region : scene->regions()) EXPECT_TRUE(region.has_seed) << region.name;
}

/// A half-space that counts its evaluations.
class CountedHalfSpace final : public Field {
 public:
  CountedHalfSpace(const Vec3& point, const Vec3& normal, std::size_t& asked)
      : plane_(halfSpace(point, normal)), asked_(asked) {}
  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    ++asked_;
    return plane_->sample(p);
  }
  [[nodiscard]] double value(const Vec3& p) const noexcept override {
    ++asked_;
    return plane_->value(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return plane_->bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return plane_->metric(); }
  [[nodiscard]] double lipschitz() const noexcept override { return 1.0; }
  [[nodiscard]] double featureSize() const noexcept override { return plane_->featureSize(); }

 private:
  FieldPtr plane_;
  std::size_t& asked_;
};

TEST(Compile, ManyThinSlabsAreLookedThroughWithoutAskingEveryFaceEverywhere) {
  // A stack of 40 slabs of 0.5 mm, a millimeter apart, in a block; the faces of each slab are
  // unbounded planes.
  constexpr int kSlabs = 40;
  std::size_t asked = 0;
  const auto face = [&](double x, double to) {
    return std::make_shared<CountedHalfSpace>(Vec3(x, 0.0, 0.0), Vec3(to, 0.0, 0.0), asked);
  };
  SceneDescription s;
  s.layers = {layer("block", box(Vec3(0.02, 0.0, 0.0), Vec3(0.06, 0.03, 0.03)))};
  for (int i = 0; i < kSlabs; ++i) {
    const double x = 1e-3 * i;
    s.layers.push_back(layer("slab" + std::to_string(i),
                             intersect({face(x, -1.0), face(x + 0.5e-3, 1.0),
                                        box(Vec3(0.02, 0.0, 0.0), Vec3(0.05, 0.02, 0.02))})));
  }
  const ScenePtr scene = compile(s);
  for (RegionId a = 2; a < kSlabs + 2; ++a) {
    EXPECT_TRUE(scene->touches(1, a));
    EXPECT_FALSE(scene->touches(kOutside, a));
    ASSERT_TRUE(scene->regions()[a].has_seed);
    EXPECT_EQ(scene->regionAt(scene->regions()[a].seed), a);
    for (RegionId b = 2; b < a; ++b) EXPECT_FALSE(scene->touches(a, b));
  }
  EXPECT_TRUE(scene->touches(kOutside, 1));
  // Some 8000 lines of 128 steps; evaluating all 80 faces at each would be 80 million, and as many
  // again while bisecting.
  EXPECT_LT(asked, 16'000'000U);
}

TEST(Compile, ALayerThatCoversAnotherLeavesNothingOfIt) {
  SceneDescription s;
  s.layers = {layer("hidden", ball(0, 0.01)), layer("cover", ball(0, 0.02))};
  const ScenePtr scene = compile(s);
  EXPECT_EQ(scene->regionAt(Vec3(0.0)), 2);
  EXPECT_FALSE(scene->regions()[1].has_seed);
  EXPECT_FALSE(scene->touches(0, 1));
}

TEST(Compile, RegionsByName) {
  const ScenePtr scene = compile(onion());
  EXPECT_EQ(scene->regionNamed("outside"), kOutside);
  EXPECT_EQ(scene->regionNamed("core"), 2);
  EXPECT_THROW((void)scene->regionNamed("Core"), Error);
  const Box3 box = scene->bounds();
  EXPECT_NEAR(box.lo.x, -0.03, 1e-12);
  EXPECT_NEAR(box.hi.x, 0.23, 1e-12);
}

TEST(LabelGroup, PointsGoToTheSmallestFieldWithNoGapAndNoOverlap) {
  const FieldPtr a = ball(-0.012, 0.02);
  const FieldPtr b = ball(0.012, 0.025);
  const FieldPtr c = sphere(Vec3(0, 0.02, 0), 0.02);
  SceneDescription s;
  s.layers = {layer("a", a), layer("b", b), layer("c", c)};
  for (LayerDescription& l : s.layers) l.label_group = "scan";
  const ScenePtr scene = compile(s);
  EXPECT_TRUE(scene->touches(1, 2));
  EXPECT_TRUE(scene->touches(2, 3));
  Random random(12);
  int shared = 0;
  for (int i = 0; i < 20000; ++i) {
    const Vec3 p = random.in({Vec3(-0.045), Vec3(0.045)});
    const double values[] = {a->value(p), b->value(p), c->value(p)};
    const auto* least = std::min_element(values, values + 3);
    const auto expected = *least < 0.0 ? static_cast<RegionId>(least - values + 1) : kOutside;
    ASSERT_EQ(scene->regionAt(p), expected);
    int holders = 0;
    for (RegionId r = 1; r <= 3; ++r) holders += scene->regions()[r].field->value(p) < 0.0 ? 1 : 0;
    ASSERT_EQ(holders, expected == kOutside ? 0 : 1) << "one owner each";
    shared += (values[0] < 0.0) + (values[1] < 0.0) + (values[2] < 0.0) > 1 ? 1 : 0;
  }
  EXPECT_GT(shared, 500);
  // At the wall between a and b each field is the other's negative, in value and gradient.
  const Field& own = *scene->regions()[1].field;
  const Field& other = *scene->regions()[2].field;
  for (double y = -0.01; y < -0.001; y += 0.001) {
    double lo = -0.012;
    double hi = 0.012;
    for (int k = 0; k < 60; ++k) {
      const double x = 0.5 * (lo + hi);
      (a->value(Vec3(x, y, 0)) < b->value(Vec3(x, y, 0)) ? lo : hi) = x;
    }
    for (const double off : {-1e-5, 0.0, 1e-5}) {
      const Vec3 p(lo + off, y, 0);
      EXPECT_NEAR(own.value(p), -other.value(p), 1e-16);
      EXPECT_LT(glm::length(own.sample(p).gradient + other.sample(p).gradient), 1e-15);
      EXPECT_EQ(own.value(p), own.sample(p).value);
    }
  }
}

TEST(LabelGroup, ThatIsOneOrApartIsLeftAlone) {
  SceneDescription s = onion();
  s.layers[0].label_group = "scan";
  s.layers[2].label_group = "scan";
  const ScenePtr scene = compile(s);
  EXPECT_EQ(scene->regions()[1].field, s.layers[0].inside->get())
      << "boxes apart: nothing to share";
  EXPECT_EQ(scene->regionAt(Vec3(0.0)), 2) << "another layer still wins by its order";
}

TEST(LabelGroup, LayersWithALabelInCommonDoNotLimitEachOther) {
  // A part inside the whole it belongs to: as the later layer it owns its points, although the
  // whole is deeper there.
  SceneDescription s;
  s.layers = {layer("whole", ball(0, 0.03)), layer("part", ball(0.005, 0.01)),
              layer("next", ball(0.05, 0.025))};
  for (LayerDescription& l : s.layers) l.label_group = "scan";
  s.layers[0].labels = {1, 2};
  s.layers[1].labels = {2};
  s.layers[2].labels = {3};
  const ScenePtr scene = compile(s);
  EXPECT_EQ(scene->regionAt(Vec3(0.0)), 2);
  EXPECT_EQ(scene->regionAt(Vec3(-0.01, 0, 0)), 1);
  EXPECT_EQ(scene->regionAt(Vec3(0.027, 0, 0)), 1) << "both have it: the nearer to its middle";
  EXPECT_EQ(scene->regionAt(Vec3(0.029, 0, 0)), 3);
}

std::vector<FieldCase> sharedCases() {
  // One label's share, checked against the contract of all fields.
  const auto made = [] {
    SceneDescription s;
    s.layers = {layer("a", ball(-0.012, 0.02)), layer("b", ball(0.012, 0.025))};
    for (LayerDescription& l : s.layers) l.label_group = "scan";
    return compile(s);
  };
  const auto inside = [](const Vec3& p) {
    const double a = glm::length(p - Vec3(-0.012, 0, 0)) - 0.02;
    const double b = glm::length(p - Vec3(0.012, 0, 0)) - 0.025;
    return a < 0.0 && a < b;
  };
  return {{.name = "label_share",
           .make = [=] { return made()->regions()[1].field; },
           .region = {Vec3(-0.05), Vec3(0.05)},
           .inside = inside,
           .crease_share = 0.2,
           .unit_gradient = false}};
}

INSTANTIATE_TEST_SUITE_P(LabelShare, FieldContract, testing::ValuesIn(sharedCases()),
                         testing::PrintToStringParamName());

}  // namespace
}  // namespace palpate::test
