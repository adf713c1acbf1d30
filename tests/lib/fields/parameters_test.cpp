// Bad parameters are refused with a message that states parameter, value and permitted range.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

void expectRefused(const std::function<FieldPtr()>& make, const std::string& code,
                   const std::vector<std::string>& words) {
  try {
    static_cast<void>(make());
    ADD_FAILURE() << "accepted, expected " << code;
  } catch (const Error& error) {
    EXPECT_EQ(error.kind(), ErrorKind::kInput);
    EXPECT_EQ(error.problem().code, code);
    for (const std::string& word : words) {
      EXPECT_NE(error.problem().message.find(word), std::string::npos)
          << '\'' << word << "' is not in: " << error.problem().message;
    }
  }
}

const Vec3 kOrigin(0.0);
const double kNan = std::nan("");

/// A maker with one parameter that may be bad, and the words that name it.
template <typename Value>
struct Maker {
  const char* field;
  const char* parameter;
  std::function<FieldPtr(const Value&)> make;
};

const Vec3 kUp(0.0, 0.0, 1.0);
const FieldPtr kBall = sphere(kOrigin, 1.0);

TEST(Parameters, LengthsArePositiveAndPlausible) {
  const std::vector<Maker<double>> makers = {
      {"sphere", "radius", [](double bad) { return sphere(kOrigin, bad); }},
      {"box", "size", [](double bad) { return box(kOrigin, Vec3(1, bad, 1)); }},
      {"rounded_box", "size", [](double bad) { return roundedBox(kOrigin, Vec3(1, bad, 1), 0.1); }},
      {"cylinder", "radius", [](double bad) { return cylinder(kOrigin, kUp, bad, 1.0); }},
      {"cylinder", "height", [](double bad) { return cylinder(kOrigin, kUp, 1.0, bad); }},
      {"cone", "radius", [](double bad) { return cone(kOrigin, kUp, bad, 1.0); }},
      {"cone", "height", [](double bad) { return cone(kOrigin, kUp, 1.0, bad); }},
      {"ellipsoid", "radii", [](double bad) { return ellipsoid(kOrigin, Vec3(bad, 1, 1)); }},
      {"torus", "radius", [](double bad) { return torus(kOrigin, kUp, bad, 0.1); }},
      {"capsule", "radius", [](double bad) { return capsule(kOrigin, kUp, bad); }},
      {"heart", "width", [](double bad) { return heart(kOrigin, bad); }},
      {"quadric", "reach",
       [](double bad) {
         return quadric(kOrigin, {.xx = 1.0, .yy = 1.0, .zz = 1.0, .constant = -1.0}, bad);
       }},
      {"gyroid", "period", [](double bad) { return gyroid(kOrigin, bad); }},
      {"gyroid", "period", [](double bad) { return gyroidWall(kOrigin, bad, 0.01); }},
      {"metaballs", "radius",
       [](double bad) {
         return metaballs({{kOrigin, bad, 1.0}}, FallOff::kWyvill, 0.5);
       }},
      {"user field", "feature_size",
       [](double bad) {
         UserFunction function;
         function.value = [](const Vec3& p) { return glm::length(p) - 1.0; };
         function.lipschitz = 1.0;
         function.feature_size = bad;
         return userField(function);
       }},
      {"shell", "thickness", [](double bad) { return shell(kBall, bad); }},
      {"smooth_union", "radius",
       [](double bad) {
         return smoothUnite({kBall, kBall}, bad);
       }},
      {"smooth_intersection", "radius",
       [](double bad) {
         return smoothIntersect({kBall, kBall}, bad);
       }},
      {"smooth_difference", "radius",
       [](double bad) {
         return smoothSubtract({kBall, kBall}, bad);
       }},
  };
  for (const Maker<double>& each : makers) {
    for (const double bad : {0.0, -0.0, -0.001, kNan, kInfinity, 1e-13, 1e13}) {
      SCOPED_TRACE(each.field + std::string(" ") + std::to_string(bad));
      expectRefused([&] { return each.make(bad); }, "field.bad_length",
                    {each.field, each.parameter, "must be from"});
    }
  }
  expectRefused([] { return sphere(kOrigin, -0.25); }, "field.bad_length", {"-0.25"});
}

TEST(Parameters, PointsAreFinite) {
  const std::vector<Maker<Vec3>> makers = {
      {"half_space", "point", [](const Vec3& p) { return halfSpace(p, kUp); }},
      {"half_space", "normal", [](const Vec3& p) { return halfSpace(kOrigin, p); }},
      {"sphere", "center", [](const Vec3& p) { return sphere(p, 1.0); }},
      {"box", "center", [](const Vec3& p) { return box(p, Vec3(1.0)); }},
      {"rounded_box", "center", [](const Vec3& p) { return roundedBox(p, Vec3(1.0), 0.1); }},
      {"cylinder", "center", [](const Vec3& p) { return cylinder(p, kUp, 1.0, 1.0); }},
      {"cylinder", "axis", [](const Vec3& p) { return cylinder(kOrigin, p, 1.0, 1.0); }},
      {"cone", "base", [](const Vec3& p) { return cone(p, kUp, 1.0, 1.0); }},
      {"cone", "axis", [](const Vec3& p) { return cone(kOrigin, p, 1.0, 1.0); }},
      {"ellipsoid", "center", [](const Vec3& p) { return ellipsoid(p, Vec3(1.0)); }},
      {"torus", "center", [](const Vec3& p) { return torus(p, kUp, 1.0, 0.1); }},
      {"torus", "axis", [](const Vec3& p) { return torus(kOrigin, p, 1.0, 0.1); }},
      {"capsule", "from", [](const Vec3& p) { return capsule(p, kUp, 1.0); }},
      {"capsule", "to", [](const Vec3& p) { return capsule(kUp, p, 1.0); }},
      {"heart", "center", [](const Vec3& p) { return heart(p, 1.0); }},
      {"quadric", "center",
       [](const Vec3& p) {
         return quadric(p, {.xx = 1.0, .yy = 1.0, .zz = 1.0, .constant = -1.0});
       }},
      {"gyroid", "center", [](const Vec3& p) { return gyroid(p, 1.0); }},
      {"gyroid", "center", [](const Vec3& p) { return gyroidWall(p, 1.0, 0.1); }},
      {"metaballs", "center",
       [](const Vec3& p) {
         return metaballs({{p, 1.0, 1.0}}, FallOff::kWyvill, 0.5);
       }},
      {"transform", "translation",
       [](const Vec3& p) {
         Pose pose;
         pose.translation = p;
         return place(kBall, pose);
       }},
  };
  for (const Maker<Vec3>& each : makers) {
    for (const double bad : {kNan, kInfinity, -kInfinity}) {
      SCOPED_TRACE(each.field + std::string(" ") + each.parameter);
      expectRefused([&] { return each.make(Vec3(0.0, bad, 0.0)); }, "field.not_finite",
                    {each.field, each.parameter});
    }
  }
}

TEST(Parameters, DirectionsAreNotZero) {
  expectRefused([] { return halfSpace(kOrigin, Vec3(0.0)); }, "field.zero_direction",
                {"half_space", "normal", "[0, 0, 0]"});
  expectRefused([] { return cylinder(kOrigin, Vec3(0.0, -0.0, 0.0), 1.0, 1.0); },
                "field.zero_direction", {"cylinder", "axis"});
  // Any other length is accepted.
  EXPECT_EQ(halfSpace(kOrigin, Vec3(0, 0, 1e-310))->value(Vec3(0, 0, 2)), 2.0);
  EXPECT_EQ(halfSpace(kOrigin, Vec3(0, 1e300, 0))->value(Vec3(0, 3, 0)), 3.0);
}

TEST(Parameters, OperandsAreThere) {
  expectRefused([] { return unite({}); }, "field.too_few_operands", {"union", "0", "1 or more"});
  expectRefused([] { return intersect({}); }, "field.too_few_operands", {"intersection"});
  expectRefused([] { return subtract({}); }, "field.too_few_operands", {"difference"});
  expectRefused(
      [] {
        return unite({sphere(kOrigin, 1.0), nullptr});
      },
      "field.null_operand", {"union", "operand 2 of 2"});
  expectRefused([] { return subtract({nullptr}); }, "field.null_operand",
                {"difference", "operand 1 of 1"});
  expectRefused([] { return complement(nullptr); }, "field.null_operand", {"complement"});
}

}  // namespace
}  // namespace palpate::test
