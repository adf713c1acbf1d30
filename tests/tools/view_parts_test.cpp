// The parts of `palpate view`: surfaces, the hand that a page moves, recorded runs, and the desk
// that answers pages.

#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <cstring>
#include <map>
#include <numbers>
#include <thread>
#include <utility>

#include "helpers.h"
#include "palpate/core/error.h"
#include "palpate/fields/csg.h"
#include "palpate/fields/primitives.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"
#include "support/wait.h"
#include "view/page_desk.h"
#include "view/page_files.h"
#include "view/recorded_run.h"
#include "view/shown_scene.h"
#include "view/steered_hand.h"
#include "view/surface_net.h"

namespace palpate::tools {
namespace {

using testing::runPalpate;
using testing::TempFolder;

double volumeOf(const SurfaceNet& net) {
  double volume = 0.0;
  for (const auto& t : net.triangles) {
    volume += glm::dot(net.points[t[0]], glm::cross(net.points[t[1]], net.points[t[2]])) / 6.0;
  }
  return volume;
}

/// How many more times each edge is used in one direction than in the other; all zero for a closed
/// surface.
int openEdges(const SurfaceNet& net) {
  std::map<std::pair<std::uint32_t, std::uint32_t>, int> edges;
  for (const auto& t : net.triangles) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::uint32_t a = t[i];
      const std::uint32_t b = t[(i + 1) % 3];
      edges[{std::min(a, b), std::max(a, b)}] += a < b ? 1 : -1;
    }
  }
  int open = 0;
  for (const auto& [edge, count] : edges) open += count != 0 ? 1 : 0;
  return open;
}

TEST(SurfaceNet, ASphereIsClosedOnTheSphereAndSeenFromOutside) {
  const double radius = 0.04;
  const FieldPtr ball = sphere(Vec3(0.01, -0.02, 0.003), radius);
  const SurfaceNet net = surfaceNet(*ball, ball->bounds().grownBy(0.005), 40);
  ASSERT_GT(net.triangles.size(), 1000U);
  EXPECT_EQ(openEdges(net), 0);
  for (std::size_t i = 0; i < net.points.size(); ++i) {
    const Vec3 from_center = net.points[i] - Vec3(0.01, -0.02, 0.003);
    // Newton's method converges to rounding.
    EXPECT_NEAR(glm::length(from_center), radius, 1e-12);
    EXPECT_NEAR(glm::dot(net.normals[i], from_center) / radius, 1.0, 1e-12);
  }
  // Chords lie inside the sphere, by no more than the stated error.
  const double whole = 4.0 / 3.0 * std::numbers::pi * radius * radius * radius;
  const double area = 4.0 * std::numbers::pi * radius * radius;
  EXPECT_LT(volumeOf(net), whole);
  EXPECT_GT(volumeOf(net), whole - area * net.error);
  // The sagitta of a triangle whose sides are at most two diagonals of a cell.
  const double side = 2.0 * std::sqrt(3.0) * 0.09 / 40;
  EXPECT_GT(net.error, 0.0);
  EXPECT_LT(net.error, side * side / 6.0 / radius);
}

TEST(SurfaceNet, IsAsFineAsItsErrorAsksFor) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.04);
  const Box3 box = ball->bounds().grownBy(0.005);
  const SurfaceNet coarse = surfaceWithin(*ball, box, 1e-3);
  const SurfaceNet fine = surfaceWithin(*ball, box, 2e-5);
  EXPECT_EQ(coarse.cells, 32);
  EXPECT_LE(coarse.error, 1e-3);
  EXPECT_GT(fine.cells, coarse.cells);
  EXPECT_LE(fine.error, 2e-5);
}

TEST(SurfaceNet, APlaneEndsAtTheBox) {
  const FieldPtr below = halfSpace(Vec3(0.0, 0.0, 0.001), Vec3(0.0, 0.0, 1.0));
  const SurfaceNet net = surfaceNet(*below, {Vec3(-0.05), Vec3(0.05)}, 16);
  ASSERT_FALSE(net.triangles.empty());
  EXPECT_GT(openEdges(net), 0);
  for (const Vec3& p : net.points) EXPECT_NEAR(p.z, 0.001, 1e-15);
  for (const Vec3& n : net.normals) EXPECT_EQ(n, Vec3(0.0, 0.0, 1.0));
}

TEST(SurfaceNet, BytesAreAsThePageReadsThem) {
  const FieldPtr ball = sphere(Vec3(0.0), 0.04);
  const SurfaceNet net = surfaceNet(*ball, ball->bounds().grownBy(0.005), 12);
  const std::string bytes = surfaceBytes(net);
  ASSERT_EQ(bytes.size(), 12 + 24 * net.points.size() + 12 * net.triangles.size());
  EXPECT_EQ(bytes.substr(0, 4), "PSRF");
  const auto number = [&](std::size_t at) {
    std::uint32_t value = 0;
    std::memcpy(&value, bytes.data() + at, sizeof value);
    return value;
  };
  EXPECT_EQ(number(4), net.points.size());
  EXPECT_EQ(number(8), net.triangles.size());
  float x = 0.0F;
  std::memcpy(&x, bytes.data() + 12, sizeof x);
  EXPECT_EQ(x, static_cast<float>(net.points[0].x));
  EXPECT_EQ(number(bytes.size() - 4), net.triangles.back()[2]);
}

TEST(SteeredHand, GoesThereSmoothlyAndNoFasterThanAHand) {
  SteeredHand hand(Vec3(0.0));
  hand.steer(Vec3(0.1, 0.0, 0.0));
  Vec3 last(0.0);
  for (int i = 1; i <= 2000; ++i) {
    const Vec3 now = hand.at(1e-3 * i);
    EXPECT_LE(glm::length(now - last), SteeredHand::kSpeed * 1e-3 * (1 + 1e-9)) << i;
    EXPECT_GE(now.x, last.x);
    last = now;
  }
  // At the limit of speed 0.1 m take 0.2 s; the remaining distance shrinks by a factor of e each
  // kTime.
  EXPECT_NEAR(last.x, 0.1, 0.1 * std::exp(-(2.0 - 0.2) / SteeredHand::kTime) + 1e-12);
  hand.steer(Vec3(NAN, 0.0, 0.0));
  EXPECT_NEAR(hand.at(2.1).x, 0.1, 1e-9);
  // After the machine has slept, the hand does not jump.
  hand.steer(Vec3(0.0));
  EXPECT_GE(hand.at(100.0).x, 0.1 - SteeredHand::kSpeed * SteeredHand::kLongest - 1e-9);
}

TEST(SteeredHand, TheServoThreadNeitherWaitsNorAllocatesWhileItIsToldThings) {
  SteeredHand hand(Vec3(0.0));
  std::atomic<bool> stop{false};
  std::thread teller([&] {
    // Both targets are on one line: a mixture of two would be off it.
    for (int i = 0; !stop.load(); ++i) hand.steer(i % 2 == 0 ? Vec3(1.0) : Vec3(-1.0));
  });
  bool is_on_line = true;
  std::int64_t violations = 0;
  {
    const testing::AllocGuard guard;
    for (int i = 1; i <= 200000; ++i) {
      const Vec3 p = hand.at(1e-4 * i);
      is_on_line = is_on_line && p.x == p.y && p.y == p.z;
    }
    violations = guard.violations();
  }
  stop.store(true);
  teller.join();
  EXPECT_TRUE(is_on_line);
  EXPECT_EQ(violations, 0);
}

/// A record of a path into the container through its mouth, against its bottom, and out again.
class ViewedRecord : public ::testing::Test {
 protected:
  ViewedRecord() {
    const auto touched =
        runPalpate({"touch", "cup.yaml", "--insert", "0,0,60", "0,0,-45", "--back", "--speed",
                    "200mm/s", "--record", "felt.npy", "--trace", "felt.csv", "--json"},
                   folder_.path());
    EXPECT_EQ(touched.exit_code, 0) << touched.err;
  }

  TempFolder folder_;
  Console console_{true};
  LoadedScene loaded_{folder_.file("cup.yaml", testing::kContainer), console_};
  ScenePtr scene_ = loaded_.compile();
};

TEST_F(ViewedRecord, ARecordAndATraceAreTheSameRun) {
  const RecordedRun record(folder_.path("felt.npy"), *scene_);
  const RecordedRun trace(folder_.path("felt.csv"), *scene_);
  ASSERT_GT(record.size(), 1000U);
  ASSERT_EQ(record.size(), trace.size());
  for (std::size_t i = 0; i < record.size(); ++i) {
    const FeedView a = record.at(i, 0);
    const FeedView b = trace.at(i, 0);
    ASSERT_EQ(a.hip, b.hip) << i;
    ASSERT_EQ(a.result.proxy, b.result.proxy) << i;
    ASSERT_EQ(a.result.force, b.result.force) << i;
    ASSERT_EQ(a.result.region, b.result.region) << i;
    ASSERT_EQ(a.result.contact, b.result.contact) << i;
    ASSERT_EQ(a.work, b.work) << i;
    ASSERT_EQ(a.passed, b.passed) << i;
    ASSERT_EQ(a.entries.size(), b.entries.size()) << i;
  }
  const FeedView end = record.at(record.size() - 1, 0);
  ASSERT_EQ(end.entries.size(), 2U);
  EXPECT_EQ(end.entries[0].to, 1);
  EXPECT_EQ(end.entries[1].to, kOutside);
  EXPECT_EQ(end.passed, std::vector<int>{0});
  // In the middle of the record the proxy is inside.
  const FeedView middle = record.at(record.size() / 2, 0);
  EXPECT_EQ(middle.passed, std::vector<int>{1});
  EXPECT_TRUE(middle.result.contact);
  EXPECT_EQ(feltAt(*scene_, middle.hip, middle.result).wall, "glass (1500 N/m)");
  const std::vector<double> overview = record.overview(10);
  ASSERT_EQ(overview.size(), 10U);
  EXPECT_EQ(overview.front(), 0.0);
  EXPECT_GT(*std::max_element(overview.begin(), overview.end()), 7.0);  // 5 mm at 1500 N/m
}

TEST_F(ViewedRecord, AnotherSceneOrAnotherFileIsAnError) {
  (void)folder_.file("ball.yaml",
                     "palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: {center: "
                     "[0, 0, 0], radius: 40}}}\n");
  LoadedScene other(folder_.path("ball.yaml"), console_);
  const ScenePtr ball = other.compile();
  EXPECT_THROW(RecordedRun(folder_.path("felt.npy"), *ball), Error);
  EXPECT_THROW(RecordedRun(folder_.path("felt.csv"), *ball), Error);
  EXPECT_THROW(RecordedRun(folder_.path("cup.yaml"), *scene_), Error);
  EXPECT_THROW(RecordedRun(folder_.path("nothing.csv"), *scene_), Error);
}

TEST_F(ViewedRecord, ThePageGoesThroughItRowByRow) {
  const RecordedRun run(folder_.path("felt.npy"), *scene_);
  PageDesk desk({.run = &run}, std::make_shared<const ShownScene>(scene_, loaded_, "text", 0));
  const PageHost host = desk.host();
  const auto shown = [&] {
    std::uint64_t seen = 0;
    return Json::parse(host.snapshot(seen, {.steers = true, .is_steered = true, .pages = 1}));
  };
  EXPECT_EQ(shown()["row"], 0);
  EXPECT_EQ(shown()["tick"]["region"], 0);
  host.command(R"({"row":)" + std::to_string(run.size() / 2) + "}");
  EXPECT_EQ(shown()["row"], run.size() / 2);
  EXPECT_EQ(shown()["tick"]["region"], 1);
  EXPECT_EQ(shown()["tick"]["content"].get<std::string>().substr(0, 5), "syrup");
  EXPECT_EQ(shown()["tick"]["entries"].size(), 1U);
  host.command(R"({"row":999999999})");
  EXPECT_EQ(shown()["row"], run.size() - 1);
  // A text that is not a command changes nothing.
  for (const char* broken : {"", "{", "[]", "null", R"({"row":-1})", R"({"row":"1"})",
                             R"({"to":[1,2]})", R"({"to":[1,2,"x"]})", R"({"to":[1e999,0,0]})"}) {
    host.command(broken);
    EXPECT_EQ(shown()["row"], run.size() - 1) << broken;
  }
}

TEST_F(ViewedRecord, ASceneIsThereInWordsAndSurfaces) {
  const RecordedRun run(folder_.path("felt.npy"), *scene_);
  const auto scene = std::make_shared<const ShownScene>(scene_, loaded_, "the text", 7);
  PageDesk desk({.run = &run}, scene);
  const PageHost host = desk.host();
  const auto answer = host.get("scene.json");
  ASSERT_TRUE(answer);
  const Json json = Json::parse(*answer->bytes);
  EXPECT_EQ(json["number"], 7);
  EXPECT_EQ(json["file"], "cup.yaml");
  const auto text = host.get("text.json");
  ASSERT_TRUE(text);
  EXPECT_EQ(Json::parse(*text->bytes)["text"], "the text");
  EXPECT_EQ(Json::parse(*text->bytes)["state"], "felt");
  EXPECT_EQ(json["mode"], "replay");
  EXPECT_EQ(json["rows"], run.size());
  EXPECT_EQ(json["regions"][1]["name"], "liquid");
  EXPECT_EQ(json["regions"][1]["wall"], "glass (1500 N/m)");
  EXPECT_EQ(json["ports"], Json::array({"mouth"}));
  EXPECT_EQ(json["transitions"].size(), 2U);
  EXPECT_EQ(json["transitions"][0]["when"][0], "on brim");
  ASSERT_TRUE(testing::waitUntil([&] { return scene->surfacesDone() == 2; }));
  const auto surface = host.get("surface/7/1");
  ASSERT_TRUE(surface);
  EXPECT_EQ(surface->bytes->substr(0, 4), "PSRF");
  for (const char* none :
       {"surface/7/0", "surface/7/2", "surface/6/1", "surface/7/1x", "surface/7/", "surface/",
        "surface/7/-1", "surface/7/99999999999999999999", "cup.yaml", "../cup.yaml"}) {
    EXPECT_FALSE(host.get(none)) << none;
  }
}

TEST_F(ViewedRecord, EveryPageThatLooksSeesThePeakOfTheLastTicks) {
  LiveFeed feed(scene_);
  const auto add = [&](double force) {
    devices::RecordedTick tick;
    tick.tick.result.force = Vec3(force, 0.0, 0.0);
    feed.add(tick, {});
  };
  add(1.0);
  add(7.0);
  add(2.0);
  for (int page = 0; page < 2; ++page) EXPECT_EQ(feed.look(0).strongest, 7.0) << page;
  for (std::size_t i = 0; i < LiveFeed::kLast; ++i) add(3.0);
  EXPECT_EQ(feed.look(0).strongest, 3.0);
}

TEST_F(ViewedRecord, APageTellsTheHandWhereToGoWithinReason) {
  LiveFeed feed(scene_);
  SteeredHand hand(Vec3(0.0));
  PageDesk desk({.feed = &feed, .hand = &hand},
                std::make_shared<const ShownScene>(scene_, loaded_, "", 0));
  const PageHost host = desk.host();
  std::uint64_t seen = 0;
  EXPECT_FALSE(Json::parse(host.snapshot(seen, {})).contains("tick"));
  host.command(R"({"to":[0.01,0.02,-0.03]})");
  Vec3 last(0.0);
  for (int i = 1; i < 5000; ++i) last = hand.at(1e-3 * i);
  EXPECT_NEAR(glm::length(last - Vec3(0.01, 0.02, -0.03)), 0.0, 1e-9);
  host.command(R"({"to":[1e6,0,0]})");
  for (int i = 5000; i < 10000; ++i) last = hand.at(1e-3 * i);
  EXPECT_LT(last.x, 1.0);
}

TEST(View, ABuildWithoutThePageSaysHowToGetIt) {
  const TempFolder folder;
  (void)folder.file("cup.yaml", testing::kContainer);
  const auto result = runPalpate(
      {"view", "cup.yaml", "--no-open", "--seconds", "0.3", "--json", "--record", "felt.npy"},
      folder.path());
  if (pageFiles().empty()) {
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.out.find("view.page"), std::string::npos) << result.out;
    EXPECT_NE(result.out.find("npm"), std::string::npos) << result.out;
    return;
  }
  EXPECT_EQ(result.exit_code, 0) << result.err;
  EXPECT_EQ(result.err.find("http://127.0.0.1:"), 0U) << result.err;
  EXPECT_GT(testing::parseOnly(result)["ticks"], 0);
  const auto replayed = runPalpate({"replay", "felt.npy"}, folder.path());
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
}

TEST(View, UsageErrors) {
  const TempFolder folder;
  (void)folder.file("cup.yaml", testing::kContainer);
  const auto usage = [&](std::vector<std::string> more) {
    more.insert(more.begin(), {"view", "cup.yaml", "--no-open"});
    return runPalpate(more, folder.path()).exit_code;
  };
  EXPECT_EQ(usage({"--replay", "x.npy", "--device", "touch"}), 2);
  EXPECT_EQ(usage({"--replay", "x.npy", "--record", "y.npy"}), 2);
  EXPECT_EQ(usage({"--port", "70000"}), 2);
  EXPECT_EQ(usage({"--device", "nothing"}), 2);
  EXPECT_EQ(runPalpate({"view"}, folder.path()).exit_code, 2);
}

}  // namespace
}  // namespace palpate::tools
