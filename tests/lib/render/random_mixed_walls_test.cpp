// Walls of different stiffness at random, pressed about as deep as the shapes are large: the hand is held as long as the
// proxy is elsewhere, no step of the force goes beyond what the walls' stiffness explains, and closed ways give no energy.

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <random>
#include <string>

#include "lib/render/energy_loop.h"

namespace palpate::test {
namespace {

struct MixedScene {
  std::string text;
  double least = kInfinity;  // [N/m] stiffness
  double most = 0.0;         // [N/m]
};

class Maker {
 public:
  explicit Maker(unsigned seed) : random_(seed) {}

  double in(double least, double most) {
    return std::uniform_real_distribution<double>(least, most)(random_);
  }
  Vec3 in(const Vec3& least, const Vec3& most) {
    const double x = in(least.x, most.x);
    const double y = in(least.y, most.y);
    return {x, y, in(least.z, most.z)};
  }
  Vec3 direction() {
    for (;;) {
      const Vec3 v = in(Vec3(-1.0), Vec3(1.0));
      const double length = glm::length(v);
      if (length > 0.1 && length < 1.0) return v / length;
    }
  }

  /// A tilted ground and one or two solids in it, each with a stiffness of its own.
  MixedScene scene() {
    MixedScene out;
    std::string materials;
    std::string layers;
    const int count = 2 + static_cast<int>(in(0.0, 2.0));
    for (int i = 0; i < count; ++i) {
      constexpr double kStiffness[] = {300.0, 500.0, 1000.0, 2000.0, 3000.0};
      const double stiffness = kStiffness[static_cast<int>(in(0.0, 5.0))];
      out.least = std::min(out.least, stiffness);
      out.most = std::max(out.most, stiffness);
      const std::string name = std::to_string(i);
      materials += "  m" + name + ": {stiffness: " + number(stiffness) + " N/m}\n";
      layers += "  - {name: l" + name + ", inside: {" + (i == 0 ? ground() : solid()) +
                "}, wall: m" + name + "}\n";
    }
    out.text = "palpate: 1\nlength: mm\nmaterials:\n" + materials + "layers:\n" + layers;
    return out;
  }

 private:
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6f", value);
    return text;
  }
  static std::string list(const Vec3& v) {
    return "[" + number(v.x) + ", " + number(v.y) + ", " + number(v.z) + "]";
  }
  std::string ground() {
    const Vec3 up = glm::normalize(in(Vec3(-0.5, -0.5, 1.0), Vec3(0.5, 0.5, 1.0)));
    return "half_space: {point: [0, 0, " + number(in(-1.0, 1.0)) + "], normal: " + list(up) + "}";
  }
  std::string solid() {
    const Vec3 place = in(Vec3(-1.0), Vec3(1.0, 1.0, 0.5));
    switch (static_cast<int>(in(0.0, 4.0))) {
      case 0: {
        const double radius = in(1.0, 8.0);
        return "sphere: {center: " + list(place - 0.5 * radius * direction()) +
               ", radius: " + number(radius) + "}";
      }
      case 1: {
        const double radius = in(0.8, 5.0);
        const Vec3 axis = glm::normalize(in(Vec3(-1.0, -1.0, -0.2), Vec3(1.0, 1.0, 0.2)));
        return "cylinder: {center: " + list(place - Vec3(0, 0, 0.5 * radius)) +
               ", axis: " + list(axis) + ", radius: " + number(radius) + ", height: 60}";
      }
      case 2:
        return "box: {center: " + list(in(Vec3(-3.0), Vec3(3.0, 3.0, 0.0))) +
               ", size: " + list(in(Vec3(2.0), Vec3(8.0))) + "}";
      default:
        return "half_space: {point: " + list(place) + ", normal: " + list(direction()) + "}";
    }
  }

  std::mt19937 random_;
};

constexpr double kStep = 20e-6;  // [m] a tick
/// What the walls explain: the rigid stop in series is 1.05 of the stiffest wall; where a press as deep as a bulge is large
/// takes it for flat, that adds as much again and some more. A hand let go of changes by a hundred times that in a tick.
constexpr double kExplained = 4.0;

/// Wanders deep into the walls, at most `deep` [m] from the proxy.
void expectHeldWithoutSteps(const MixedScene& made, unsigned seed, double deep, int ticks) {
  Maker way(seed + 1'000'000U);
  Drive drive(sceneOf(made.text));
  (void)drive.to(mm(0, 0, 20));
  (void)drive.walk(mm(0, 0, 8), 0.2e-3);
  Vec3 hand = mm(0, 0, 8);
  Vec3 target = hand;
  TickResult last = drive.last();
  for (int i = 0; i < ticks; ++i) {
    if (i % 150 == 0) target = 1e-3 * way.in(Vec3(-3.0, -3.0, -5.5), Vec3(3.0, 3.0, 0.5));
    if (i % 1500 == 0) target.z += 6e-3;
    const auto towards = [&](const Vec3& to) {
      const double length = glm::length(to - hand);
      return length < kStep ? to : hand + (kStep / length) * (to - hand);
    };
    Vec3 next = towards(target);
    if (glm::length(next - last.proxy) > deep) next = towards(last.proxy);
    const TickResult& now = drive.to(next);
    if (last.contact && now.contact && glm::length(now.proxy - last.proxy) < 1e-8 &&
        now.region == last.region) {
      EXPECT_LE(glm::length(now.force - last.force),
                kExplained * made.most * glm::length(next - hand) + 1e-5)
          << "seed " << seed << ", tick " << i << "\n"
          << made.text;
    }
    if (now.contact && glm::length(now.proxy - next) > 0.1 * deep) {
      EXPECT_GT(glm::length(now.force), 0.0) << "seed " << seed << ", tick " << i;
    }
    if (::testing::Test::HasFailure()) return;
    hand = next;
    last = now;
  }
}

TEST(RandomMixedWalls, HoldTheHandAndNeverKick) {
  const bool is_long = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  for (unsigned seed = 1; seed <= (is_long ? 1000U : 40U); ++seed) {
    const MixedScene made = Maker(seed).scene();
    expectHeldWithoutSteps(made, seed, seed % 2 == 0 ? 1e-3 : 2e-3, is_long ? 6000 : 2500);
    if (HasFailure()) return;
  }
}

TEST(RandomMixedWalls, GiveNoEnergy) {
  const bool is_long = std::getenv("PALPATE_SLOW_TESTS") != nullptr;
  double worst = 0.0;
  for (unsigned seed = 1; seed <= (is_long ? 500U : 15U); ++seed) {
    Maker maker(seed);
    const MixedScene made = maker.scene();
    EnergyLoop loop;
    loop.center = 1e-3 * maker.in(Vec3(-1.5, -1.5, -1.5), Vec3(1.5, 1.5, 0.5));
    double size = maker.in(0.3e-3, 1.5e-3);
    for (Vec3& wave : loop.wave) {
      wave = size * maker.in(Vec3(-1.0), Vec3(1.0));
      size *= 0.6;
    }
    const EnergyGiven given =
        energyGiven(sceneOf(made.text), mm(0, 0, 8), loop, is_long ? 64'000 : 16'000);
    // A lap in which the force steps, where an edge is reached, converges slowly.
    EXPECT_LE(given.work, 1e-9 + 3.0 * given.change) << "seed " << seed << "\n" << made.text;
    worst = std::max(worst, given.work - 3.0 * given.change);
  }
  std::printf("  at most %.3g J beyond what the last halving changed\n", worst);
}

/// A bar of bone on soft ground. The hand goes on beneath it, past its middle and out on the other side, while the proxy
/// stays where ground and bar meet: it is held back all the way.
TEST(RandomMixedWalls, ABarOnSoftGroundHoldsAHandThatIsPastIt) {
  const ScenePtr scene = sceneOf(R"(
palpate: 1
length: mm
materials:
  soft: {stiffness: 500 N/m}
  hard: {stiffness: 2000 N/m}
layers:
  - {name: ground, inside: {half_space: {point: [0, 0, 0], normal: [0, 0, 1]}}, wall: soft}
  - {name: bar, inside: {cylinder: {center: [0, 0, 0.3], axis: [0, 1, 0], radius: 1, height: 60}}, wall: hard}
)");
  Drive drive(scene);
  (void)drive.to(mm(-1.5, 0, 3));
  (void)drive.walk(mm(-1.5, 0, -0.4), kStep);
  const Vec3 edge = mm(-std::sqrt(1.0 - 0.09), 0, 0);
  Vec3 last = drive.last().force;
  for (double x = -1.5; x < 1.5; x += 0.02) {
    const Vec3 hand = mm(x, 0, -0.4);
    const TickResult out = drive.to(hand);
    EXPECT_LE(glm::length(out.force - last), kExplained * 2000.0 * kStep + 1e-5) << x;
    last = out.force;
    if (x < -0.6) continue;
    EXPECT_TRUE(isNear(out.proxy, edge, 1e-8)) << x;
    // Back, and at least as hard as the softer of the two would.
    EXPECT_LE(out.force.x, -500.0 * (hand.x - edge.x)) << x;
  }
  const Vec3 above = mm(1.5, 0, 0.1);
  (void)drive.walk(above, kStep);
  EXPECT_TRUE(isNear(drive.last().proxy, edge, 1e-8));
  EXPECT_LE(drive.last().force.x, -500.0 * (above.x - edge.x));
  EnergyLoop loop;
  loop.center = mm(-0.2, 0, 0.1);
  loop.wave[0] = mm(1.2, 0, 0);
  loop.wave[1] = mm(0, 0, 0.9);
  const EnergyGiven given = energyGiven(scene, mm(-0.5, 0, 4), loop, 64'000);
  EXPECT_LE(given.work, 1e-9 + 3.0 * given.change);
}

}  // namespace
}  // namespace palpate::test
