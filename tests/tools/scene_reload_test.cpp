// A scene's file that is edited while a hand touches and pages watch.

#include <gtest/gtest.h>

#include <atomic>
#include <filesystem>
#include <memory>
#include <random>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include "helpers.h"
#include "page_client.h"
#include "palpate/scene/scene_file.h"
#include "support/alloc_guard.h"
#include "support/wait.h"
#include "view/page_desk.h"
#include "view/page_server.h"
#include "view/scene_reloader.h"

namespace palpate::tools {
namespace {

namespace fs = std::filesystem;
using testing::Deadline;
using testing::PageLine;
using testing::PageSocket;
using testing::runPalpate;
using testing::TempFolder;

constexpr double kTick = 1e-3;   // [s]
constexpr double kSlew = 100.0;  // [N/s] as in the scenes below

/// A bowl of glass with syrup in it. Each part that an edit changes has a line of its own.
struct Bowl {
  double radius = 40.0;      // [mm]
  double stiffness = 800.0;  // [N/m]
  std::string name = "liquid";
  bool has_pebble = false;
  bool has_mouth = true;
  int edit = 0;

  [[nodiscard]] std::vector<std::string> lines() const {
    std::vector<std::string> all = {
        "palpate: 1",
        "length: mm",
        "force: {slew: 100 N/s, max: 5 N}",
        "fields:",
        "  bowl: {sphere: {center: [0, 0, 0], radius: " + std::to_string(radius) + "}}",
        "  brim: {half_space: {point: [0, 0, 15], normal: [0, 0, 1]}}",
        "materials:",
        "  glass: {stiffness: " + std::to_string(stiffness) + " N/m}",
        "  syrup: {viscosity: 1 N.s/m}",
        "layers:",
        "  - {name: " + name +
            ", inside: {intersection: [bowl, brim]}, content: syrup, wall: glass}"};
    if (has_pebble) {
      all.emplace_back(
          "  - {name: pebble, inside: {sphere: {center: [0, 0, -20], radius: 5}}, wall: glass}");
    }
    if (has_mouth) {
      all.emplace_back("ports:");
      all.push_back("  - {name: mouth, between: [outside, " + name + "], on: brim}");
    }
    all.push_back("# edit " + std::to_string(edit));
    return all;
  }
  [[nodiscard]] std::vector<std::string> regions() const {
    std::vector<std::string> names = {"outside", name};
    if (has_pebble) names.emplace_back("pebble");
    return names;
  }
};

std::string textOf(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines) text += line + "\n";
  return text;
}

/// A saved text, and what should become of it.
struct Edit {
  std::string text;
  int line = 0;  ///< line of the fault, from 1; 0: any line
  bool is_valid = true;
};

/// An edit of `bowl`. If it is invalid, only its number changes in `bowl`.
Edit randomEdit(std::mt19937_64& random, Bowl& bowl, int number) {
  std::uniform_real_distribution<double> share(0.0, 1.0);
  bowl.edit = number;
  const auto broken = [&](int line, const std::string& text) {
    std::vector<std::string> lines = bowl.lines();
    lines[static_cast<std::size_t>(line - 1)] = text;
    return Edit{textOf(lines), line, false};
  };
  switch (std::uniform_int_distribution<int>(0, 11)(random)) {
    case 0:
      return broken(8, "  glass: {stiffnes: 800 N/m}");
    case 1:
      return broken(9, "  syrup: {viscosity: 1 N}");
    case 2:
      return broken(11, "  - {name: liquid, inside: {intersection: [bowl, brim]}, wall: glas}");
    case 3:
      return broken(11, "  - {name: liquid, inside: {mesh: {file: nobody.stl}}, wall: glass}");
    case 4: {  // not YAML at all
      Edit edit = broken(5, "  bowl: {sphere: {center: [0, 0, 0], radius: 40");
      edit.line = 0;
      return edit;
    }
    case 5:
      return broken(6, "  brim: {half_plane: {point: [0, 0, 15], normal: [0, 0, 1]}}");
    case 6:
      bowl.stiffness = 300.0 + 900.0 * share(random);
      break;
    case 7:
      bowl.radius = 38.0 + 4.0 * share(random);
      break;
    case 8:
      bowl.has_pebble = !bowl.has_pebble;
      break;
    case 9:
      bowl.name = bowl.name == "liquid" ? "water" : "liquid";
      break;
    case 10:
      bowl.has_mouth = !bowl.has_mouth;
      break;
    default:  // a comment
      break;
  }
  return {textOf(bowl.lines())};
}

/// Saves as an editor may: in place, by renaming, in two steps, or after removing the old file.
void save(const TempFolder& folder, const std::string& text, unsigned how) {
  const std::string file = folder.path("bowl.yaml");
  switch (how % 4) {
    case 0:
      (void)folder.file("bowl.yaml", text);
      return;
    case 1:
      fs::rename(folder.file("bowl.yaml~", text), file);
      return;
    case 2:
      (void)folder.file("bowl.yaml", text.substr(0, text.size() / 2));
      (void)folder.file("bowl.yaml", text);
      return;
    default:
      fs::remove(file);
      (void)folder.file("bowl.yaml", text);
  }
}

/// A servo thread that strokes along the glass in simulated time.
class Stroking {
 public:
  Stroking(devices::Session& session, LiveFeed& feed)
      : recorder_(std::vector<devices::RecordSink*>{&feed}),
        thread_([this, &session] { run(session); }) {}
  ~Stroking() { stop(); }
  Stroking(const Stroking&) = delete;
  Stroking& operator=(const Stroking&) = delete;

  void stop() {
    stop_.store(true);
    if (thread_.joinable()) thread_.join();
  }

  // Valid once the thread has stopped.
  double most_step = 0.0;  ///< [N] largest change in a tick, apart from letting go
  double peak = 0.0;       ///< [N]
  bool is_finite = true;
  std::int64_t violations = 0;  ///< allocations, locks and throws of the loop
  std::uint64_t scenes = 0;     ///< number of the last scene

 private:
  void run(devices::Session& session) {
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    devices::DeviceState reading;
    reading.position = Vec3(0.0, 0.0, 0.02);
    Vec3 goal(0.0);
    Vec3 last(0.0);
    const testing::AllocGuard guard;
    while (!stop_.load()) {
      const Vec3 way = goal - reading.position;
      if (glm::length(way) < 1e-4)
        goal = 0.042 * glm::normalize(Vec3(any(random), any(random), -1));
      reading.position += way * std::min(1.0, 2e-4 / std::max(1e-9, glm::length(way)));
      reading.time += kTick;
      const devices::SessionTick tick = session.step(reading, devices::DeviceFrame::kWorld);
      is_finite = is_finite && isFinite(tick.force);
      // The slew limit does not hold back letting go: any share of the last force may remain.
      const double square = glm::dot(last, last);
      const double share =
          square > 0.0 ? std::clamp(glm::dot(tick.force, last) / square, 0.0, 1.0) : 0.0;
      most_step = std::max(most_step, glm::length(tick.force - share * last));
      last = tick.force;
      peak = std::max(peak, glm::length(last));
      scenes = tick.scene;
      recorder_.add(tick, {}, session.renderer().entries());
      std::this_thread::sleep_for(std::chrono::microseconds(50));
    }
    violations = guard.violations();
  }

  std::atomic<bool> stop_{false};
  devices::Recorder recorder_;
  std::thread thread_;
};

/// A session on a scene's file, with a server; the test edits the file.
struct Reloaded {
  explicit Reloaded(const TempFolder& folder, bool is_recorded = false)
      : file(folder.path("bowl.yaml")), watch(file), loaded(file, console) {
    reloader = std::make_unique<SceneReloader>(
        ReloadTargets{&session, &feed, &desk},
        ReloadSettings{.file = file,
                       .renderer = [](const LoadedScene&) { return RendererSettings(); },
                       .is_recorded = is_recorded,
                       .quiet = true,
                       .period = std::chrono::milliseconds(5)},
        watch);
  }

  [[nodiscard]] Json get(const std::string& path) const {
    const auto reply =
        PageSocket(server.port())
            .get("/" + server.token() + "/" + path, "127.0.0.1:" + std::to_string(server.port()));
    return Json::parse(reply.body, nullptr, false);
  }

  std::string file;
  Console console{true};
  SceneWatch watch;
  LoadedScene loaded;
  ScenePtr scene = loaded.compile();
  devices::Session session{scene};
  LiveFeed feed{scene};
  SteeredHand hand{Vec3(0.0)};
  PageDesk desk{{.feed = &feed, .hand = &hand},
                std::make_shared<const ShownScene>(scene, loaded, *watch.first().text, 0)};
  PageServer server{desk.host(), {.rate = 500.0}};
  std::unique_ptr<SceneReloader> reloader;
};

/// Reads messages until `holds(snapshot)`; false if that does not happen in time.
template <typename Holds>
[[nodiscard]] bool hearsUntil(PageLine& line, const Holds& holds) {
  const Deadline deadline;
  while (const auto text = line.hear()) {
    if (holds(Json::parse(*text))) return true;
    if (deadline.hasPassed()) return false;
  }
  return false;
}

std::vector<std::string> regionsOf(const Json& scene) {
  std::vector<std::string> names;
  for (const Json& region : scene["regions"]) names.push_back(region["name"]);
  return names;
}

TEST(SceneReload, FiftyEditsWhileAHandTouchesAndTwoPagesWatch) {
  const TempFolder folder;
  Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  std::vector<std::unique_ptr<PageLine>> pages;
  for (int i = 0; i < 2; ++i) {
    pages.push_back(std::make_unique<PageLine>(view.server.port()));
    ASSERT_TRUE(pages.back()->open(view.server.token()));
  }
  std::mt19937_64 random(23);
  int valid = 0;
  for (int i = 1; i <= 50; ++i) {
    const Edit edit = randomEdit(random, bowl, i);
    save(folder, edit.text, static_cast<unsigned>(random() % 4));
    // Each page learns from a message that something changed, and reads the new text.
    Json text;
    for (const auto& page : pages) {
      std::uint64_t known = 0;
      ASSERT_TRUE(hearsUntil(*page,
                             [&](const Json& snapshot) {
                               if (snapshot["edit"] == known) return false;
                               text = view.get("text.json");
                               known = snapshot["edit"];
                               return text["text"] == edit.text && text["state"] != "compiling";
                             }))
          << i << ": " << edit.text;
    }
    ASSERT_EQ(text["state"], edit.is_valid ? "felt" : "refused") << i << ": " << text;
    if (!edit.is_valid) {
      ASSERT_FALSE(text["problem"].get<std::string>().empty()) << i;
      ASSERT_TRUE(text["line"].is_number()) << i << ": " << text;
      if (edit.line > 0) {
        ASSERT_EQ(text["line"], edit.line) << i << ": " << text;
      }
      continue;
    }
    ++valid;
    for (const auto& page : pages) {
      ASSERT_TRUE(hearsUntil(*page, [&](const Json& snapshot) {
        return snapshot["scene"] == valid && snapshot.contains("tick");
      })) << i;
    }
    ASSERT_EQ(regionsOf(view.get("scene.json")), bowl.regions()) << i;
  }
  // In the end the last valid edit is shown, also to a page that joins now.
  bowl.edit = 51;
  bowl.stiffness = 555.0;
  save(folder, textOf(bowl.lines()), 1);
  PageLine late(view.server.port());
  ASSERT_TRUE(late.open(view.server.token()));
  ASSERT_TRUE(
      hearsUntil(late, [&](const Json& snapshot) { return snapshot["scene"] == valid + 1; }));
  const Json scene = view.get("scene.json");
  EXPECT_EQ(scene["number"], valid + 1);
  EXPECT_EQ(regionsOf(scene), bowl.regions());
  EXPECT_EQ(scene["regions"][1]["wall"], "glass (555 N/m)");
  EXPECT_EQ(view.get("text.json")["text"], textOf(bowl.lines()));
  ASSERT_TRUE(hearsUntil(late, [&](const Json& snapshot) {
    return snapshot["surfaces"] == static_cast<int>(bowl.regions().size());
  }));
  EXPECT_EQ(view.reloader->counts().felt, valid + 1);
  EXPECT_GE(view.reloader->counts().refused, 50 - valid);
  hand.stop();
  EXPECT_GT(valid, 15);
  EXPECT_LT(valid, 40);
  EXPECT_EQ(hand.scenes, static_cast<std::uint64_t>(valid + 1));
  EXPECT_TRUE(hand.is_finite);
  EXPECT_EQ(hand.violations, 0);
  EXPECT_LE(hand.most_step, kSlew * kTick * (1.0 + 1e-9));
  EXPECT_GT(hand.peak, 0.5) << "the hand touched the glass";
}

/// Saves `text`, waits until it was read, and returns what became of it.
Json saved(const Reloaded& view, const TempFolder& folder, const std::string& text) {
  save(folder, text, 1);
  Json now;
  EXPECT_TRUE(testing::waitUntil([&] {
    now = view.get("text.json");
    return now["text"] == text && now["state"] != "compiling";
  }));
  return now;
}

TEST(SceneReload, AnEditThatIsTakenBackIsNotAnEdit) {
  const TempFolder folder;
  const Bowl bowl;
  const std::string text = textOf(bowl.lines());
  save(folder, text, 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  EXPECT_EQ(saved(view, folder, "palpate: 2\n")["state"], "refused");
  const Json back = saved(view, folder, text);
  EXPECT_EQ(back["state"], "felt");
  EXPECT_TRUE(back["problem"].is_null());
  EXPECT_EQ(view.reloader->counts().felt, 0);
  EXPECT_EQ(view.get("scene.json")["number"], 0);
}

TEST(SceneReload, AFileThatIsGoneOrEmptyIsToldAndTheSceneGoesOn) {
  const TempFolder folder;
  const Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  EXPECT_EQ(saved(view, folder, "")["state"], "refused");
  fs::remove(view.file);
  ASSERT_TRUE(testing::waitUntil([&] {
    const Json text = view.get("text.json");
    return text["state"] == "refused" && text["text"] == textOf(bowl.lines());
  }));
  EXPECT_NE(view.get("text.json")["problem"].get<std::string>().find("not there"),
            std::string::npos);
  EXPECT_EQ(view.get("scene.json")["number"], 0);
  save(folder, textOf(bowl.lines()), 1);
  EXPECT_TRUE(testing::waitUntil([&] { return view.get("text.json")["state"] == "felt"; }));
}

TEST(SceneReload, AFaultInAFileThatTheSceneNamesIsToldWithItsName) {
  const TempFolder folder;
  Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  const std::string text =
      textOf(bowl.lines()) + "images:\n  scan: {file: scan.nii}\n";  // a file that is missing
  const Json missing = saved(view, folder, text);
  EXPECT_EQ(missing["state"], "refused");
  EXPECT_NE(missing["problem"].get<std::string>().find("scan.nii"), std::string::npos) << missing;
  // A broken scan appears: the scene is tried again, though its own text is the same.
  const std::uint64_t edit = missing["edit"];
  (void)folder.file("scan.nii", "not a scan");
  ASSERT_TRUE(testing::waitUntil([&] {
    const Json now = view.get("text.json");
    return now["edit"] > edit && now["state"] == "refused";
  }));
}

// The session notices some limits of a renderer only when the scene is offered.
TEST(SceneReload, ASceneThatNoRendererTakesIsRefused) {
  const TempFolder folder;
  Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  const std::string sheet =
      "renderer: paper\nsheets:\n  - {name: skin, on: brim, where: bowl, wall: glass}\n";
  const Json refused = saved(view, folder, textOf(bowl.lines()) + sheet);
  EXPECT_EQ(refused["state"], "refused");
  EXPECT_NE(refused["problem"].get<std::string>().find("paper"), std::string::npos) << refused;
  // The next edit takes the place of the refused one.
  bowl.has_pebble = true;
  EXPECT_EQ(saved(view, folder, textOf(bowl.lines()))["state"], "felt");
  ASSERT_TRUE(testing::waitUntil([&] { return view.get("scene.json")["number"] == 1; }));
  EXPECT_EQ(regionsOf(view.get("scene.json")), bowl.regions());
}

TEST(SceneReload, ASessionThatIsRecordedGoesOnInItsScene) {
  const TempFolder folder;
  Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder, true);
  Stroking hand(view.session, view.feed);
  bowl.stiffness = 400.0;
  EXPECT_EQ(saved(view, folder, textOf(bowl.lines()))["state"], "recorded");
  EXPECT_EQ(view.get("scene.json")["number"], 0);
  EXPECT_EQ(view.reloader->counts().felt, 0);
}

// A page that has not heard of the new scene may still ask for surfaces of the old one.
TEST(SceneReload, SurfacesAreOfTheSceneThatIsAskedFor) {
  const TempFolder folder;
  Bowl bowl;
  save(folder, textOf(bowl.lines()), 0);
  Reloaded view(folder);
  Stroking hand(view.session, view.feed);
  const PageHost host = view.desk.host();
  ASSERT_TRUE(testing::waitUntil([&] { return host.get("surface/0/1").has_value(); }));
  const auto before = host.get("surface/0/1");
  bowl.radius = 20.0;
  EXPECT_EQ(saved(view, folder, textOf(bowl.lines()))["state"], "felt");
  ASSERT_TRUE(testing::waitUntil([&] { return host.get("surface/1/1").has_value(); }));
  EXPECT_NE(*before->bytes, *host.get("surface/1/1")->bytes);
  // The old surfaces are freed in time; an answer that was received stays valid.
  ASSERT_TRUE(testing::waitUntil([&] { return !host.get("surface/0/1"); }));
  EXPECT_EQ(before->bytes->substr(0, 4), "PSRF");
}

TEST(LiveFeed, WhatWasPassedGoesOnByName) {
  const auto scene_of = [](const std::string& ports) {
    return compile(
        parseScene("palpate: 1\nlength: mm\nlayers:\n  - {name: ball, inside: {sphere: "
                   "{center: [0, 0, 0], radius: 40}}}\nports:\n" +
                       ports,
                   "ball.yaml"));
  };
  const std::string in = "  - {name: in, between: [outside, ball], direction: in}\n";
  const std::string out = "  - {name: out, between: [outside, ball], direction: out}\n";
  LiveFeed feed(scene_of(in));
  feed.expect(1, scene_of(out + in));
  feed.expect(2, scene_of(in + out));
  devices::RecordedTick tick;
  const RegionEntry entry{.from = kOutside, .to = 1, .port = 0};
  feed.add(tick, {&entry, 1});
  EXPECT_EQ(feed.look(0).passed, std::vector<int>{1});
  EXPECT_EQ(feed.look(0).entries.size(), 1U);
  tick.tick.scene = 1;
  feed.add(tick, {});
  EXPECT_EQ(feed.look(0).passed, (std::vector<int>{0, 1}));
  EXPECT_TRUE(feed.look(0).entries.empty()) << "their numbers are of the scene before";
  EXPECT_EQ(feed.look(0).scene, 1U);
  tick.tick.scene = 2;
  tick.tick.begins_anew = true;
  feed.add(tick, {});
  EXPECT_EQ(feed.look(0).passed, (std::vector<int>{0, 0}));
  EXPECT_EQ(feed.scene()->ports()[1].name, "out");
}

#ifdef PALPATE_HAS_PAGE  // without a page the command refuses to show anything

TEST(View, ARecordIsFeltAnewThoughItsSceneWasEdited) {
  const TempFolder folder;
  (void)folder.file("cup.yaml", testing::kContainer);
  bool is_edited = false;
  const auto viewed = runPalpate(
      {"view", "cup.yaml", "--no-open", "--seconds", "2", "--record", "felt.npy", "--json"},
      folder.path(), [&](std::string_view err, pid_t) {
        if (is_edited || err.find("http://") == std::string_view::npos) return;
        is_edited = true;
        (void)folder.file("cup.yaml", "palpate: 1\nlength: cm\n");
      });
  ASSERT_EQ(viewed.exit_code, 0) << viewed.err;
  EXPECT_NE(viewed.err.find("is recorded"), std::string::npos) << viewed.err;
  EXPECT_EQ(testing::parseOnly(viewed)["edits"]["felt"], 0);
  const auto replayed = runPalpate({"replay", "felt.npy"}, folder.path());
  EXPECT_EQ(replayed.exit_code, 0) << replayed.out << replayed.err;
  EXPECT_EQ(replayed.err.find("is not what it was"), std::string::npos) << replayed.err;
}

TEST(View, AnEditIsFeltAndCounted) {
  const TempFolder folder;
  const Bowl bowl;
  (void)folder.file("bowl.yaml", textOf(bowl.lines()));
  std::vector<std::string> next = {"palpate: 1\nlength: furlong\n",
                                   textOf(Bowl{.edit = 1}.lines())};
  const auto viewed = runPalpate({"view", "bowl.yaml", "--no-open", "--json"}, folder.path(),
                                 [&](std::string_view err, pid_t process) {
                                   // Makes each edit once the edit before was reported.
                                   if (err.find("is felt") != std::string_view::npos) {
                                     kill(process, SIGTERM);
                                   } else if (err.find("furlong") != std::string_view::npos) {
                                     (void)folder.file("bowl.yaml", next[1]);
                                   } else if (err.find("http://") != std::string_view::npos) {
                                     (void)folder.file("bowl.yaml", next[0]);
                                   }
                                 });
  EXPECT_EQ(viewed.exit_code, 130);
  EXPECT_NE(viewed.err.find("bowl.yaml:2:"), std::string::npos) << viewed.err;
  EXPECT_NE(viewed.err.find("edit 1 of bowl.yaml is felt"), std::string::npos) << viewed.err;
  const std::string told = "the scene goes on as it was";
  EXPECT_EQ(viewed.err.find(told), viewed.err.rfind(told)) << "once: " << viewed.err;
}

#endif

}  // namespace
}  // namespace palpate::tools
