// What a device may do to a renderer: broken numbers, jumps; and what the loop requires of it: no
// allocation, and reproducible results.

#include <gtest/gtest.h>

#include <bit>
#include <limits>

#include "lib/render/drive.h"
#include "support/alloc_guard.h"
#include "support/field_contract.h"

namespace palpate::test {
namespace {

class Robust : public ::testing::TestWithParam<RendererKind> {};
INSTANTIATE_TEST_SUITE_P(Renderers, Robust,
                         ::testing::Values(RendererKind::kPaper, RendererKind::kConstraint),
                         kindName);

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();

const std::vector<HipState> kBroken = {
    {Vec3(kNan, 0, 0), Vec3(0.0)},        {Vec3(0, kInfinity, 0), Vec3(0.0)},
    {Vec3(0, 0, -kInfinity), Vec3(0.0)},  {mm(0, 0, 0), Vec3(kNan)},
    {mm(0, 0, 0), Vec3(kInfinity, 0, 0)}, {Vec3(1.1e4, 0, 0), Vec3(0.0)},
    {Vec3(0, 0, -1e300), Vec3(0.0)}};

TEST_P(Robust, BrokenTicksGiveNoForceAndChangeNothing) {
  // Two drives side by side; one receives broken ticks in between, and must not differ in the good
  // ones.
  const ScenePtr scene = sceneOf(containerText());
  Drive clean(scene, GetParam());
  Drive disturbed(scene, GetParam());
  std::vector<Vec3> stops{mm(60, 0, 0), mm(38, 0, 5),  mm(60, 0, 30), mm(0, 0, 30),
                          mm(0, 0, 0),  mm(0, 0, -42), mm(0, 0, 30)};
  for (const Vec3& stop : stops) {
    (void)clean.walk(stop);
    (void)disturbed.walk(stop);
    for (const HipState& broken : kBroken) {
      const TickResult out = disturbed.renderer().update(broken);
      EXPECT_EQ(out.force, Vec3(0.0));
      EXPECT_EQ(out.region, clean.last().region);
      EXPECT_EQ(out.event_count, 0);
      EXPECT_TRUE(isFinite(out.proxy));
    }
    (void)clean.to(stop + mm(0.1, 0, 0));
    (void)disturbed.to(stop + mm(0.1, 0, 0));
    EXPECT_EQ(clean.last().force, disturbed.last().force);
    EXPECT_EQ(clean.last().proxy, disturbed.last().proxy);
    EXPECT_EQ(clean.events(), disturbed.events());
  }
}

TEST_P(Robust, TheUnlimitedForceIsThatOfTheLastTickAndOfNoOther) {
  RendererSettings settings;
  settings.limits.max_force = 1.0;
  Drive drive(sceneOf(containerText()), GetParam(), settings);
  const auto press = [&] {
    (void)drive.walk(mm(60, 0, 0));
    EXPECT_NEAR(glm::length(drive.walk(mm(38, 0, 0)).force), 1.0, 1e-9);
    // Twice 1.5 N; the paper's contact point is on the ball to a micrometer.
    EXPECT_NEAR(drive.renderer().unlimitedForce().x, 3.0, 2e-3);
  };
  press();
  (void)drive.renderer().update(kBroken[0]);
  EXPECT_EQ(drive.renderer().unlimitedForce(), Vec3(0.0)) << "nothing was computed";
  press();
  drive.renderer().reset();
  EXPECT_EQ(drive.renderer().unlimitedForce(), Vec3(0.0)) << "there was no tick yet";
}

TEST_P(Robust, ABrokenFirstTickDoesNotStart) {
  for (const std::string start : {"outside", "liquid"}) {
    Drive drive(sceneOf(containerText("start: {region: " + start + "}\n")), GetParam());
    const TickResult out = drive.renderer().update(kBroken[0]);
    EXPECT_EQ(drive.scene().regions()[out.region].name, start)
        << "nothing was read yet but the scene";
    EXPECT_EQ(out.force, Vec3(0.0));
    (void)drive.walk(start == "liquid" ? mm(0, 0, 0) : mm(60, 0, 0));
    EXPECT_EQ(drive.region(), start);
  }
}

TEST_P(Robust, HugeJumpsAreFiniteAndForgotten) {
  for (const double far : {1.0, 1e3, 9e3, 1e6, 1e9, 1e100, 1e308}) {
    Drive drive(sceneOf(containerText()), GetParam());
    (void)drive.walk(mm(60, 0, 0));
    for (const Vec3& u : {Vec3(1, 0, 0), Vec3(-1, 0, 0), Vec3(0.5, -0.3, 0.7), Vec3(-1, -1, -1)}) {
      EXPECT_TRUE(isFinite(drive.to(far * u).force)) << far;
      EXPECT_TRUE(isFinite(drive.last().proxy)) << far;
      EXPECT_TRUE(isFinite(drive.to(mm(60, 0, 0)).force)) << far;
      for (int i = 0; i < 3; ++i) (void)drive.to(mm(60, 0, 0));
      ASSERT_EQ(drive.region(), "outside") << far;
    }
    if (GetParam() == RendererKind::kPaper) continue;
    (void)drive.walk(mm(60, 0, 20));
    (void)drive.walk(mm(60, 0, 0));
    EXPECT_TRUE(isNear(drive.walk(mm(39, 0, 0)).force, Vec3(1.5, 0, 0), 1e-9)) << far;
    (void)drive.walk(mm(60, 0, 0));
    EXPECT_EQ(drive.last().force, Vec3(0.0)) << far;
    EXPECT_EQ(drive.events(), "") << far;
  }
}

TEST(Plate, IsNeverPassedWhateverTheJump) {
  // A thin plate wider than all jumps: the proxy never changes its side.
  for (const double thickness : {1.0, 0.1, 0.001}) {
    const ScenePtr scene = sceneOf(
        "palpate: 1\nlength: mm\nlayers: [{name: plate, inside: {box: {center: [0, 0, 0], size: "
        "[1e7, 1e7, " +
        std::to_string(thickness) + "]}}}]\n");
    for (const double jump : {1e-4, 5e-3, 20e-3, 1.0, 1e3}) {
      Drive drive(scene);
      Random random(6);
      (void)drive.to(mm(0, 0, 10));
      for (int i = 0; i < 3000; ++i) {
        const Vec3 hip = jump * random.in({Vec3(-1.0), Vec3(1.0)});
        const TickResult& out = drive.to(hip);
        ASSERT_GT(out.proxy.z, 0.49e-3 * thickness) << thickness << " " << jump << " " << i;
        ASSERT_EQ(out.region, kOutside);
      }
    }
  }
}

/// Everything the hand can do in the container: all rows, both ways over the rim.
std::vector<Vec3> everything() {
  std::vector<Vec3> path;
  Random random(9);
  Vec3 p = mm(60, 0, 0);
  Vec3 drift(0.0);
  for (int i = 0; i < 20000; ++i) {
    drift = 0.95 * drift + 0.1 * random.direction();
    // The hand moves along the ball, up to a millimeter inside or outside it, and now and then
    // somewhere else.
    p = glm::normalize(p + 2e-3 * drift) * (0.04 + 0.001 * std::sin(0.01 * i));
    path.push_back(i % 100 > 97 ? random.in({Vec3(-0.06), Vec3(0.06)}) : p);
  }
  return path;
}

TEST_P(Robust, NeverAllocatesLocksOrThrows) {
  const std::vector<Vec3> path = everything();
  for (const std::string& text : {containerText(), containerText("start: {region: liquid}\n"),
                                  containerText("memory: keep\n")}) {
    RendererSettings settings;
    settings.kind = GetParam();
    const auto renderer = makeRenderer(sceneOf(text), settings);
    int events = 0;
    int contacts = 0;
    palpate::testing::AllocGuard guard;
    for (std::size_t i = 0; i < path.size(); ++i) {
      if (i == path.size() / 2) renderer->reset();
      const TickResult out = renderer->update({path[i], Vec3(0.01, 0, 0)});
      events += out.event_count;
      contacts += out.contact ? 1 : 0;
    }
    for (const HipState& broken : kBroken) (void)renderer->update(broken);
    EXPECT_EQ(guard.violations(), 0);
    EXPECT_GT(events, 10) << "crossings were among it";
    EXPECT_GT(contacts, 1000);
  }
}

TEST_P(Robust, TheSameAgainBitForBit) {
  const auto bits = [](const Vec3& v) {
    return std::array{std::bit_cast<std::uint64_t>(v.x), std::bit_cast<std::uint64_t>(v.y),
                      std::bit_cast<std::uint64_t>(v.z)};
  };
  const std::vector<Vec3> path = everything();
  Drive first(sceneNamed("container"), GetParam());
  Drive second(sceneNamed("container"), GetParam());
  std::vector<TickResult> trace;
  for (const Vec3& p : path) {
    const TickResult& a = first.to(p);
    const TickResult& b = second.to(p);
    trace.push_back(a);
    ASSERT_EQ(bits(a.force), bits(b.force));
    ASSERT_EQ(bits(a.proxy), bits(b.proxy));
    ASSERT_EQ(a.region, b.region);
    ASSERT_EQ(a.event_count, b.event_count);
  }
  // The same after a reset, except for -0: the first tick's velocity is 0 there as well.
  Drive third(sceneNamed("container"), GetParam());
  for (const Vec3& p : path) (void)third.to(p);
  third.renderer().reset();
  Vec3 last = path[0];
  for (std::size_t i = 0; i < path.size(); ++i) {
    const TickResult out = third.renderer().update({path[i], (path[i] - last) / Drive::kTick});
    last = path[i];
    ASSERT_EQ(bits(out.force), bits(trace[i].force)) << i;
    ASSERT_EQ(bits(out.proxy), bits(trace[i].proxy)) << i;
  }
}

}  // namespace
}  // namespace palpate::test
