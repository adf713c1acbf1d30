// The scenes of the source paper's figures against closed forms: force and sequence of states, from
// every side and in every wrong order.

#include <gtest/gtest.h>

#include <cstdlib>
#include <numbers>

#include "lib/render/figures.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

class EveryFigure : public testing::TestWithParam<Figure> {};
INSTANTIATE_TEST_SUITE_P(Figures, EveryFigure, testing::ValuesIn(figures()), figureName);

/// Element i of directions that are evenly spread over the sphere (Fibonacci lattice).
Vec3 directionOf(int i, int count) {
  const double z = 1.0 - (2.0 * i + 1.0) / count;
  const double r = std::sqrt(1.0 - z * z);
  const double around = i * std::numbers::pi * (3.0 - std::sqrt(5.0));
  return {r * std::cos(around), r * std::sin(around), z};
}

/// Checks that no place near the proxy, in its region, is closer to the hand: the proxy minimizes
/// the distance.
void expectNoCloserPlace(const Figure& figure, const Drive& drive, Random& random) {
  const Vec3 proxy = 1e3 * drive.last().proxy;
  const Vec3 hip = 1e3 * drive.hip();
  const double distance = glm::length(hip - proxy);
  for (int i = 0; i < 60; ++i) {
    const double r = i % 2 == 0 ? 0.02 : 0.4;  // [mm]
    const Vec3 beside = proxy + r * random.direction();
    if (figure.region(beside) != drive.last().region) continue;
    // Only places that can be reached count: the far side of a thin wall is in the same region too.
    if (!crossingsOf(figure, beside, proxy + 1e-5 * (beside - proxy), 8).empty()) continue;
    // The polynomial of the heart and the renderer's heart differ by a few micrometers away from
    // the tip.
    const double slack = figure.name == "heart" ? 0.02 : 1e-5;
    EXPECT_GT(glm::length(hip - beside), distance - slack) << figure.name << " beside by " << r;
  }
}

// Straight in and through from all directions, towards several targets: on free ways the ports are
// passed in the order of the path, and where a wall is in the way the force is that of its spring
// and the proxy is the closest point.
TEST_P(EveryFigure, FromEverySideTheTraceIsTheClosedForms) {
  const Figure& figure = GetParam();
  const ScenePtr scene = figure.springs();
  const Vec3 middle = 1e3 * scene->bounds().center();
  const Vec3 half = 0.5e3 * scene->bounds().size();
  const double far = 1.5 * glm::length(half);
  Random random(11);
  int free_ways = 0;
  int pressed = 0;
  constexpr int kDirections = 48;
  for (int i = 0; i < kDirections; ++i) {
    for (int target = 0; target < 3; ++target) {
      const Vec3 goal = middle + 0.5 * half * random.in({Vec3(-1.0), Vec3(1.0)});
      const Vec3 from = middle + far * directionOf(i, kDirections);
      const Vec3 to = goal + (target == 0 ? 0.0 : 0.2 + 0.1 * target) * (goal - from);
      Drive drive(scene);
      (void)drive.to(1e-3 * from);
      Vec3 last = from;
      int region = 0;
      PassedNames passed;
      bool is_free = true;
      constexpr int kSteps = 60;
      for (int k = 1; k <= kSteps; ++k) {
        const Vec3 hip = glm::mix(from, to, static_cast<double>(k) / kSteps);
        const auto way = is_free ? passageOf(figure, last, hip, region, passed, 64) : std::nullopt;
        (void)drive.to(1e-3 * hip);
        const TickResult& out = drive.last();
        if (way) {
          ASSERT_EQ(out.proxy, drive.hip()) << i << " " << k;
          ASSERT_EQ(out.force, Vec3(0.0));
          ASSERT_EQ(drive.events(), way->events);
          ASSERT_EQ(out.region, way->region);
          region = way->region;
          passed = way->passed;
        } else {
          if (is_free) ++pressed;
          is_free = false;
          const Vec3 rest = out.proxy - drive.hip();
          // All springs have one stiffness: exact to the tolerance of a proxy at rest, 1e-6 of the
          // depth.
          ASSERT_TRUE(isNear(out.force, 1000.0 * rest, 1e-6 + 1e-3 * glm::length(rest)));
        }
        last = hip;
      }
      if (is_free) ++free_ways;
      (void)drive.to(1e-3 * to);
      const Vec3 rest = drive.last().proxy - drive.hip();
      ASSERT_TRUE(isNear(drive.last().force, 1000.0 * rest,
                         1e-6 * (1.0 + glm::length(drive.last().force))));
      if (drive.last().contact) expectNoCloserPlace(figure, drive, random);
    }
  }
  EXPECT_GT(pressed, 40) << "walls were met";
  if (figure.name == "container" || figure.name == "cup") {
    EXPECT_GT(free_ways, 5);
  }
}

/// A hand at the composite tube: it tries a way, and goes back if it is refused.
class TubeHand {
 public:
  TubeHand() : drive_(sceneNamed("composite_tube")) { (void)drive_.to(mm(-60, 0, 30)); }

  /// From outside, tries to enter the tube at `side` (0 left, 1 right, 2 to 4 through the skin of
  /// filling 1 to 3).
  void tryIn(int side) {
    const double x = side == 0 ? -60.0 : side == 1 ? 60.0 : 30.0 * (side - 3);
    (void)drive_.walk(1e3 * drive_.hip().z < 29.0 ? mm(1e3 * drive_.hip().x, 0, 30) : drive_.hip(),
                      10e-3);
    (void)drive_.walk(mm(x, 0, 30), 10e-3);
    if (side < 2) (void)drive_.walk(mm(x, 0, 0), 10e-3);
    attempt(side < 2 ? mm(x < 0 ? -30 : 30, 0, 0) : mm(x, 0, 0));
  }
  /// From inside, tries to go on to the right (0), back to the left (1), or out through the skin
  /// (2).
  void tryOn(int way) {
    const double x = 1e3 * drive_.hip().x;
    attempt(way == 2 ? mm(x, 0, 30) : mm(way == 0 ? x + 30 : x - 30, 0, 0));
  }
  [[nodiscard]] int region() const { return drive_.last().region; }
  std::string events() { return drive_.events(); }

 private:
  void attempt(const Vec3& to) {
    const Vec3 from = drive_.hip();
    (void)drive_.walk(to, 10e-3);
    if (!drive_.last().contact) return;
    // Refused: at rest, the spring of the steel holds it back.
    EXPECT_NEAR(glm::length(drive_.last().force), 1500.0 * glm::length(drive_.last().proxy - to),
                1e-6);
    (void)drive_.walk(from, 10e-3);
    EXPECT_FALSE(drive_.last().contact);
  }
  Drive drive_;
};

TEST(CompositeTube, ThePortsOpenInTheirOrderAndInNoOther) {
  // Every sequence of four tries (slow form: six), with five ways each.
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int tries = slow ? 6 : 4;
  const int sequences = slow ? 15625 : 625;
  int through = 0;
  for (int code = 0; code < sequences; ++code) {
    TubeHand hand;
    int region = 0;
    for (int k = 0, rest = code; k < tries; ++k, rest /= 5) {
      const int choice = rest % 5;
      std::string expected;
      if (region == 0) {
        hand.tryIn(choice);
        if (choice == 0) {
          region = 1;
          expected = "port 1";
        }
      } else {
        hand.tryOn(choice % 3);
        if (choice % 3 == 0) {
          expected = "port " + std::to_string(region + 1);
          region = (region + 1) % 4;
          through += region == 0 ? 1 : 0;
        } else if (choice % 3 == 1) {
          expected = "port " + std::to_string(region);
          --region;
        }
      }
      ASSERT_EQ(hand.region(), region) << "sequence " << code << ", try " << k;
      ASSERT_EQ(hand.events(), expected) << "sequence " << code << ", try " << k;
    }
  }
  EXPECT_GE(through, 1);
}

TEST(CompositeTube, EveryFillingDragsByItsOwnViscosity) {
  Drive drive(sceneNamed("composite_tube"));
  (void)drive.walk(mm(-60, 0, 0));
  for (const auto& [x, viscosity] :
       {std::pair(-30.0, 1.0), std::pair(0.0, 4.0), std::pair(30.0, 9.0)}) {
    (void)drive.walk(mm(x, 0, 0));
    (void)drive.to(mm(x + 0.1, 0, 0));  // 0.1 m/s
    EXPECT_TRUE(isNear(drive.last().force, {-viscosity * 0.1, 0, 0}, 1e-9)) << x;
    (void)drive.to(mm(x + 0.1, 0.05, 0));
    EXPECT_TRUE(isNear(drive.last().force, {0, -viscosity * 0.05, 0}, 1e-9)) << x;
  }
}

TEST(CupWithLiquid, IsGlassAroundAndDragsWithin) {
  Drive drive(sceneNamed("cup"));
  (void)drive.walk(mm(0, 0, 60));
  (void)drive.walk(mm(0, 0, 25));
  EXPECT_EQ(drive.region(), "outside") << "above the liquid, in the cup";
  (void)drive.walk(mm(0, 0, 10));
  EXPECT_EQ(drive.region(), "liquid");
  EXPECT_EQ(drive.events(), "") << "its surface is not a port";
  (void)drive.to(mm(0, 0.2, 10));
  EXPECT_TRUE(isNear(drive.last().force, {0, -2.0 * 0.2, 0}, 1e-9));
  // The glass from inside: bottom and side; and over the flat top of the rim.
  (void)drive.walk(mm(0, 0, -38));
  EXPECT_NEAR(drive.last().force.z, 1500.0 * 2e-3, 1e-6);
  (void)drive.walk(mm(0, 0, 10));
  (void)drive.walk(mm(30, 0, 10));
  EXPECT_NEAR(drive.last().force.x, -1500.0 * 1e-3, 1e-6);
  EXPECT_EQ(drive.region(), "liquid");
  (void)drive.walk(mm(0, 0, 10));
  (void)drive.walk(mm(0, 0, 60));
  EXPECT_EQ(drive.region(), "outside");
  (void)drive.walk(mm(30.5, 0, 60));
  (void)drive.walk(mm(30.5, 0, 39));
  EXPECT_NEAR(drive.last().force.z, 1500.0 * 1e-3, 1e-6);
  EXPECT_NEAR(drive.last().force.x, 0.0, 1e-6);
}

}  // namespace
}  // namespace palpate::test
