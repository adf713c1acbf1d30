// A combination is as steep as its steepest operand, whichever position that has.

#include <gtest/gtest.h>

#include <functional>
#include <string>
#include <vector>

#include "palpate/fields/csg.h"
#include "palpate/fields/implicit.h"
#include "palpate/fields/primitives.h"

namespace palpate::test {
namespace {

constexpr double kSteep = 7.0;

/// A ball whose value rises kSteep times as fast as the distance.
FieldPtr steepBall(const Vec3& center) {
  UserFunction f;
  f.value = [=](const Vec3& p) { return kSteep * (glm::length(p - center) - 0.01); };
  f.bounds = {center - Vec3(0.011), center + Vec3(0.011)};
  f.feature_size = 0.01;
  f.lipschitz = kSteep;
  return userField(std::move(f));
}

/// The operands, with the steep one at `place`.
std::vector<FieldPtr> withSteepAt(std::size_t place) {
  std::vector<FieldPtr> out = {sphere({0.05, 0, 0}, 0.01), sphere({0, 0.05, 0}, 0.01),
                               sphere({0, 0, 0.05}, 0.01)};
  out[place] = steepBall(Vec3(0.0));
  return out;
}

TEST(CombinedLipschitz, IsThatOfTheSteepestOperand) {
  using Combine = std::function<FieldPtr(std::vector<FieldPtr>)>;
  const std::vector<std::pair<std::string, Combine>> all = {
      {"union", unite},
      {"intersection", intersect},
      {"difference", subtract},
      {"smooth union", [](auto f) { return smoothUnite(std::move(f), 0.005); }},
      {"smooth intersection", [](auto f) { return smoothIntersect(std::move(f), 0.005); }},
      {"smooth difference", [](auto f) { return smoothSubtract(std::move(f), 0.005); }},
      {"complement of a union", [](auto f) { return complement(unite(std::move(f))); }},
      {"offset of a union", [](auto f) { return offset(unite(std::move(f)), 1e-3); }},
      {"shell of a union", [](auto f) { return shell(unite(std::move(f)), 1e-3); }},
      {"scaled union", [](auto f) { return scale(unite(std::move(f)), 2.0); }},
      {"moved union", [](auto f) { return place(unite(std::move(f)), {}); }},
      {"union of unions",
       [](auto f) {
         return unite({f[0], unite({f[1], f[2]})});
       }},
  };
  for (const auto& [name, combine] : all) {
    for (std::size_t place = 0; place < 3; ++place) {
      SCOPED_TRACE(name + ", operand " + std::to_string(place));
      const FieldPtr field = combine(withSteepAt(place));
      EXPECT_GE(field->lipschitz(), kSteep);
      // The bound is tight: somewhere the value does rise that fast.
      double steepest = 0.0;
      for (int i = -60; i <= 60; ++i) {
        const Vec3 p(5e-4 * i, 1e-4, 0.0);
        const Vec3 q = p + Vec3(1e-6, 0, 0);
        steepest = std::max(steepest, std::fabs(field->value(q) - field->value(p)) / 1e-6);
      }
      if (name == "union" || name == "offset of a union") {
        EXPECT_GT(steepest, 0.9 * kSteep);
      }
      EXPECT_LE(steepest, field->lipschitz() * (1.0 + 1e-6));
    }
  }
}

}  // namespace
}  // namespace palpate::test
