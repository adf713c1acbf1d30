// Random ticks in the scenes of the source paper's figures: whatever the hand does, the renderer
// makes the crossings along its way in their order, only those that the table of ports permits, and
// passes no wall.

#include <gtest/gtest.h>

#include <cstdlib>
#include <span>
#include <vector>

#include "lib/render/figures.h"
#include "lib/render/shake.h"

namespace palpate::test {
namespace {

class RandomFigure : public testing::TestWithParam<Figure> {};
INSTANTIATE_TEST_SUITE_P(Figures, RandomFigure, testing::ValuesIn(figures()), figureName);

/// Whether a place of this region is within 2e-5 mm of p [mm]: a proxy at a wall counts as on its
/// own side.
bool isAtRegion(const Figure& figure, int region, const Vec3& p) {
  if (figure.region(p) == region) return true;
  // The heart of the renderer and the polynomial differ by up to a hundredth of the half width at
  // tip and dimple.
  const double reach = figure.name == "heart" ? 0.3 : 2e-5;
  for (int i = 0; i < 27; ++i) {
    const Vec3 u(i % 3 - 1, i / 3 % 3 - 1, i / 9 - 1);
    if (figure.region(p + reach * u) == region) return true;
  }
  return false;
}

/// Places just behind the reported crossings, if these lie on the straight way from a to b [mm]:
/// only these samples detect a way that cuts a corner by micrometers. (0 at a, 1 at b)
std::vector<double> behind(std::span<const PortCrossing> told, const Vec3& a, const Vec3& b) {
  std::vector<double> places;
  const Vec3 way = b - a;
  const double length = glm::length(way);
  for (const PortCrossing& crossing : told) {
    const Vec3 point = 1e3 * crossing.point;
    const double at = glm::dot(point - a, way) / length;
    if (glm::length(a + at / length * way - point) > 1e-6) continue;
    for (const double further : {1e-6, 1e-5, 1e-4}) {
      if (at + further < length) places.push_back((at + further) / length);
    }
  }
  return places;
}

TEST_P(RandomFigure, CrossesAsItsTableSaysInPathOrderAndThroughNoWall) {
  const Figure& figure = GetParam();
  const bool slow = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  const int ticks = slow ? 10'000'000 : 100'000;
  const ScenePtr scene = figure.springs();
  Drive drive(scene);
  Hand hand(91, scene->bounds().grownBy(0.02));
  PassedNames passed;
  int region = 0;
  bool was_free = false;
  Vec3 last(0.0);
  int judged = 0;
  int unsettled = 0;
  for (int i = 0; i < ticks; ++i) {
    const Vec3 hip = hand.next();
    const TickResult out = drive.renderer().update({hip, Vec3(0.0)});
    SCOPED_TRACE(testing::Message() << figure.name << " tick " << i);
    // Every reported crossing is permitted by the table, in the state that those before it left.
    const PassedNames before = passed;
    const int came_from = region;
    std::string events;
    for (const PortCrossing& crossing : drive.renderer().crossings()) {
      if (crossing.from != region) {
        ASSERT_EQ(figure.way(region, crossing.from, crossing.point, passed), Way(""));
      }
      const Way way = figure.way(crossing.from, crossing.to, 1e3 * crossing.point, passed);
      ASSERT_TRUE(way) << crossing.from << " to " << crossing.to;
      ASSERT_EQ(scene->ports()[crossing.port].name, *way);
      passed.pass(*way, crossing.from, crossing.to);
      events += (events.empty() ? "" : " ") + *way;
      region = crossing.to;
    }
    if (out.region != region) {
      ASSERT_EQ(figure.way(region, out.region, 1e3 * out.proxy, passed), Way(""));
      region = out.region;
    }
    ASSERT_TRUE(isAtRegion(figure, region, 1e3 * out.proxy));
    // If the hand was free and no wall is on its way, it goes that way, port by port.
    if (was_free) {
      auto way = passageOf(figure, 1e3 * last, 1e3 * hip, came_from, before, 32);
      if (way && (way->events != events || way->region != region || out.proxy != hip)) {
        const Vec3 from = 1e3 * last;
        const Vec3 to = 1e3 * hip;
        way = passageOf(figure, from, to, came_from, before, 5000,
                        behind(drive.renderer().crossings(), from, to));
      }
      if (way && figure.name != "heart") {
        ASSERT_TRUE(isNear(out.proxy, hip, 0.0))
            << "the way from (" << 1e3 * last.x << ", " << 1e3 * last.y << ", " << 1e3 * last.z
            << ") mm in " << came_from << " has no wall in it, and " << way->events;
        ASSERT_EQ(events, way->events);
        ASSERT_EQ(region, way->region);
        judged += way->events.empty() ? 0 : 1;
      }
    }
    const Vec3 spring = 1000.0 * (out.proxy - hip);
    if (glm::length(out.force - spring) > 1e-6 * glm::length(spring) + 1e-6) ++unsettled;
    ASSERT_LE(glm::length(out.force), glm::length(spring) * (1.0 + 1e-6) + 1e-6);
    was_free = out.proxy == hip && !out.contact;
    last = hip;
  }
  EXPECT_LE(unsettled, ticks / 500);
  if (!scene->ports().empty()) {
    EXPECT_GT(judged, ticks / 1000);
  }
}

/// A hand that trembles by 0.1 mm around `point` [mm], after it came there from `free` through
/// `through`. Returns the number of changes of region beyond those explained by its own straight
/// ways, or by its ways through z = `level` [mm], where a hand that presses on the glass moves the
/// proxy through the liquid's surface.
int chatter(const Figure& figure, const ScenePtr& scene, const std::vector<Vec3>& through,
            const Vec3& point, double level, std::uint64_t seed) {
  Drive drive(scene);
  for (const Vec3& p : through) (void)drive.walk(1e-3 * p);
  (void)drive.walk(1e-3 * point);
  Random random(seed);
  Vec3 last = point;
  int region = drive.last().region;
  int changes = 0;
  int explained = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vec3 p = point + random.uniform(0.0, 0.1) * random.direction();
    const TickResult& out = drive.to(1e-3 * p);
    changes += out.region != region ? 1 : 0;
    region = out.region;
    if ((last.z > level) != (p.z > level)) {
      ++explained;
      last = p;
      continue;
    }
    // The crossings of a free hand on this way, with all ports passed before.
    PassedNames all;
    for (const Port& port : scene->ports()) all.pass(port.name, 9, 1);
    for (const Crossing& crossing : crossingsOf(figure, last, p, 32)) {
      explained += figure.way(crossing.from, crossing.to, crossing.point, all) ? 1 : 0;
    }
    last = p;
  }
  return changes - explained;
}

TEST(FigureRims, NothingChattersAtThem) {
  std::uint64_t seed = 1;
  const auto try_all = [&](const Figure& figure, const std::vector<Vec3>& inside,
                           const std::vector<Vec3>& outside, double x, double rho, bool along_z,
                           double level = -1e9) {
    const ScenePtr scene = figure.springs();
    for (const bool within : {false, true}) {
      for (const double depth : {0.3, 1.0, 4.0}) {
        for (double off = -1.0; off <= 1.01; off += 0.25) {
          const double r = rho + (within ? depth : -depth);
          const Vec3 point = along_z ? Vec3(r, 0, x + off) : Vec3(x + off, 0, r);
          EXPECT_LE(chatter(figure, scene, within ? inside : outside, point, level, seed++), 1)
              << figure.name << (within ? " inside" : " outside") << " depth " << depth << " off "
              << off;
        }
      }
    }
  };
  // The mouths of the tubes, the line where the liquid's surface meets the glass, and the rim of
  // the glass.
  try_all(figures()[1], {{-60, 0, 0}, {-35, 0, 0}}, {{-40, 0, 25}}, -45, 15, false);
  try_all(figures()[2], {{-60, 0, 0}, {-30, 0, 0}}, {{-35, 0, 25}}, -40, 12, false);
  try_all(figures()[3], {{0, 0, 60}, {0, 0, 25}}, {{0, 0, 60}, {0, 0, 22}}, 20, 29, true, 20);
  try_all(figures()[3], {{0, 0, 60}, {0, 0, 38}}, {{60, 0, 60}, {60, 0, 38}}, 40, 32, true);
}

}  // namespace
}  // namespace palpate::test
