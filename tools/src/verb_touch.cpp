#include <chrono>
#include <cmath>
#include <filesystem>

#include "content_changes.h"
#include "input_kind.h"
#include "loaded_scene.h"
#include "map_coverage.h"
#include "motion.h"
#include "output_files.h"
#include "palpate/devices/servo_loop.h"
#include "palpate/devices/virtual_device.h"
#include "palpate/render/trace.h"
#include "picture/picture.h"
#include "shape_scene.h"
#include "stop_signal.h"
#include "text.h"
#include "touch_plot.h"
#include "touch_summary.h"
#include "verbs.h"
#include "wall_notes.h"

namespace palpate::tools {
namespace {

RendererSettings rendererSettings(const std::string& name) {
  if (name == "paper") return {RendererKind::kPaper};
  if (name == "constraint") return {RendererKind::kConstraint};
  return {};
}

bool givesPaperParameters(const TouchOptions& o) {
  return !o.epsilon.empty() || o.halvings || o.alpha || !o.alpha_form.empty() ||
         !o.interior.empty();
}

PaperParameters paperParameters(const TouchOptions& o, const LengthUnit& unit) {
  PaperParameters paper;
  if (!o.epsilon.empty()) {
    paper.epsilon = parseLength(o.epsilon, unit, "--epsilon");
    if (!(*paper.epsilon > 0.0)) {
      throw Error(ErrorKind::kUsage, {"usage.touch", "--epsilon must be greater than 0"});
    }
  }
  paper.max_halvings = o.halvings;
  paper.alpha = o.alpha;
  if (o.alpha_form == "by_field") paper.alpha_form = AlphaForm::kByMetric;
  if (o.alpha_form == "printed") paper.alpha_form = AlphaForm::kLength;
  if (o.alpha_form == "newton") paper.alpha_form = AlphaForm::kNewton;
  if (o.interior == "together") paper.interior = PaperInterior::kTogether;
  if (o.interior == "wall") paper.interior = PaperInterior::kWall;
  return paper;
}

double positive(double value, const char* what) {
  if (value > 0.0) return value;
  throw Error(ErrorKind::kUsage, {"usage.touch", std::string(what) + " must be greater than 0",
                                  "leave it out for no limit"});
}

ForceLimits forceLimits(const TouchOptions& o) {
  ForceLimits limits;
  if (!o.max_force.empty()) {
    limits.max_force = positive(parseForce(o.max_force, "--max-force"), "--max-force");
  }
  if (!o.slew.empty()) limits.max_growth = positive(parseForceRate(o.slew, "--slew"), "--slew");
  if (!o.ramp.empty()) limits.ramp = positive(parseTime(o.ramp, "--ramp"), "--ramp");
  return limits;
}

Json limitsJson(const ForceLimits& limits) {
  const auto or_null = [](double value, bool given) { return given ? Json(value) : Json(); };
  return {{"max_force_N", or_null(limits.max_force, std::isfinite(limits.max_force))},
          {"slew_N_per_s", or_null(limits.max_growth, std::isfinite(limits.max_growth))},
          {"ramp_s", or_null(limits.ramp, limits.ramp > 0.0)}};
}

std::string limitsText(const ForceLimits& limits) {
  std::string text;
  const auto add = [&](bool given, const std::string& part) {
    if (given) text += (text.empty() ? "" : ", ") + part;
  };
  add(std::isfinite(limits.max_force), "at most " + formatNumber(limits.max_force) + " N");
  add(std::isfinite(limits.max_growth),
      "growing by at most " + formatNumber(limits.max_growth) + " N/s");
  add(limits.ramp > 0.0, "from 0 in " + formatSeconds(limits.ramp));
  return text.empty() ? text : "Force       " + text + "\n";
}

/// Runs the loop over the whole path and keeps every tick.
Trace follow(HapticRenderer& renderer, devices::Path path, const devices::ServoSettings& settings,
             const std::vector<ContentEvent>& changes, devices::ServoReport& report) {
  Trace trace(path.size());
  std::size_t next_change = 0;
  double last_time = path.front().t - 1.0 / settings.rate;
  devices::VirtualDevice device(std::move(path));
  const auto tick = [&](const devices::DeviceState& state) {
    TraceRow row;
    row.t = state.time;
    row.hip = state.position;
    const double dt = state.time - last_time;
    last_time = state.time;
    for (; next_change < changes.size() && changes[next_change].time <= state.time; ++next_change) {
      // Each was tried on the scene before.
      (void)renderer.setContent(changes[next_change].region, changes[next_change].change);
    }
    const auto before = std::chrono::steady_clock::now();
    row.result = renderer.update({state.position, state.velocity, dt});
    const auto after = std::chrono::steady_clock::now();
    row.tick_ns = std::chrono::duration_cast<std::chrono::nanoseconds>(after - before).count();
    trace.add(row, renderer.entries());
    return row.result.force;
  };
  report = devices::runServo(device, tick, settings, stopRequested());
  return trace;
}

void checkExit(devices::ServoExit exit) {
  switch (exit) {
    case devices::ServoExit::kEnd:
      return;
    case devices::ServoExit::kStopped:
      throw Error(ErrorKind::kCancelled, {"cancelled", "stopped at your request"});
    case devices::ServoExit::kTimeout:
      throw Error(ErrorKind::kDevice, {"device.timeout", "the device does not answer any more"});
    case devices::ServoExit::kDisconnected:
      throw Error(ErrorKind::kDevice, {"device.disconnected", "the device was disconnected"});
    case devices::ServoExit::kFault:
      throw Error(ErrorKind::kDevice, {"device.fault", "the device reported a fault"});
  }
}

}  // namespace

namespace {

bool hasMotion(const TouchOptions& o) {
  return !(o.path.empty() && o.press.empty() && o.stroke.empty() && o.tap.empty() &&
           o.insert.empty());
}

/// Presses on a place of the shape's surface that is found from above.
void pressOnSurface(const Scene& scene, TouchOptions& options, Console& console) {
  const SurfacePoint found = findSurfacePoint(scene);
  const auto text = [](const Vec3& v) {
    return formatNumber(v.x, 17) + "," + formatNumber(v.y, 17) + "," + formatNumber(v.z, 17);
  };
  options.press = text(found.place / scene.metresPerUnit());
  if (options.normal.empty()) options.normal = text(found.normal);
  console.note("pressing on its surface at " +
               formatVector(found.place / scene.metresPerUnit(), 6) + " " + scene.lengthUnit() +
               "; --press X,Y,Z presses elsewhere");
}

}  // namespace

Report run(const TouchOptions& asked, const GeneralOptions& general, Console& console) {
  TouchOptions options = asked;
  const bool is_shape = isShape(options.scene);
  const bool finds_place = is_shape && !hasMotion(options);
  std::string scene_text;
  if (is_shape) {
    scene_text = shapeSceneText(options);
  } else {
    refuseShapeOptions(options);
  }
  if (finds_place) options.press = "0,0,0";  // for now: its parameters apply
  checkMotion(options);
  ForceLimits limits = forceLimits(options);
  const std::vector<ContentSetting> content_settings = readSettings(options.set);
  OutputFiles files(general);
  const std::vector<std::string> inputs = {options.scene, options.path};
  if (!options.trace.empty()) {
    files.announce(options.trace, inputs, OutputFiles::Streams::kYes);
  }
  if (!options.image.empty()) {
    if (!hasExtension(options.image, ".png")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the picture " + options.image + " must end in .png"});
    }
    files.announce(options.image, inputs);
  }
  if (!options.plot.empty()) {
    if (!hasExtension(options.plot, ".svg")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the plot " + options.plot + " must end in .svg"});
    }
    files.announce(options.plot, inputs);
  }

  if (!options.write_scene.empty()) {
    if (!hasExtension(options.write_scene, ".yaml")) {
      throw Error(ErrorKind::kUsage,
                  {"usage.touch", "the scene " + options.write_scene + " must end in .yaml"});
    }
    files.announce(options.write_scene, inputs);
    files.write(options.write_scene, scene_text);
  }

  LoadedScene loaded(options.scene, console, 0, scene_text);
  RendererSettings settings = rendererSettings(options.renderer);
  const bool is_paper =
      settings.kind.value_or(loaded.description().renderer) == RendererKind::kPaper;
  if (!is_paper && givesPaperParameters(options)) {
    throw Error(ErrorKind::kUsage,
                {"usage.touch",
                 "--epsilon, --halvings, --alpha, --alpha-form and --interior are parameters of "
                 "the paper's renderer",
                 "add --renderer paper"});
  }
  settings.paper = paperParameters(options, loaded.unit());
  // A picture shows all layers, and so does the paper's table.
  const bool wants_all = is_paper || !options.image.empty();
  const ScenePtr scene = loaded.compile(wants_all ? Purpose::kShow : Purpose::kTouch);
  if (finds_place) pressOnSurface(*scene, options, console);
  devices::Path path = makeMotion(options, loaded.unit());
  limits.period = nominalPeriod(path, options.rate);
  for (const MapGap& gap : mapGaps(loaded.description(), *scene)) {
    console.warn(gapText(gap, scene->lengthUnit(), scene->metresPerUnit()));
  }
  if (!is_paper) {
    for (const WallNote& note : wallNotes(*scene)) {
      if (note.is_warning) console.warn(note.text);
    }
  }
  settings.limits = limits;
  const auto renderer = makeRenderer(scene, settings);
  const std::vector<ContentEvent> changes = contentEvents(content_settings, *scene, path.back().t);

  devices::ServoSettings servo;
  servo.realtime = options.realtime;
  servo.rate = options.rate;
  servo.elevate = options.realtime;
  if (options.realtime) {
    console.note("following the hand's path for " + formatSeconds(path.back().t - path.front().t) +
                 " in real time");
  }
  devices::ServoReport servo_report;
  const Trace trace = follow(*renderer, std::move(path), servo, changes, servo_report);
  checkExit(servo_report.exit);
  const RendererKind kind = settings.kind.value_or(scene->renderer());
  TouchSummary summary = summarize(trace, kind);
  summary.source_work = renderer->sourceWork();

  if (!options.trace.empty()) files.write(options.trace, traceCsv(trace.rows(), *scene));
  if (!options.image.empty()) {
    PictureOptions picture;
    picture.title = std::filesystem::path(options.scene).filename().string();
    picture.track = trackOf(trace.rows());
    picture.image = pictureImage(loaded, "");
    picture.colors = loaded.colors();
    picture.anatomical = !loaded.images().empty();
    (void)drawPicture(*scene, picture, files.temporary(options.image), console);
  }
  if (!options.plot.empty()) {
    const std::string title = std::filesystem::path(options.scene).filename().string();
    files.write(options.plot, forcePlot(trace, *scene, title));
  }
  checkStop();
  files.commit();

  Report report;
  report.json = {{"schema", "palpate.touch/1"},
                 {"scene", options.scene},
                 {"renderer", kind == RendererKind::kPaper ? "paper" : "constraint"}};
  report.json.update(summaryJson(summary, *scene));
  if (options.realtime) {
    report.json["realtime"] = {{"overruns", servo_report.overruns},
                               {"worst_lateness_s", servo_report.worst_lateness},
                               {"elevated", servo_report.elevated}};
  }
  // A hand that presses on a point means to meet something there.
  const bool is_press = !options.press.empty() || !options.tap.empty();
  report.is_yes = !is_press || summary.met_something;
  report.json["met_something"] = summary.met_something;
  report.json["set"] = settingsJson(content_settings);
  report.json["limits"] = limitsJson(limits);
  report.json["grids"] = loaded.gridsJson();
  report.json["trace"] = options.trace.empty() ? Json() : Json(options.trace);
  report.json["image"] = options.image.empty() ? Json() : Json(options.image);
  report.json["written_scene"] = options.write_scene.empty() ? Json() : Json(options.write_scene);
  report.json["plot"] = options.plot.empty() ? Json() : Json(options.plot);

  report.text = summaryText(summary, *scene) + limitsText(limits);
  if (!report.is_yes) {
    report.text = std::string(options.press.empty() ? "The tap" : "The press") +
                  " met nothing: no wall, no port and no content. Is the point on a surface, and "
                  "does --normal point out of it?\n\n" +
                  report.text;
  }
  if (options.realtime) {
    report.text += "Real time   " + std::to_string(servo_report.overruns) +
                   " overruns, worst start " + formatSeconds(servo_report.worst_lateness) +
                   " late" + (servo_report.elevated ? "\n" : ", without real-time priority\n");
  }
  const std::string grids = loaded.gridsText();
  if (!grids.empty()) report.text += "\nGrids\n" + grids;
  std::string written;
  if (!options.trace.empty()) written += "Trace    " + options.trace + "\n";
  if (!options.image.empty()) written += "Picture  " + options.image + "\n";
  if (!options.plot.empty()) written += "Plot     " + options.plot + "\n";
  if (!options.write_scene.empty()) written += "Scene    " + options.write_scene + "\n";
  if (!written.empty()) report.text += "\n" + written;
  return report;
}

}  // namespace palpate::tools
