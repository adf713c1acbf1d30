#include <filesystem>

#include "content_changes.h"
#include "input_kind.h"
#include "loaded_scene.h"
#include "loop_guards.h"
#include "open_device.h"
#include "palpate/devices/record.h"
#include "record_about.h"
#include "scene_hash.h"
#include "shape_scene.h"
#include "stop_signal.h"
#include "text.h"
#include "touch_settings.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

/// The scene of the record, or another one if the user named it.
struct ReplayScene {
  std::string file;
  std::string text;         ///< for a mesh, image or grid
  bool is_as_felt = false;  ///< the scene and the files that it names have not changed
};

ReplayScene sceneOf(const ReplayOptions& options, const RecordAbout& about, Console& console) {
  if (!options.scene.empty()) {
    if (isShape(options.scene)) {
      throw Error(ErrorKind::kUsage,
                  {"usage.replay", "--scene takes a scene, not a mesh, an image or a grid",
                   "write one with palpate touch ... --write-scene FILE.yaml", options.scene});
    }
    return {options.scene, {}, sceneHash(options.scene, {}) == about.scene_hash};
  }
  std::error_code failed;
  if (!std::filesystem::exists(about.scene, failed)) {
    throw inputError("record.scene", "the scene that was felt is not there: " + about.scene,
                     "say where it is now: --scene SCENE", aboutFile(options.record));
  }
  const bool is_as_felt = sceneHash(about.scene, about.scene_text) == about.scene_hash;
  if (!is_as_felt) {
    console.warn("the scene " + about.scene + " has changed since it was felt");
  }
  return {about.scene, about.scene_text, is_as_felt};
}

/// Runs `read` on the options in FILE.npy.json, and reports faults as those of that file, not of a
/// command line.
template <typename Read>
auto fromOptions(const std::string& record, const Read& read) {
  try {
    return read();
  } catch (const Error& error) {
    throw inputError("record.about", "its options: " + error.problem().message,
                     error.problem().hint, aboutFile(record));
  }
}

/// The state at which the session begins, if there is a suitable one.
std::optional<devices::SessionState> stateFor(const ReplayOptions& options, const ReadAbout& read,
                                              const ReplayScene& scene, Console& console) {
  const std::uint64_t every = read.about.states_every;
  if (options.from == 0 || every == 0 || options.from < every) return std::nullopt;
  const bool is_other_renderer =
      !options.renderer.empty() && options.renderer != read.about.renderer;
  if (!scene.is_as_felt || is_other_renderer) {
    console.note(
        "with another scene or renderer the replay begins at the first tick: a state fits "
        "only the scene and renderer that saved it");
    return std::nullopt;
  }
  devices::StateReader states(statesFile(options.record), read.text);
  std::optional<devices::SessionState> state = states.before(options.from);
  if (!state)
    console.warn("no complete state lies before that tick, so the replay began at the first");
  return state;
}

Json reportJson(const ReplayOptions& options, const devices::ReplayReport& report,
                std::uint64_t begun_at, const devices::RecordReader& record) {
  Json json = {{"schema", "palpate.replay/1"},    {"record", options.record},
               {"rows", record.size()},           {"rows_promised", record.promised()},
               {"begun_at_tick", begun_at},       {"ticks", report.ticks},
               {"compared", report.compared},     {"different", report.different},
               {"is_same", report.different == 0}};
  json["first"] = Json();
  if (report.first) {
    json["first"] = {
        {"tick", report.first->tick}, {"t", report.first->t}, {"what", report.first->what}};
  }
  json["largest_force_N"] = report.most_force;
  json["largest_force_tick"] = report.most_force > 0.0 ? Json(report.most_force_tick) : Json();
  json["largest_proxy_m"] = report.most_proxy;
  json["largest_proxy_tick"] = report.most_proxy > 0.0 ? Json(report.most_proxy_tick) : Json();
  json["other_regions"] = report.regions;
  json["other_contacts"] = report.contacts;
  json["gap_at_tick"] = report.gap ? Json(*report.gap) : Json();
  return json;
}

std::string reportText(const devices::ReplayReport& report, std::uint64_t begun_at,
                       const Scene& scene) {
  std::string text = "Compared    " + formatCount(report.compared) + " ticks";
  if (begun_at > 0) text += ", begun at the state before tick " + std::to_string(begun_at);
  text += "\n";
  if (report.gap) {
    text += "Gap         the record has no tick " + std::to_string(*report.gap) +
            "; nothing after it was compared\n";
  }
  if (!report.first) return text + "Different   none: the same bit for bit\n";
  const auto at = [](std::uint64_t tick, double most) {
    return most > 0.0 ? " at tick " + std::to_string(tick) + "\n" : std::string("\n");
  };
  text += "Different   " + formatCount(report.different) + " ticks\n";
  text += "First       tick " + std::to_string(report.first->tick) + ", " +
          formatNumber(report.first->t, 6) + " s: " + report.first->what + "\n";
  text += "Force       differs by up to " + formatNumber(report.most_force, 4) + " N" +
          at(report.most_force_tick, report.most_force);
  text += "Proxy       differs by up to " +
          formatNumber(report.most_proxy / scene.metersPerUnit(), 4) + " " + scene.lengthUnit() +
          at(report.most_proxy_tick, report.most_proxy);
  return text + "Regions     differ in " + formatCount(report.regions) + " ticks, contact in " +
         formatCount(report.contacts) + "\n";
}

}  // namespace

Report run(const ReplayOptions& options, const GeneralOptions&, Console& console) {
  devices::RecordReader record(options.record);
  const ReadAbout read = readAbout(options.record);
  const RecordAbout& about = read.about;
  if (record.size() < record.promised()) {
    console.warn("the record was cut: " + std::to_string(record.size()) + " of " +
                 std::to_string(record.promised()) + " ticks are there");
  }
  if (record.size() == 0) {
    throw inputError("record.empty", "there is no tick in the record", {}, options.record);
  }
  record.seek(options.from);
  devices::TickRecord row;
  if (!record.next(row)) {
    throw inputError(
        "record.from", "the record has no tick " + std::to_string(options.from) + " or later",
        "it has " + std::to_string(record.size()) + " ticks; the first is 0", options.record);
  }

  const ReplayScene chosen = sceneOf(options, about, console);
  LoadedScene loaded(chosen.file, console, 0, chosen.text);
  TouchOptions asked = about.options;
  if (!options.renderer.empty()) asked.renderer = options.renderer;
  const bool shows_all = about.shows_all || asked.renderer == "paper";
  const ScenePtr scene = loaded.compile(shows_all ? Purpose::kShow : Purpose::kTouch);
  devices::SessionSettings how;
  how.renderer =
      fromOptions(options.record, [&] { return rendererSettings(asked, loaded.unit()); });
  how.renderer.limits.period = about.period;
  how.changes = fromOptions(
      options.record, [&] { return contentEvents(readSettings(asked.set), *scene, kInfinity); });
  how.servo.rate = about.rate;
  how.checkpoint_every = about.states_every;
  asked.rate = about.rate;
  const devices::HandGuards guards = fromOptions(
      options.record, [&] { return guardsOf(asked, scene->device(), touchLoop(asked)); });
  how.passivity = guards.passivity;
  how.coupling = guards.coupling;
  devices::Session session(scene, std::move(how));

  const std::optional<devices::SessionState> state = stateFor(options, read, chosen, console);
  if (state && !session.resume(*state)) {
    throw inputError(
        "record.states",
        "the state before tick " + std::to_string(state->ticks) + " cannot be one of this scene",
        "replay from the first tick", statesFile(options.record));
  }
  const std::uint64_t begun_at = session.ticks();
  record.seek(begun_at);
  const devices::ReplayReport done = devices::replay(
      record, session, about.frame, options.from,
      [] { return stopRequested().load(std::memory_order_relaxed); },
      devices::RecordNames{about.regions, about.ports});
  checkStop();
  if (done.compared == 0) {
    throw inputError("record.gap",
                     "the record has no tick " + std::to_string(done.gap.value_or(begun_at)) +
                         ", so nothing after it can be felt anew",
                     "begin after it: --from TICK, at a tick after a state that was saved later",
                     options.record);
  }

  Report report;
  report.json = reportJson(options, done, begun_at, record);
  report.json["scene"] = chosen.file;
  report.json["renderer"] = asked.renderer;
  report.text = reportText(done, begun_at, *scene);
  report.is_yes = done.different == 0;
  return report;
}

}  // namespace palpate::tools
