// Every kind of field in a scene file is the library's field of the same parameters: the same value
// and gradient, bit for bit, at random points, and the same metric.

#include <gtest/gtest.h>

#include <functional>
#include <random>

#include "lib/scene/problems.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/units.h"

namespace palpate {
namespace {

struct KindCase {
  const char* name;
  std::string text;                            ///< of the field; lengths are in `u`
  std::function<FieldPtr(double u)> expected;  ///< u: [m] in one unit of the file
};

std::ostream& operator<<(std::ostream& out, const KindCase& kind) { return out << kind.name; }

// A length as the reader converts it: mm are divided by 1000, not multiplied by 0.001.
double in(double u, double number) { return u < 1.0 ? number / (1.0 / u) : number * u; }
Vec3 in(double u, double x, double y, double z) { return {in(u, x), in(u, y), in(u, z)}; }

FieldPtr ball(double u) { return sphere(in(u, 1, 2, 3), in(u, 20)); }
FieldPtr block(double u) { return box(in(u, 10, 0, 0), in(u, 30, 20, 25)); }
const std::string kBall = "{sphere: {center: [1, 2, 3], radius: 20}}";
const std::string kBlock = "{box: {center: [10, 0, 0], size: [30, 20, 25]}}";

const std::vector<KindCase>& kindCases() {
  static const std::vector<KindCase> cases = {
      {"half_space", "{half_space: {point: [1, 2, 3], normal: [0, 3, 4]}}",
       [](double u) { return halfSpace(in(u, 1, 2, 3), Vec3(0, 3, 4)); }},
      {"sphere", kBall, ball},
      {"box", kBlock, block},
      {"rounded_box", "{rounded_box: {center: [1, 2, 3], size: [30, 20, 26], rounding: 4}}",
       [](double u) { return roundedBox(in(u, 1, 2, 3), in(u, 30, 20, 26), in(u, 4)); }},
      {"rounded_box_to_the_limit",
       "{rounded_box: {center: [1, 2, 3], size: [30, 20, 26], rounding: 10}}",
       [](double u) { return roundedBox(in(u, 1, 2, 3), in(u, 30, 20, 26), in(u, 10)); }},
      {"cylinder", "{cylinder: {center: [1, 2, 3], axis: [1, 1, 0], radius: 9, height: 30}}",
       [](double u) { return cylinder(in(u, 1, 2, 3), Vec3(1, 1, 0), in(u, 9), in(u, 30)); }},
      {"cone", "{cone: {base: [1, 2, 3], axis: [0, 1, 2], radius: 12, height: 25}}",
       [](double u) { return cone(in(u, 1, 2, 3), Vec3(0, 1, 2), in(u, 12), in(u, 25)); }},
      {"torus", "{torus: {center: [1, 2, 3], axis: [0, 1, 2], radius: 20, tube: 6}}",
       [](double u) { return torus(in(u, 1, 2, 3), Vec3(0, 1, 2), in(u, 20), in(u, 6)); }},
      {"capsule", "{capsule: {from: [-10, 0, 1], to: [12, 3, 4], radius: 7}}",
       [](double u) { return capsule(in(u, -10, 0, 1), in(u, 12, 3, 4), in(u, 7)); }},
      {"ellipsoid", "{ellipsoid: {center: [1, 2, 3], radii: [20, 10, 15]}}",
       [](double u) { return ellipsoid(in(u, 1, 2, 3), in(u, 20, 10, 15)); }},
      {"heart", "{heart: {center: [1, 2, 3], width: 40}}",
       [](double u) { return heart(in(u, 1, 2, 3), in(u, 40)); }},
      {"gyroid", "{gyroid: {center: [1, 2, 3], period: 25}}",
       [](double u) { return gyroid(in(u, 1, 2, 3), in(u, 25)); }},
      {"gyroid_wall", "{gyroid: {center: [1, 2, 3], period: 25, thickness: 5}}",
       [](double u) { return gyroidWall(in(u, 1, 2, 3), in(u, 25), in(u, 5)); }},
      {"wyvill",
       "{metaballs: {fall_off: wyvill, iso: 0.4, balls: [{center: [1, 2, 3], radius: 30}, "
       "{center: [15, 2, 3], radius: 20, strength: 0.8}, "
       "{center: [1, 20, 3], radius: 15, strength: -0.5}]}}",
       [](double u) {
         return metaballs({{in(u, 1, 2, 3), in(u, 30), 1.0},
                           {in(u, 15, 2, 3), in(u, 20), 0.8},
                           {in(u, 1, 20, 3), in(u, 15), -0.5}},
                          FallOff::kWyvill, 0.4);
       }},
      {"gaussian",
       "{metaballs: {fall_off: gaussian, iso: 0.5, balls: [{center: [1, 2, 3], radius: 20}]}}",
       [](double u) {
         return metaballs({{in(u, 1, 2, 3), in(u, 20)}}, FallOff::kGaussian, 0.5);
       }},
      {"inverse_square",
       "{metaballs: {fall_off: inverse_square, iso: 0.5, balls: "
       "[{center: [1, 2, 3], radius: 20}]}}",
       [](double u) {
         return metaballs({{in(u, 1, 2, 3), in(u, 20)}}, FallOff::kInverseSquare, 0.5);
       }},
      {"union", "{union: [" + kBall + ", " + kBlock + "]}",
       [](double u) {
         return unite({ball(u), block(u)});
       }},
      {"intersection", "{intersection: [" + kBall + ", " + kBlock + "]}",
       [](double u) {
         return intersect({ball(u), block(u)});
       }},
      {"difference", "{difference: [" + kBall + ", " + kBlock + "]}",
       [](double u) {
         return subtract({ball(u), block(u)});
       }},
      {"complement", "{complement: " + kBlock + "}", [](double u) { return complement(block(u)); }},
      {"transform", "{transform: {field: " + kBlock + ", translate: [1, 2, 3]}}",
       [](double u) {
         return place(block(u), {Mat3(1.0), in(u, 1, 2, 3)});
       }},
      {"smooth_union", "{smooth_union: {fields: [" + kBall + ", " + kBlock + "], radius: 6}}",
       [](double u) {
         return smoothUnite({ball(u), block(u)}, in(u, 6));
       }},
      {"smooth_intersection",
       "{smooth_intersection: {fields: [" + kBall + ", " + kBlock + "], radius: 6}}",
       [](double u) {
         return smoothIntersect({ball(u), block(u)}, in(u, 6));
       }},
      {"smooth_difference",
       "{smooth_difference: {fields: [" + kBall + ", " + kBlock + "], radius: 6}}",
       [](double u) {
         return smoothSubtract({ball(u), block(u)}, in(u, 6));
       }},
      {"scale", "{scale: {field: " + kBlock + ", factor: 1.5}}",
       [](double u) { return scale(block(u), 1.5); }},
      {"offset_out", "{offset: {field: " + kBlock + ", distance: 2}}",
       [](double u) { return offset(block(u), in(u, 2)); }},
      {"offset_in", "{offset: {field: " + kBlock + ", distance: -2}}",
       [](double u) { return offset(block(u), in(u, -2)); }},
      {"shell", "{shell: {field: " + kBlock + ", thickness: 3}}",
       [](double u) { return shell(block(u), in(u, 3)); }},
  };
  return cases;
}

FieldPtr fieldIn(const std::string& unit, const std::string& text) {
  const SceneDescription scene =
      parseScene("palpate: 1\nlength: " + unit + "\nfields:\n  f: " + text + "\n", "test.yaml");
  return scene.fields.at(0).source->get();
}

std::vector<Vec3> somePoints(double u) {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> coordinate(-60.0 * u, 60.0 * u);
  std::vector<Vec3> points(500);
  for (Vec3& p : points) p = {coordinate(random), coordinate(random), coordinate(random)};
  return points;
}

void expectSameField(const Field& field, const Field& expected, double u) {
  EXPECT_EQ(field.metric(), expected.metric());
  EXPECT_EQ(field.lipschitz(), expected.lipschitz());
  EXPECT_EQ(field.featureSize(), expected.featureSize());
  EXPECT_EQ(field.structure().kind, expected.structure().kind);
  EXPECT_EQ(field.structure().operands.size(), expected.structure().operands.size());
  for (const Vec3& p : somePoints(u)) {
    const FieldSample a = field.sample(p);
    const FieldSample b = expected.sample(p);
    ASSERT_EQ(a.value, b.value) << p.x << " " << p.y << " " << p.z;
    ASSERT_EQ(a.gradient, b.gradient);
  }
}

class FieldKeys : public ::testing::TestWithParam<KindCase> {};

TEST_P(FieldKeys, MakeTheLibrarysField) {
  for (const std::string unit : {"mm", "cm", "m"}) {
    SCOPED_TRACE(unit);
    const double u = *metersPer(unit);
    expectSameField(*fieldIn(unit, GetParam().text), *GetParam().expected(u), u);
  }
}

INSTANTIATE_TEST_SUITE_P(Kinds, FieldKeys, ::testing::ValuesIn(kindCases()),
                         [](const auto& made) { return std::string(made.param.name); });

// Coefficients refer to positions in the scene's unit. The zero set must agree, and the field up to
// rounding, since the library divides by its slope anyway.
TEST(FieldKeysQuadric, CountsInTheScenesUnit) {
  const std::string text =
      "{quadric: {center: [1, 2, 3], xx: 1, yy: 2, zz: -0.5, xy: 0.1, xz: 0.2, yz: 0.3, x: 4, "
      "y: 5, z: 6, constant: -100, reach: 70}}";
  for (const std::string unit : {"mm", "cm", "m", "in"}) {
    SCOPED_TRACE(unit);
    const double u = *metersPer(unit);
    const FieldPtr field = fieldIn(unit, text);
    const FieldPtr expected = quadric(in(u, 1, 2, 3),
                                      {.xx = 1 / u / u,
                                       .yy = 2 / u / u,
                                       .zz = -0.5 / u / u,
                                       .xy = 0.1 / u / u,
                                       .xz = 0.2 / u / u,
                                       .yz = 0.3 / u / u,
                                       .x = 4 / u,
                                       .y = 5 / u,
                                       .z = 6 / u,
                                       .constant = -100},
                                      in(u, 70));
    EXPECT_EQ(field->metric(), Metric::kImplicit);
    const Box3 domain = field->lipschitzDomain();
    EXPECT_NEAR(domain.hi.x, 71 * u, 1e-12 * u);
    for (const Vec3& p : somePoints(u)) {
      const FieldSample a = field->sample(p);
      const FieldSample b = expected->sample(p);
      ASSERT_NEAR(a.value, b.value, 1e-12 * u);
      ASSERT_LT(glm::length(a.gradient - b.gradient), 1e-12);
      const Vec3 d = p / u - Vec3(1, 2, 3);
      const double polynomial = d.x * d.x + 2 * d.y * d.y - 0.5 * d.z * d.z + 0.1 * d.x * d.y +
                                0.2 * d.x * d.z + 0.3 * d.y * d.z + 4 * d.x + 5 * d.y + 6 * d.z -
                                100;
      if (std::fabs(polynomial) > 1e-6) {
        EXPECT_EQ(a.value < 0.0, polynomial < 0.0);
      }
    }
  }
  // The waist of the reference page: 5 mm around.
  const FieldPtr waist =
      fieldIn("mm", "{quadric: {center: [0, 0, 0], xx: 1, yy: 1, zz: -1, constant: -25}}");
  EXPECT_NEAR(waist->value(Vec3(0.003, 0.004, 0.0)), 0.0, 1e-15);
  EXPECT_LT(waist->value(Vec3(0.0029, 0.004, 0.0)), 0.0);
}

TEST(FieldKeysQuadric, ReachesHalfAMeterIfNotTold) {
  const FieldPtr plane = fieldIn("mm", "{quadric: {center: [0, 0, 0], z: 1}}");
  EXPECT_EQ(plane->lipschitzDomain().hi.x, 0.5);
  // The slope is made a trillionth less than 1, so that the bound surely holds.
  EXPECT_NEAR(plane->value(Vec3(0.0, 0.0, 0.01)), 0.01, 1e-13);
}

// A blend is one leaf; scale and offset make new faces for those of the operand.
TEST(FieldKeys, KeepWhatContactHolds) {
  const auto structure = [](const std::string& text) { return fieldIn("mm", text)->structure(); };
  using Kind = FieldStructure::Kind;
  EXPECT_EQ(structure("{smooth_union: {fields: [" + kBall + ", " + kBlock + "], radius: 1}}").kind,
            Kind::kLeaf);
  EXPECT_EQ(structure("{scale: {field: {union: [" + kBall + ", " + kBlock + "]}, factor: 2}}").kind,
            Kind::kUnion);
  EXPECT_EQ(
      structure("{offset: {field: {union: [" + kBall + ", " + kBlock + "]}, distance: 1}}").kind,
      Kind::kUnion);
  EXPECT_EQ(structure("{shell: {field: " + kBall + ", thickness: 1}}").kind, Kind::kIntersection);
}

TEST(FieldKeys, AreUsedByNameBeforeTheyAreDefined) {
  const SceneDescription scene = parseScene(
      "palpate: 1\nlength: mm\nfields:\n"
      "  knob: {smooth_union: {fields: [grip, {scale: {field: grip, factor: 2}}], radius: 1}}\n"
      "  hull: {shell: {field: knob, thickness: 1}}\n"
      "  grip: {capsule: {from: [0, 0, 0], to: [0, 0, 9], radius: 2}}\n",
      "test.yaml");
  const FieldPtr hull = scene.fields.at(1).source->get();
  // The outer face of a shell is the field itself.
  EXPECT_EQ(hull->structure().operands[0], scene.fields.at(0).source->get());
  EXPECT_EQ(scene.fields.at(0).source->get()->metric(), Metric::kBound);
}

}  // namespace
}  // namespace palpate
