// Bad parameters are refused with a message that states parameter, value and permitted range.

#include <gtest/gtest.h>

#include <functional>
#include <string>

#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
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

TEST(Parameters, LengthsArePositiveAndPlausible) {
  for (const double bad : {0.0, -0.0, -0.001, kNan, kInfinity, 1e-13, 1e13}) {
    expectRefused([=] { return sphere(kOrigin, bad); }, "field.bad_length",
                  {"sphere", "radius", "must be from"});
    expectRefused([=] { return box(kOrigin, Vec3(1, bad, 1)); }, "field.bad_length",
                  {"box", "size", "must be from"});
    expectRefused([=] { return cylinder(kOrigin, Vec3(0, 0, 1), bad, 1.0); }, "field.bad_length",
                  {"cylinder", "radius", "must be from"});
    expectRefused([=] { return cylinder(kOrigin, Vec3(0, 0, 1), 1.0, bad); }, "field.bad_length",
                  {"cylinder", "height", "must be from"});
    expectRefused([=] { return ellipsoid(kOrigin, Vec3(bad, 1, 1)); }, "field.bad_length",
                  {"ellipsoid", "radii", "must be from"});
  }
  expectRefused([] { return sphere(kOrigin, -0.25); }, "field.bad_length", {"-0.25"});
}

TEST(Parameters, PointsAreFinite) {
  for (const double bad : {kNan, kInfinity, -kInfinity}) {
    const Vec3 p(0.0, bad, 0.0);
    expectRefused([=] { return halfSpace(p, Vec3(0, 0, 1)); }, "field.not_finite",
                  {"half_space", "point"});
    expectRefused([=] { return sphere(p, 1.0); }, "field.not_finite", {"sphere", "center"});
    expectRefused([=] { return box(p, Vec3(1.0)); }, "field.not_finite", {"box", "center"});
    expectRefused([=] { return cylinder(p, Vec3(0, 0, 1), 1.0, 1.0); }, "field.not_finite",
                  {"cylinder", "center"});
    expectRefused([=] { return ellipsoid(p, Vec3(1.0)); }, "field.not_finite",
                  {"ellipsoid", "center"});
    expectRefused([=] { return halfSpace(kOrigin, p); }, "field.not_finite",
                  {"half_space", "normal"});
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
