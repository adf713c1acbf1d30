// The distance behind an opening over which a content fades in: a share of the scene's dimensions,
// never a fixed length.

#include <gtest/gtest.h>

#include "lib/render/drive.h"

namespace palpate::test {
namespace {

/// [-] Share of the drag that is felt when moving sideways `depth` units below the brim of a bowl
/// of 40 units.
double shareInABowl(const std::string& unit, double meters, double depth) {
  std::string text = containerText();
  text.replace(text.find("mm"), 2, unit);
  Drive hand(sceneOf(text));
  (void)hand.walk(meters * Vec3(0, 0, 30), 0.5 * meters);
  (void)hand.walk(meters * Vec3(0, 0, 15 - depth), 0.5 * meters);
  const double by = 0.001 * meters;
  const Vec3 p = hand.hip();
  for (int i = 1; i <= 2000; ++i) (void)hand.to(p + Vec3(by * i, 0, 0));
  return -hand.last().force.x / (4.0 * by / Drive::kTick);
}

TEST(ContentFade, IsTheSameInEveryUnit) {
  for (const double depth : {0.1, 0.2, 1.0, 10.0}) {
    const double share = shareInABowl("mm", 1e-3, depth);
    EXPECT_NEAR(shareInABowl("um", 1e-6, depth), share, 1e-6) << depth;
    EXPECT_NEAR(shareInABowl("m", 1.0, depth), share, 1e-6) << depth;
    EXPECT_NEAR(share, std::min(1.0, depth / 0.25), 1e-6) << depth;
  }
}

TEST(ContentFade, AFilmIsFeltInFull) {
  // A film a tenth of a millimeter thick, between two balls of 40 mm, open towards the outside: in
  // its middle the drag is felt in full.
  Drive hand(sceneOf(R"(
palpate: 1
length: mm
fields:
  outer: {sphere: {center: [0, 0, 0], radius: 40}}
  inner: {sphere: {center: [0, 0, 0], radius: 39.9}}
materials: {glass: {stiffness: 1500 N/m}, syrup: {viscosity: 4 N.s/m}}
layers:
  - {name: film, inside: outer, content: syrup, wall: glass}
  - {name: core, inside: inner, wall: glass}
ports:
  - {name: mouth, between: [outside, film], on: outer}
)"));
  (void)hand.walk(mm(0, 0, 45));
  (void)hand.walk(mm(0, 0, 39.95), 0.01e-3);
  ASSERT_EQ(hand.region(), "film");
  const TickResult out = hand.to(mm(0.01, 0, 39.95));
  EXPECT_NEAR(-out.force.x, 4.0 * 0.01, 1e-6);
}

}  // namespace
}  // namespace palpate::test
