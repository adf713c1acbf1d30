// A scene that is edited while a hand touches it: Session::offer() carries the present contact
// over.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <random>
#include <sstream>
#include <thread>

#include "palpate/core/error.h"
#include "palpate/devices/session.h"
#include "palpate/scene/scene_file.h"
#include "support/wait.h"

namespace palpate::devices {
namespace {

/// A bowl of glass, open at the top, with syrup in it. Each line may be changed by an edit.
std::vector<std::string> bowlLines(double radius = 40.0, double stiffness = 800.0) {
  return {"palpate: 1",
          "length: mm",
          "fields:",
          "  bowl: {sphere: {center: [0, 0, 0], radius: " + std::to_string(radius) + "}}",
          "  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}",
          "materials:",
          "  glass: {stiffness: " + std::to_string(stiffness) + " N/m}",
          "  syrup: {viscosity: 1 N.s/m}",
          "layers:",
          "  - {name: liquid, inside: {intersection: [bowl, brim]}, content: syrup, wall: glass}",
          "ports:",
          "  - {name: mouth, between: [outside, liquid], on: brim}"};
}

ScenePtr sceneOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return compile(parseScene(text, "bowl.yaml"));
}

/// A servo thread that touches one place after the other, in simulated time and as fast as it can.
class Hand {
 public:
  static constexpr double kTick = 1e-3;     // [s]
  static constexpr double kSlew = 100.0;    // [N/s]
  static constexpr double kSpeed = 0.2e-3;  // [m] in a tick

  explicit Hand(ScenePtr scene, RendererSettings settings = {})
      : session_(std::move(scene), {.renderer = settings}) {}

  SessionTick step() {
    const Vec3 way = goal_ - place_;
    const double length = glm::length(way);
    if (length > 0.0) place_ += way * std::min(1.0, kSpeed / length);
    reading_.position = place_;
    reading_.time += kTick;
    return session_.step(reading_, DeviceFrame::kWorld);
  }
  SessionTick to(const Vec3& goal) {
    goal_ = goal;
    SessionTick last = step();
    while (place_ != goal_) last = step();
    return last;
  }
  Session& session() { return session_; }
  void aim(const Vec3& goal) { goal_ = goal; }
  [[nodiscard]] bool isThere() const { return place_ == goal_; }

 private:
  Session session_;
  DeviceState reading_;
  Vec3 place_{0.0, 0.0, 0.03};
  Vec3 goal_{0.0, 0.0, 0.03};
};

// In the syrup, through the mouth: when the bowl becomes slightly larger, the probe is still in the
// syrup. A probe that began anew would be outside, and be pushed out.
TEST(EditedScene, TheProbeGoesOnInItsRegion) {
  Hand hand(sceneOf(bowlLines()));
  ASSERT_EQ(hand.to({0, 0, -0.030}).result.region, 1);
  std::atomic<bool> is_offered{false};
  std::jthread editor([&] {
    hand.session().offer(sceneOf(bowlLines(42.0)), {});
    is_offered = true;
  });
  const testing::Deadline deadline;
  while (!is_offered && !deadline.hasPassed()) {
    const SessionTick tick = hand.step();
    ASSERT_EQ(tick.result.region, 1);
    ASSERT_LT(glm::length(tick.force), 0.5) << "of the syrup, at 0.2 m/s at most";
  }
  editor.join();
  EXPECT_EQ(hand.session().scene().regions()[1].field->bounds().hi.x, 0.042);
  for (int i = 0; i < 100; ++i) (void)hand.step();  // until the force is back
  EXPECT_EQ(hand.to({0, 0, -0.041}).result.region, 1);
  EXPECT_LT(glm::length(hand.to({0, 0, -0.0415}).force), 0.5) << "the new wall is at 42 mm";
  EXPECT_GT(hand.to({0, 0, -0.044}).force.z, 1.0);
}

// The probe goes through the mouth all the time: whichever regions it is in when the state is taken
// and when the scene is swapped, its region agrees with its place afterwards.
TEST(EditedScene, WhoPassesAPortMeanwhileHasPassedIt) {
  Hand hand(sceneOf(bowlLines()));
  std::atomic<bool> is_over{false};
  std::jthread editor([&] {
    for (int i = 0; i < 40; ++i) hand.session().offer(sceneOf(bowlLines(40.0 + i % 2)), {});
    is_over = true;
  });
  const testing::Deadline deadline;
  int passed = 0;
  bool is_inside = false;
  while (!is_over && !deadline.hasPassed()) {
    if (hand.isThere()) {
      is_inside = !is_inside;
      hand.aim({0, 0, is_inside ? 0.0145 : 0.0155});
    }
    const SessionTick tick = hand.step();
    passed += tick.result.event_count;
    const bool is_below = tick.hip.position.z < 0.015;
    ASSERT_EQ(tick.result.region, is_below ? 1 : 0) << tick.hip.position.z;
  }
  EXPECT_GT(passed, 10);
}

// A tick says which scene it is in, and an offer what became of the probe.
TEST(EditedScene, TicksAreCountedByScene) {
  Hand hand(sceneOf(bowlLines()));
  ASSERT_EQ(hand.to({0, 0, -0.030}).scene, 0U);
  std::vector<std::string> renamed = bowlLines(41.0);
  renamed[9] = "  - {name: water, inside: {intersection: [bowl, brim]}, wall: glass}";
  renamed[11] = "  - {name: mouth, between: [outside, water], on: brim}";
  const std::vector<ScenePtr> scenes = {sceneOf(bowlLines(41.0)), sceneOf(renamed)};
  std::vector<SceneOffer> offers;
  std::atomic<bool> is_over{false};
  std::jthread editor([&] {
    for (const ScenePtr& scene : scenes) offers.push_back(hand.session().offer(scene, {}));
    is_over = true;
  });
  const testing::Deadline deadline;
  std::vector<SessionTick> firsts;
  std::uint64_t last = 0;
  while (!is_over && !deadline.hasPassed()) {
    const SessionTick tick = hand.step();
    if (tick.scene != last) {
      firsts.push_back(tick);
    } else {
      ASSERT_FALSE(tick.begins_anew);
    }
    last = tick.scene;
  }
  editor.join();
  ASSERT_EQ(firsts.size(), 2U);
  ASSERT_EQ(offers.size(), 2U);
  for (std::size_t i = 0; i < 2; ++i) {
    EXPECT_EQ(offers[i].scene, i + 1);
    EXPECT_EQ(firsts[i].scene, i + 1);
    EXPECT_EQ(firsts[i].begins_anew, !offers[i].goes_on);
  }
  EXPECT_TRUE(offers[0].goes_on);
  EXPECT_TRUE(offers[0].lost.empty());
  EXPECT_FALSE(offers[1].goes_on);
  ASSERT_FALSE(offers[1].lost.empty());
  EXPECT_NE(offers[1].lost[0].find("liquid"), std::string::npos);
}

/// An edit of one line, and whether the result is a valid scene.
struct Edit {
  std::vector<std::string> lines;
  int line = 0;  ///< from 1
  bool is_valid = true;
};

Edit randomEdit(std::mt19937_64& random) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  Edit edit{bowlLines(38.0 + 4.0 * share(random), 300.0 + 900.0 * share(random))};
  switch (std::uniform_int_distribution<int>(0, 7)(random)) {
    case 0:  // an unknown key
      edit.lines[6] = "  glass: {stiffnes: 800 N/m}";
      return {edit.lines, 7, false};
    case 1:  // a quantity of another dimension
      edit.lines[7] = "  syrup: {viscosity: 1 N}";
      return {edit.lines, 8, false};
    case 2:  // a wall with an unknown material
      edit.lines[9] =
          "  - {name: liquid, inside: {intersection: [bowl, brim]}, content: syrup, wall: glas}";
      return {edit.lines, 10, false};
    case 3:  // not even YAML
      edit.lines[3] = "  bowl: {sphere: {center: [0, 0, 0], radius: 40";
      return {edit.lines, 0, false};
    case 4:  // the layer has another name, so the probe begins anew
      edit.lines[9] = "  - {name: water, inside: {intersection: [bowl, brim]}, wall: glass}";
      edit.lines[11] = "  - {name: mouth, between: [outside, water], on: brim}";
      return edit;
    case 5:  // the mouth is shut
      edit.lines.resize(10);
      return edit;
    default:
      return edit;
  }
}

TEST(EditedScene, FiftyEditsWhileAHandTouches) {
  constexpr double kMost = 5.0;  // [N]
  RendererSettings settings;
  settings.limits.max_growth = Hand::kSlew;
  settings.limits.max_force = kMost;
  Hand hand(sceneOf(bowlLines()), settings);
  (void)hand.to({0, 0, 0.0});
  std::atomic<bool> is_over{false};
  std::atomic<int> valid{0};
  std::atomic<int> refused{0};
  std::jthread editor([&] {
    std::mt19937_64 random(23);
    for (int i = 0; i < 50; ++i) {
      const Edit edit = randomEdit(random);
      try {
        const ScenePtr scene = sceneOf(edit.lines);
        EXPECT_TRUE(edit.is_valid) << i;
        hand.session().offer(scene, settings);
        ++valid;
      } catch (const Error& error) {
        EXPECT_FALSE(edit.is_valid) << i << ": " << error.what();
        if (edit.line > 0) {
          EXPECT_EQ(error.problem().line, edit.line) << error.what();
        } else {
          EXPECT_GT(error.problem().line, 0) << error.what();
        }
        ++refused;
      }
    }
    is_over = true;
  });
  // Strokes along the glass. The limit of growth holds for the force that the hand gets, also while
  // it comes back after an edit.
  const double limit = Hand::kSlew * Hand::kTick * (1.0 + 1e-9);
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> any(-1.0, 1.0);
  const testing::Deadline deadline;
  Vec3 last(0.0);
  double peak = 0.0;
  while (!is_over && !deadline.hasPassed()) {
    if (hand.isThere()) {
      hand.aim(0.041 * glm::normalize(Vec3(any(random), any(random), -1.0)));
    }
    const SessionTick tick = hand.step();
    ASSERT_TRUE(isFinite(tick.force));
    // Any decrease is allowed: any share of the last force may remain.
    const double square = glm::dot(last, last);
    const double share =
        square > 0.0 ? std::clamp(glm::dot(tick.force, last) / square, 0.0, 1.0) : 0.0;
    ASSERT_LE(glm::length(tick.force - share * last), limit);
    last = tick.force;
    peak = std::max(peak, glm::length(last));
  }
  editor.join();
  EXPECT_EQ(valid + refused, 50);
  EXPECT_GT(valid, 20);
  EXPECT_GT(refused, 10);
  EXPECT_GT(peak, 0.5) << "the hand touched the glass";
}

}  // namespace
}  // namespace palpate::devices
