#pragma once
// Shared by the hard cases: scenes of one solid, and a judge that compares a drive with the oracle.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <numbers>

#include "lib/render/drive.h"
#include "support/field_contract.h"
#include "support/oracle/oracle.h"

namespace palpate::test {

constexpr double kDegree = std::numbers::pi / 180.0;  // [rad]
constexpr double kDefaultK = 1000.0;                  // [N/m] of a wall whose layer names none

/// One layer, `solid`, made of `field`, with the default wall; the hand is held outside or inside
/// it.
inline ScenePtr sceneOfSolid(FieldPtr field, bool from_within = false, Material wall = {}) {
  SceneDescription description;
  LayerDescription layer;
  layer.name = "solid";
  layer.inside = std::make_shared<FieldSource>(std::move(field));
  if (wall.stiffness != 0.0) {
    wall.name = "wall";
    layer.wall.material = wall.name;
    description.materials.push_back(wall);
  }
  description.layers.push_back(layer);
  if (from_within) description.start_region = "solid";
  return compile(description);
}

inline oracle::FeasibleSet heldBy(const FieldPtr& field, bool from_within) {
  return from_within ? oracle::FeasibleSet::inside(field) : oracle::FeasibleSet::outside(field);
}

/// Drives a renderer and runs the oracle in parallel, starting from the renderer's own proxy of the
/// previous tick.
class Judge {
 public:
  Judge(ScenePtr scene, oracle::FeasibleSet set, double stiffness = kDefaultK)
      : drive_(std::move(scene)),
        set_(std::move(set)),
        stiffness_(stiffness),
        wall_slack_(4e-9 * set_.feature()) {}  // of the smallest feature size
  Judge(const FieldPtr& field, bool from_within)
      : Judge(sceneOfSolid(field, from_within), heldBy(field, from_within)) {}

  /// The oracle's step h [m]; near an edge, h and h / 10 must be shorter than the distance to it.
  void stepOracleBy(double step) { oracle_.step = step; }

  /// Compares the proxy with the oracle's only where `judged` is true: near a medial axis, beyond
  /// 0.9 of the reach, the minimum is too flat for 1e-6. Everywhere it must be finite and
  /// permitted.
  void onlyWhere(std::function<bool(const Vec3&)> judged) { judged_ = std::move(judged); }
  /// Grants `times` as much distance to the walls: in a sharp groove a corner is further away by
  /// that factor.
  void grant(double times) { wall_slack_ *= times; }

  /// Moves to where the hand begins; not judged.
  void begin(const Vec3& hip) {
    (void)drive_.to(hip);
    (void)drive_.to(hip);
  }

  /// One tick, judged: |F / K - (z - P)| and |x - z| are at most `tolerance` of |z - P|, and x is
  /// permitted. On a surface means within a billionth of the feature size of its leaf, so x is
  /// granted that much.
  void to(const Vec3& hip, double tolerance) {
    const Vec3 previous = drive_.last().proxy;
    oracle::OracleResult oracle = oracle::solveOracle(set_, previous, hip, oracle_);
    const TickResult& out = drive_.to(hip);
    if (oracle.converged && !oracle.ambiguous && oracle.errorOf(out.proxy, hip, 1e-5) > tolerance) {
      // If an edge is nearer than its steps, the oracle jumps over it. Then shorter steps decide.
      oracle::OracleSettings finer = oracle_;
      finer.step = (oracle_.step > 0.0 ? oracle_.step : 0.02 * set_.feature()) / 100.0;
      oracle = oracle::solveOracle(set_, previous, hip, finer);
    }
    ++ticks_;
    if (out.contact) ++contacts_;
    const double on_wall = wall_slack_;
    SCOPED_TRACE(::testing::Message()
                 << "tick " << ticks_ << ": hip " << text(hip) << ", proxy " << text(out.proxy)
                 << ", oracle " << text(oracle.proxy) << ", before " << text(previous) << ", depth "
                 << glm::length(oracle.proxy - hip) << ", force " << text(out.force));
    ASSERT_TRUE(isFinite(out.force) && isFinite(out.proxy));
    ASSERT_GE(set_.value(out.proxy), -2.0 * on_wall);
    if (judged_ && !judged_(hip)) return;
    ASSERT_TRUE(isNear(out.force / stiffness_, out.proxy - hip,
                       1e-6 * glm::length(out.proxy - hip) + on_wall));
    if (oracle.ambiguous) {
      ++ambiguous_;
      return;
    }
    ASSERT_TRUE(oracle.converged) << "the oracle is at fault";
    const double depth = glm::length(oracle.proxy - hip);
    const double off = glm::length(out.proxy - oracle.proxy);
    ASSERT_LE(off, tolerance * depth + on_wall);
    // Compares the force where the depth is above the oracle's own rounding.
    const double felt = glm::length(out.force / stiffness_ - (oracle.proxy - hip));
    ASSERT_LE(felt, tolerance * depth + 1e-5 * on_wall + 1e-12);
    if (depth > 1e-5) worst_ = std::max(worst_, felt / depth);
  }

  [[nodiscard]] Drive& drive() { return drive_; }
  [[nodiscard]] int ticks() const { return ticks_; }
  [[nodiscard]] int contacts() const { return contacts_; }
  [[nodiscard]] int ambiguous() const { return ambiguous_; }
  [[nodiscard]] double worst() const { return worst_; }

  static std::string text(const Vec3& p) {
    char buffer[96];
    (void)std::snprintf(buffer, sizeof buffer, "(%.9g, %.9g, %.9g)", p.x, p.y, p.z);
    return buffer;
  }

 private:
  Drive drive_;
  oracle::FeasibleSet set_;
  double stiffness_;
  double wall_slack_;  ///< [m]
  oracle::OracleSettings oracle_;
  std::function<bool(const Vec3&)> judged_;
  int ticks_ = 0;
  int contacts_ = 0;
  int ambiguous_ = 0;
  double worst_ = 0.0;
};

/// The motion of a wandering hand.
struct Pace {
  double speed;    ///< [m/s]
  double inertia;  ///< share of a tick's velocity that is kept in the next
  int ticks;
};

/// A smooth way from `from` to one goal after another, as next_goal() returns them; each tick is
/// judged.
template <typename NextGoal>
void judgeSmoothWay(Judge& judge, const Vec3& from, const Pace& pace, NextGoal&& next_goal) {
  judge.begin(from);
  const double step = pace.speed * Drive::kTick;
  Vec3 p = from;
  Vec3 velocity(0.0);
  Vec3 goal = next_goal();
  for (int i = 0; i < pace.ticks; ++i) {
    if (glm::length(goal - p) < 10.0 * step) goal = next_goal();
    velocity = pace.inertia * velocity + (1.0 - pace.inertia) * step * glm::normalize(goal - p);
    p += velocity;
    judge.to(p, 1e-6);
    if (::testing::Test::HasFatalFailure()) return;
  }
}

/// Walks between random points of a box, and after every five of them back to the free point.
inline void judgeWalk(Judge& judge, const Vec3& free, const Box3& box, double speed, int seed,
                      int ticks) {
  Random random(static_cast<std::uint64_t>(seed));
  int leg = 0;
  judgeSmoothWay(judge, free, {speed, 0.8, ticks}, [&] {
    const bool back = leg > 0 && leg % 6 == 0;
    ++leg;
    return back ? free : random.in(box);
  });
  if (::testing::Test::HasFatalFailure()) return;
  EXPECT_GT(judge.contacts(), judge.ticks() / 10);
  EXPECT_LT(judge.ambiguous(), judge.ticks() / 10);
}

}  // namespace palpate::test
