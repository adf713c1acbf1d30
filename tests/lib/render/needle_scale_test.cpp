// A needle in a scene in micrometers behaves like that in the same scene in millimeters: nothing
// depends on a fixed length.

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// A block of tissue 4 units deep under a skin, on bone. Forces are proportional to the unit,
/// stiffnesses do not change, and quantities per length of the shaft are inversely proportional.
ScenePtr block(const std::string& unit, double scale) {
  const auto force = [&](double value) { return std::to_string(scale * value) + " N"; };
  const auto modulus = [&](double value) { return std::to_string(value / scale) + " N/m^2"; };
  return sceneOf("palpate: 1\nlength: " + unit +
                 "\nmaterials:\n  skin: {stiffness: 1000 N/m}\n  bone: {stiffness: 5000 N/m}\n"
                 "  tissue: {stiffness: 400 N/m, cutting: " +
                 force(0.4) + ", shaft: {stiffness: " + modulus(1e5) +
                 ", stick_speed: 0 mm/s, in: {static: 18 N/m, kinetic: 10 N/m}, lateral: "
                 "{stiffness: " +
                 modulus(3.6e4) +
                 "}}}\nlayers:\n  - {name: tissue, inside: {box: {center: [0, 0, -2], size: [40, "
                 "40, 4]}}, wall: skin, content: tissue}\n  - {name: bone, inside: {box: {center: "
                 "[0, 0, -6], size: [40, 40, 4]}}, wall: bone}\nports: [{name: p, between: "
                 "[outside, tissue], opens_at: " +
                 force(0.8) + "}]\n");
}

TEST(NeedleScale, InMicrometersItFeelsWhatItFeelsInMillimeters) {
  const ScenePtr large = block("mm", 1.0);
  const ScenePtr small = block("um", 1e-3);
  const auto one = makeRenderer(large);
  const auto other = makeRenderer(small);
  // The needle goes in and out; then once more beside that, by less than its width, where the
  // tissue is cut already; then by more, where it is not; and then at an angle.
  const std::vector<Vec3> corners = {mm(0, 0, 3),      mm(0, 0, -3),  mm(0, 0, 3),  mm(0.3, 0, 3),
                                     mm(0.3, 0, -3),   mm(0.3, 0, 3), mm(2, 0, 3),  mm(2, 0, -3.5),
                                     mm(3, 0.5, -3.5), mm(3, 0.5, 3), mm(-4, 0, 3), mm(-5, 1, -5),
                                     mm(-4, 0, 3)};
  Vec3 last = corners[0];
  double most = 0.0;
  std::size_t entries = 0;
  for (std::size_t i = 1; i < corners.size(); ++i) {
    constexpr int kSteps = 400;
    const Vec3 from = corners[i - 1];
    for (int k = 1; k <= kSteps; ++k) {
      const Vec3 p = glm::mix(from, corners[i], 1.0 * k / kSteps);
      const Vec3 velocity = (p - last) / 1e-3;
      last = p;
      const TickResult a = one->update({p, velocity, 1e-3});
      const TickResult b = other->update({1e-3 * p, 1e-3 * velocity, 1e-3});
      ASSERT_EQ(a.region, b.region) << "leg " << i << ", step " << k;
      ASSERT_TRUE(isNear(1e3 * b.force, a.force, 1e-7)) << "leg " << i << ", step " << k;
      most = std::max(most, glm::length(a.force));
      entries += one->entries().size();
    }
  }
  EXPECT_GT(most, 1.0);
  EXPECT_GE(entries, 8U);
}

}  // namespace
}  // namespace palpate::test
