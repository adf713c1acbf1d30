#include <chrono>
#include <memory>
#include <thread>
#include <utility>

#include "input_kind.h"
#include "loaded_scene.h"
#include "loop_guards.h"
#include "open_device.h"
#include "output_files.h"
#include "palpate/devices/session.h"
#include "palpate/vdb/text.h"
#include "real_device.h"
#include "realtime_report.h"
#include "shape_scene.h"
#include "stop_signal.h"
#include "text.h"
#include "touch_run.h"
#include "touch_settings.h"
#include "verbs.h"
#include "view/browser.h"
#include "view/page_desk.h"
#include "view/page_files.h"
#include "view/scene_reloader.h"
#include "view/scene_watch.h"

namespace palpate::tools {
namespace {

/// The device in the hand that the page moves, unless the user names another.
constexpr const char* kDevice = "touch";

void checkPage() {
  if (!pageFiles().empty()) return;
  throw Error(
      ErrorKind::kOperation,
      {"view.page",
       "this build of palpate has no page: npm, which makes the page, was not found when it "
       "was built",
       "install Node.js 18 or later with npm (Debian: apt-get install npm), and run "
       "tools/run.sh again"});
}

/// Starts the server, and prints its address.
std::unique_ptr<PageServer> serve(PageDesk& desk, const ViewOptions& options, Console& console) {
  auto server = std::make_unique<PageServer>(
      desk.host(),
      PageServerSettings{.port = static_cast<std::uint16_t>(options.port), .files = pageFiles()});
  const std::string url = server->url();
  console.say(url);
  if (!options.no_open && !openBrowser(url)) {
    console.note("no browser was opened; open this address on this machine");
  }
  return server;
}

Json pageJson(const PageServer& server) {
  const PageServerCounts counts = server.counts();
  return {{"url", server.url()},
          {"connections", counts.connections},
          {"refused", counts.refused},
          {"turned_away", counts.turned_away},
          {"bytes_sent", counts.bytes}};
}

std::string pageText(const PageServer& server) {
  const PageServerCounts counts = server.counts();
  return "Page        " + formatCount(counts.connections) + " connections, " +
         formatBytes(counts.bytes) + " sent, " + formatCount(counts.refused) + " refused\n";
}

/// A line about edits of the scene; empty if none was felt.
std::string editsText(const ReloadCounts& edits) {
  if (edits.felt == 0) return {};
  return "Edited " + std::to_string(edits.felt) + " times; all that follows is since the last\n\n";
}

/// Waits until the user asks to stop, or until `seconds` are over.
void waitFor(const std::optional<double>& seconds) {
  using Clock = std::chrono::steady_clock;
  constexpr auto kLook = std::chrono::milliseconds(20);
  const auto begin = Clock::now();
  while (!seconds || std::chrono::duration<double>(Clock::now() - begin).count() < *seconds) {
    checkStop();
    std::this_thread::sleep_for(kLook);
  }
}

Report viewRecorded(const ViewOptions& options, Console& console) {
  const std::string text = SceneWatch(options.touch.scene).first().text.value_or("");
  LoadedScene loaded(options.touch.scene, console, 0, text);
  const ScenePtr scene = loaded.compile(Purpose::kShow);
  const RecordedRun run(options.replay, *scene);
  PageDesk desk(
      {.run = &run, .about = Json::object({{"device", "as in " + vdb::fileName(options.replay)}})},
      std::make_shared<const ShownScene>(scene, loaded, text, 0));
  const auto server = serve(desk, options, console);
  waitFor(options.touch.seconds);
  Report report;
  report.json = {{"schema", "palpate.view/1"},
                 {"scene", options.touch.scene},
                 {"replay", options.replay},
                 {"rows", run.size()},
                 {"page", pageJson(*server)}};
  report.text = "Ticks       " + formatCount(run.size()) + "\n" + pageText(*server);
  return report;
}

/// A hand that the page moves, and the device that it holds.
struct PageHand {
  explicit PageHand(const Vec3& start) : hand(start) {}

  SteeredHand hand;
  std::unique_ptr<devices::Device> device;
};
std::unique_ptr<PageHand> makePageHand(const TouchOptions& options, const Scene& scene) {
  auto made = std::make_unique<PageHand>(toDevice(scene.device(), handStart(scene)));
  devices::SimulationSettings settings = *simulationOf(options.device, options.rate);
  settings.realtime = true;
  devices::LiveHand live{.position = [hand = &made->hand](double t) { return hand->at(t); }};
  if (options.seconds) live.end = *options.seconds;
  made->device = std::make_unique<devices::SimulatedDevice>(settings, std::move(live));
  return made;
}

Report viewSession(const ViewOptions& asked, const GeneralOptions& general, Console& console) {
  TouchOptions options = asked.touch;
  options.realtime = true;
  const bool is_real = isRealDevice(options.device.name);
  std::unique_ptr<devices::Device> real;
  if (is_real) real = makeRealDevice(options.device.name, options.real, options.seconds);
  OutputFiles files(general);
  announceRecords(files, options, {options.scene});

  SceneWatch watch(options.scene);
  const std::string text = watch.first().text.value_or("");
  LoadedScene loaded(options.scene, console, 0, text);
  const auto renderer_of = [&options](const LoadedScene& of) {
    RendererSettings renderer = rendererSettings(options, of.unit());
    renderer.kind = renderer.kind.value_or(of.description().renderer);
    renderer.limits.period = 1.0 / options.rate;
    return renderer;
  };
  const RendererSettings renderer = renderer_of(loaded);
  const ScenePtr scene = loaded.compile(Purpose::kShow);
  devices::SessionSettings how{.renderer = renderer};
  how.servo.realtime = true;
  how.servo.rate = options.rate;
  how.servo.elevate = devices::Elevate::kPrefer;
  if (!options.record.empty()) how.checkpoint_every = static_cast<std::uint64_t>(options.states);
  how.loop = touchLoop(options);
  const devices::HandGuards guards = guardsOf(options, scene->device(), how.loop);
  how.passivity = guards.passivity;
  how.coupling = guards.coupling;
  devices::Session session(scene, std::move(how));

  std::unique_ptr<PageHand> page_hand;
  if (!is_real) page_hand = makePageHand(options, *scene);
  devices::Device& device = is_real ? *real : *page_hand->device;
  RecordAbout about;
  about.shows_all = true;
  about.renderer = rendererName(*renderer.kind);
  if (!options.record.empty()) {
    // Records the scene's text, because the file may be edited during the session.
    describe(about, options, device.info(), *scene, text);
    about.period = renderer.limits.period;
  }

  LiveFeed feed(scene);
  PageDesk desk({.feed = &feed,
                 .hand = page_hand ? &page_hand->hand : nullptr,
                 .about = Json::object({{"device", device.info().name},
                                        {"max_force", device.info().max_force},
                                        {"rate", options.rate}})},
                std::make_shared<const ShownScene>(scene, loaded, text, 0));
  const auto server = serve(desk, asked, console);
  const SceneReloader reloader({&session, &feed, &desk},
                               {.file = options.scene,
                                .renderer = renderer_of,
                                .is_recorded = !options.record.empty(),
                                .quiet = general.quiet},
                               std::move(watch));
  const TouchRun run = runTouch(session, device, options, about, files, console, false, {&feed});
  checkStop();
  files.commit();

  const bool is_paced_by_device = device.info().is_clock;
  const ReloadCounts edits = reloader.counts();
  // The summary is of the scene that was felt last; the feed knows which one that is.
  const ScenePtr last = feed.scene();
  Report report;
  report.json = {{"schema", "palpate.view/1"},
                 {"scene", options.scene},
                 {"renderer", about.renderer},
                 {"edits", {{"felt", edits.felt}, {"refused", edits.refused}}},
                 {"page", pageJson(*server)}};
  report.json.update(summaryJson(run.summary, *last));
  report.json["realtime"] = realtimeJson(run.servo, is_paced_by_device);
  report.json["device"] = deviceJson(options.device, options.rate);
  report.json["record"] = options.record.empty() ? Json() : Json(options.record);
  report.text = editsText(edits) + summaryText(run.summary, *last) + deviceText(options.device) +
                guardsText(guards, session) + realtimeText(run.servo, is_paced_by_device) +
                pageText(*server);
  if (!options.record.empty()) report.text += "\nRecord   " + options.record + "\n";
  return report;
}

}  // namespace

Report run(const ViewOptions& asked, const GeneralOptions& general, Console& console) {
  if (isShape(asked.touch.scene)) {
    throw Error(ErrorKind::kUsage,
                {"usage.view", "view takes a scene, not a mesh, an image or a grid",
                 "write one with palpate touch ... --write-scene FILE.yaml", asked.touch.scene});
  }
  ViewOptions options = asked;
  if (options.touch.device.name.empty()) options.touch.device.name = kDevice;
  TouchOptions timeless = options.touch;
  timeless.seconds.reset();  // with `view` this option applies to every kind of hand
  checkDevice(timeless);
  checkPage();
  return options.replay.empty() ? viewSession(options, general, console)
                                : viewRecorded(options, console);
}

}  // namespace palpate::tools
