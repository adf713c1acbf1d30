// A hand in the loop: no limit cycle beyond those of a perfect renderer, and the slide off a ball
// that even a perfect renderer shows.

#include <gtest/gtest.h>

#include <functional>

#include "lib/render/hard_judge.h"
#include "palpate/fields/primitives.h"
#include "support/field_contract.h"
#include "support/oracle/closed_forms.h"

namespace palpate::test {
namespace {

using oracle::Held;
using oracle::Minima;

constexpr double kSeconds = 2.0;

/// A mass on the probe, pulled by a spring and a damper towards a commanded point.
struct SimulatedHand {
  double mass = 0.1;         // [kg]
  double stiffness = 400.0;  // [N/m]
  double damping = 4.0;      // [N s/m]: above K T / 2, the minimum for a wall of 3000 N/m at 1 kHz
  Vec3 position{0.0};
  Vec3 velocity{0.0};

  /// One tick of 1 ms under a held force.
  void move(const Vec3& commanded, const Vec3& force) {
    constexpr int kParts = 20;
    constexpr double kDt = 1e-3 / kParts;
    for (int i = 0; i < kParts; ++i) {
      const Vec3 pull = stiffness * (commanded - position) - damping * velocity;
      velocity += (kDt / mass) * (pull + force);
      position += kDt * velocity;
    }
  }
};

struct Felt {
  Vec3 swing{0.0};  ///< [N] peak to peak of each component over the last half second
  Vec3 end{0.0};    ///< [m] where the hand came to rest
};

using Renderer = std::function<Vec3(const Vec3&)>;  ///< HIP to force

/// Moves from `from` to `to` in a second, and stays. `encoder` [m]: positions are rounded to it.
Felt press(SimulatedHand hand, const Vec3& from, const Vec3& to, double encoder,
           const Renderer& render) {
  hand.position = from;
  Vec3 force(0.0);
  Vec3 lo(kInfinity);
  Vec3 hi(-kInfinity);
  const int ticks = static_cast<int>(kSeconds * 1e3) + 500;
  for (int i = 0; i < ticks; ++i) {
    const double share = std::min(1.0, 1e-3 * i);
    hand.move(from + share * (to - from), force);
    Vec3 read = hand.position;
    if (encoder > 0.0) {
      for (int k = 0; k < 3; ++k) read[k] = encoder * std::round(read[k] / encoder);
    }
    force = render(read);
    if (i < ticks - 500) continue;
    lo = glm::min(lo, force);
    hi = glm::max(hi, force);
  }
  return {hi - lo, hand.position};
}

Renderer rendererOf(Drive& drive) {
  return [&drive](const Vec3& p) { return drive.to(p).force; };
}

/// The closed form in the same loop; of several minima it takes the one nearest to its last proxy.
Renderer oracleOf(double stiffness, std::function<Minima(const Vec3&)> minima, const Vec3& start) {
  auto proxy = std::make_shared<Vec3>(start);
  return [=](const Vec3& p) {
    *proxy = oracle::nearestTo(minima(p), *proxy);
    return stiffness * (*proxy - p);
  };
}

struct Case {
  const char* name;
  FieldPtr field;
  bool from_within;
  std::function<Minima(const Vec3&)> minima;
  Vec3 from, to;
};

std::vector<Case> cases() {
  const Vec3 o(0.0);
  const Vec3 up(0, 0, 1);
  const Vec3 half = mm(30, 20, 10);
  std::vector<Case> out;
  out.push_back({"plane", halfSpace(o, up), false,
                 [=](const Vec3& p) { return oracle::planeMinima(p, o, up); }, mm(0, 0, 10),
                 mm(5, 3, -20)});
  out.push_back({"ball", sphere(o, 0.05), false,
                 [=](const Vec3& p) { return oracle::sphereMinima(p, o, 0.05, Held::kOutside); },
                 mm(2, 1, 60), mm(3, -2, 44)});
  for (const double radius : {0.05, 0.01, 0.002}) {
    out.push_back({"hollow", sphere(o, radius), true,
                   [=](const Vec3& p) { return oracle::sphereMinima(p, o, radius, Held::kInside); },
                   Vec3(0, 0, 0.1 * radius), mm(3, -2, 1e3 * radius + 20)});
  }
  out.push_back({"room", box(o, 2.0 * half), true,
                 [=](const Vec3& p) { return oracle::boxMinima(p, -half, half, Held::kInside); },
                 mm(0, 0, 0), mm(40, 35, 15)});
  out.push_back(
      {"torus", torus(o, up, 0.03, 0.01), false,
       [=](const Vec3& p) { return oracle::torusMinima(p, o, up, 0.03, 0.01, Held::kOutside); },
       mm(30, 1, 20), mm(29, 2, 7)});
  out.push_back(
      {"torus within", torus(o, up, 0.03, 0.01), true,
       [=](const Vec3& p) { return oracle::torusMinima(p, o, up, 0.03, 0.01, Held::kInside); },
       mm(30, 0, 0), mm(45, 20, 12)});
  return out;
}

TEST(HardHand, NoLimitCycleThatAPerfectRendererHasNot) {
  for (const Case& c : cases()) {
    for (const double stiffness : {500.0, 3000.0}) {
      for (const double encoder : {0.0, 10e-6}) {
        SCOPED_TRACE(::testing::Message()
                     << c.name << " K " << stiffness << " encoder " << encoder);
        Material wall;
        wall.stiffness = stiffness;
        Drive drive(sceneOfSolid(c.field, c.from_within, wall));
        (void)drive.to(c.from);
        const Felt felt = press({}, c.from, c.to, encoder, rendererOf(drive));
        const Felt perfect =
            press({}, c.from, c.to, encoder, oracleOf(stiffness, c.minima, c.from));
        EXPECT_TRUE(drive.last().contact);
        for (int k = 0; k < 3; ++k) EXPECT_LE(felt.swing[k], 1.1 * perfect.swing[k] + 1e-3) << k;
        EXPECT_TRUE(isNear(felt.end, perfect.end, encoder + 1e-6));
      }
    }
  }
}

TEST(HardHand, InDeepHollowsThePaperSwingsAndTheConstraintRendererRests) {
  // A light hand pressed `share` R beyond the wall of a hollow of 5 mm, a millimeter off its
  // middle.
  const double radius = 0.005;
  SimulatedHand hand;
  hand.mass = 0.02;
  hand.damping = 1.6;  // still above K T / 2
  Material wall;
  const double stiffness = 3000.0;  // [N/m]
  wall.stiffness = stiffness;
  const FieldPtr hollow = sphere(Vec3(0.0), radius);
  for (const double share : {0.5, 1.0, 2.0, 4.0}) {
    const Vec3 to(radius * (1.0 + share) + stiffness * radius * share / hand.stiffness, 1e-3,
                  0.5e-3);
    const auto swing = [&](RendererKind kind) {
      Drive drive(sceneOfSolid(hollow, true, wall), kind);
      (void)drive.to(Vec3(0.0));
      return glm::length(press(hand, Vec3(0.0), to, 0.0, rendererOf(drive)).swing);
    };
    const double perfect =
        glm::length(press(hand, Vec3(0.0), to, 0.0,
                          oracleOf(
                              stiffness,
                              [=](const Vec3& p) {
                                return oracle::sphereMinima(p, Vec3(0.0), radius, Held::kInside);
                              },
                              Vec3(0.0)))
                        .swing);
    EXPECT_LE(swing(RendererKind::kConstraint), 1.1 * perfect + 1e-3) << share;
    if (share < 2.0) {
      EXPECT_LE(swing(RendererKind::kPaper), 1.1 * perfect + 1e-3) << share;
    } else {
      EXPECT_GT(swing(RendererKind::kPaper), 5.0) << "a limit cycle, at kappa d = " << share;
    }
  }
}

TEST(HardHand, SlidesOffABallBelowTheLateralStiffnessOfTheContact) {
  // Pressed d deep with F = K d, a ball of radius R pushes sideways with F / (R - d) per meter: a
  // hand softer than that slides off, whatever the renderer, and a stiffer one stays.
  const double radius = 0.02;
  const double depth = 2e-3;
  const double force = kDefaultK * depth;
  const double critical = force / (radius - depth);
  for (const double share : {0.8, 1.2}) {
    SimulatedHand hand;
    hand.stiffness = share * critical;
    hand.damping = 1.0;
    // A commanded point at which the hand would rest `depth` deep if it were held sideways.
    const Vec3 to(2e-6, 0, radius - depth - force / hand.stiffness);  // 2 um off the axis
    const Vec3 from(2e-6, 0, radius * 1.01);
    Drive drive(sceneOfSolid(sphere(Vec3(0.0), radius)));
    (void)drive.to(from);
    const Felt felt = press(hand, from, to, 0.0, rendererOf(drive));
    const Felt perfect =
        press(hand, from, to, 0.0,
              oracleOf(
                  kDefaultK,
                  [=](const Vec3& p) {
                    return oracle::sphereMinima(p, Vec3(0.0), radius, Held::kOutside);
                  },
                  from));
    const double off = std::hypot(felt.end.x, felt.end.y);
    if (share > 1.0) {
      EXPECT_LT(off, 1e-4) << "stays";
      EXPECT_NEAR(felt.end.z, radius - depth, 1e-5);
    } else {
      // The commanded point is beyond the center: the probe comes to rest on the far side, still in
      // contact.
      EXPECT_LT(felt.end.z, -0.5 * radius) << "slides off";
      EXPECT_TRUE(drive.last().contact);
    }
    EXPECT_TRUE(isNear(felt.end, perfect.end, 1e-5)) << share;
  }
}

}  // namespace
}  // namespace palpate::test
