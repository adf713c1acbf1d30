#include <memory>
#include <utility>

#include "budget_report.h"
#include "content_changes.h"
#include "input_kind.h"
#include "loaded_scene.h"
#include "loop_guards.h"
#include "map_coverage.h"
#include "motion.h"
#include "open_device.h"
#include "output_files.h"
#include "palpate/devices/record.h"
#include "palpate/devices/session.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
#include "real_device.h"
#include "realtime_report.h"
#include "safety_report.h"
#include "shape_scene.h"
#include "text.h"
#include "touch_plot.h"
#include "touch_run.h"
#include "touch_settings.h"
#include "verbs.h"
#include "wall_notes.h"

namespace palpate::tools {
namespace {

bool hasMotion(const TouchOptions& o) {
  return !(o.path.empty() && o.press.empty() && o.stroke.empty() && o.tap.empty() &&
           o.insert.empty());
}

/// Sets the options to press on the highest place of the shape's surface.
void pressOnSurface(const Scene& scene, TouchOptions& options, Console& console) {
  const SurfacePoint found = findSurfacePoint(scene);
  const auto text = [](const Vec3& v) {
    return formatNumber(v.x, 17) + "," + formatNumber(v.y, 17) + "," + formatNumber(v.z, 17);
  };
  options.press = text(found.place / scene.metersPerUnit());
  if (options.normal.empty()) options.normal = text(found.normal);
  console.note("pressing on its surface at " +
               formatVector(found.place / scene.metersPerUnit(), 6) + " " + scene.lengthUnit() +
               "; --press X,Y,Z presses elsewhere");
}

}  // namespace

Report run(const TouchOptions& asked, const GeneralOptions& general, Console& console) {
  TouchOptions options = asked;
  const bool is_real = isRealDevice(options.device.name);
  if (is_real) options.realtime = true;
  const bool is_shape = isShape(options.scene);
  const bool finds_place = is_shape && !is_real && !hasMotion(options);
  std::string scene_text;
  if (is_shape) {
    scene_text = shapeSceneText(options);
  } else {
    refuseShapeOptions(options);
  }
  // Any place will do until the shape is known: the options of a press need one.
  if (finds_place) options.press = "0,0,0";
  checkMotion(options);
  checkDevice(options);
  (void)forceLimits(options);  // reports errors in them before any work
  std::unique_ptr<devices::Device> device;
  if (is_real) device = makeRealDevice(options.device.name, options.real, options.seconds);
  const std::vector<ContentSetting> content_settings = readSettings(options.set);
  OutputFiles files(general);
  const std::vector<std::string> inputs = {options.scene, options.path};
  announceRecords(files, options, inputs);
  if (!options.image.empty()) {
    if (!vdb::hasExtension(options.image, ".png")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the picture " + options.image + " must end in .png"});
    }
    files.announce(options.image, inputs);
  }
  if (!options.plot.empty()) {
    if (!vdb::hasExtension(options.plot, ".svg")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the plot " + options.plot + " must end in .svg"});
    }
    files.announce(options.plot, inputs);
  }

  if (!options.write_scene.empty()) {
    if (!vdb::hasExtension(options.write_scene, ".yaml")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the scene " + options.write_scene + " must end in .yaml"});
    }
    files.announce(options.write_scene, inputs);
    files.write(options.write_scene, scene_text);
  }

  LoadedScene loaded(options.scene, console, 0, scene_text);
  RendererSettings settings = rendererSettings(options, loaded.unit());
  settings.kind = settings.kind.value_or(loaded.description().renderer);
  const bool is_paper = settings.kind == RendererKind::kPaper;
  if (!is_paper && givesPaperParameters(options)) {
    throw Error(ErrorKind::kUsage,
                {"usage.touch",
                 "--epsilon, --halvings, --alpha, --alpha-form and --interior are parameters of "
                 "the paper's renderer",
                 "add --renderer paper"});
  }
  // A picture shows all layers, and the paper's table needs them all.
  const bool wants_all = is_paper || !options.image.empty();
  const ScenePtr scene = loaded.compile(wants_all ? Purpose::kShow : Purpose::kTouch);
  if (finds_place) pressOnSurface(*scene, options, console);
  Motion motion;
  motion.end = options.seconds.value_or(kInfinity);
  if (!is_real) motion = makeMotion(options, loaded.unit());
  ForceLimits& limits = settings.limits;
  limits = limits.over(scene->forceLimits());
  limits.period = options.device.name.empty() ? motion.period : 1.0 / options.rate;
  for (const MapGap& gap : mapGaps(loaded.description(), *scene)) {
    console.warn(gapText(gap, scene->lengthUnit(), scene->metersPerUnit()));
  }
  if (!is_paper) {
    for (const WallNote& note : wallNotes(*scene)) {
      if (note.is_warning) console.warn(note.text);
    }
  }
  devices::SessionSettings how{.renderer = settings};
  how.changes = contentEvents(content_settings, *scene, motion.end);
  how.servo.realtime = options.realtime;
  how.servo.rate = options.rate;
  if (options.realtime) how.servo.elevate = devices::Elevate::kPrefer;
  if (!options.record.empty()) how.checkpoint_every = static_cast<std::uint64_t>(options.states);
  how.loop = touchLoop(options);
  const devices::HandGuards guards = guardsOf(options, scene->device(), how.loop);
  how.passivity = guards.passivity;
  how.coupling = guards.coupling;
  devices::Session session(scene, std::move(how));
  warnOfBudget(session.overBudget(), options.device, is_shape ? "" : options.scene, options.rate,
               console);
  if (is_real) {
    console.note(options.device.name + ": " + noticeOf(options.device.name) + "; touching " +
                 (options.seconds ? "for " + formatSeconds(*options.seconds) : "until Ctrl-C"));
  } else if (options.realtime) {
    console.note("following the hand's path for " + formatSeconds(motion.end - motion.begin) +
                 " in real time");
  }
  if (!device) device = makeDevice(options, std::move(motion), scene->device(), console);
  RecordAbout about;
  about.shows_all = wants_all;
  about.renderer = rendererName(*settings.kind);
  if (!options.record.empty()) {
    describe(about, options, device->info(), *scene, scene_text);
    about.period = limits.period;
  }
  const TouchRun run = runTouch(session, *device, options, about, files, console,
                                !options.image.empty() || !options.plot.empty());
  const TouchSummary& summary = run.summary;
  const devices::ServoReport& servo_report = run.servo;
  const bool is_paced_by_device = device->info().is_clock;

  if (!options.image.empty()) {
    PictureOptions picture;
    picture.title = vdb::fileName(options.scene);
    picture.track = trackOf(run.thin->rows());
    picture.image = pictureImage(loaded.images(), "");
    picture.colors = loaded.colors();
    picture.anatomical = !loaded.images().empty();
    files.write(options.image, drawPicture(*scene, picture, console).png);
  }
  if (!options.plot.empty()) {
    const std::string title = vdb::fileName(options.scene);
    files.write(options.plot, forcePlot(*run.thin, *scene, title));
  }
  checkStop();
  files.commit();

  Report report;
  report.json = {
      {"schema", "palpate.touch/1"}, {"scene", options.scene}, {"renderer", about.renderer}};
  report.json.update(summaryJson(summary, *scene));
  if (options.realtime) {
    report.json["realtime"] = realtimeJson(servo_report, is_paced_by_device);
  }
  if (is_real) report.json["safety"] = safetyJson(servo_report);
  // A hand that presses on a point should meet something there; if not, the answer is negative.
  const bool is_press = !options.press.empty() || !options.tap.empty();
  report.is_yes = !is_press || summary.met_something;
  report.json["met_something"] = summary.met_something;
  report.json["set"] = settingsJson(content_settings);
  report.json["limits"] = limitsJson(limits);
  report.json["device"] = deviceJson(options.device, options.rate);
  report.json.update(guardsJson(guards, session));
  report.json["over_budget"] = budgetJson(session.overBudget());
  report.json["grids"] = loaded.gridsJson();
  report.json["trace"] = options.trace.empty() ? Json() : Json(options.trace);
  report.json["record"] = options.record.empty() ? Json() : Json(options.record);
  report.json["image"] = options.image.empty() ? Json() : Json(options.image);
  report.json["written_scene"] = options.write_scene.empty() ? Json() : Json(options.write_scene);
  report.json["plot"] = options.plot.empty() ? Json() : Json(options.plot);

  report.text = summaryText(summary, *scene) + limitsText(limits) + deviceText(options.device) +
                guardsText(guards, session);
  if (!report.is_yes) {
    report.text = std::string(options.press.empty() ? "The tap" : "The press") +
                  " met nothing: no wall, no port and no content. Is the point on a surface, and "
                  "does --normal point out of it?\n\n" +
                  report.text;
  }
  if (options.realtime) {
    report.text += realtimeText(servo_report, is_paced_by_device);
  }
  if (is_real && !isInputDevice(options.device.name)) report.text += safetyText(servo_report);
  const std::string grids = loaded.gridsText();
  if (!grids.empty()) report.text += "\nGrids\n" + grids;
  std::string written;
  if (!options.trace.empty()) written += "Trace    " + options.trace + "\n";
  if (!options.record.empty()) written += "Record   " + options.record + "\n";
  if (!options.image.empty()) written += "Picture  " + options.image + "\n";
  if (!options.plot.empty()) written += "Plot     " + options.plot + "\n";
  if (!options.write_scene.empty()) written += "Scene    " + options.write_scene + "\n";
  if (!written.empty()) report.text += "\n" + written;
  return report;
}

}  // namespace palpate::tools
