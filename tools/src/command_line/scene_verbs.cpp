// The verbs that show a scene or let it be felt.

#include "command_line/verb.h"
#include "palpate/core/text.h"
#include "palpate/devices/device_presets.h"
#include "palpate/devices/simulated_device.h"

namespace palpate::tools {

std::string deviceModels() {
  return joined(devices::devicePresets(), ", ", &devices::DevicePreset::name);
}

void addDevice(CLI::App& app, const char* group, DeviceOptions& o, const std::string& what) {
  add(app, group, "--device", "NAME", o.name, what.c_str());
  add(app, group, "--hand", "HAND", o.hand,
      "device: how it is held: none, relaxed (default) or firm");
  add(app, group, "--delay", "N", o.delay,
      "device: samples from a force to when the motors give it (default 0)")
      ->check(CLI::Range(0, devices::SimulatedDevice::kMostDelay));
}

std::string named(const std::string& text) { return text.empty() ? "a name is missing" : ""; }

namespace {

/// Checks the number of a tick: returns "" if it is valid, else an error.
std::string tickNumber(const std::string& text) {
  constexpr std::size_t kMostDigits = 15;
  const bool is_number = !text.empty() && text.size() <= kMostDigits &&
                         text.find_first_not_of("0123456789") == std::string::npos;
  return is_number ? "" : "'" + text + "' is not the number of a tick, which is 0 or more";
}

void defineTouch(CLI::App& app, Invocation& invocation) {
  auto& o = choose<TouchOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "The hand's motion, exactly one of";
  add(app, g, "--path", "FILE.csv", o.path,
      "follow a recorded hand: header t,x,y,z in s and m, one row a tick; "
      "t,device_x,device_y,device_z: through the scene's device");
  addFlag(app, g, "--as-recorded", o.as_recorded,
          "path: also rows that are not numbers (nan, inf), and times that do not rise, as a fault "
          "left them");
  add(app, g, "--press", "X,Y,Z", o.press, "press on this point of a surface, hold, and let go");
  addList(app, g, "--stroke", "A B", o.stroke, "stroke in a straight line from A to B and back");
  add(app, g, "--tap", "X,Y,Z", o.tap, "tap on this point of a surface");
  addList(app, g, "--insert", "A B ...", o.insert, "go straight from point to point");
  g = "Its parameters (lengths in the scene's unit, or with a unit: 3mm)";
  add(app, g, "--normal", "X,Y,Z", o.normal,
      "press, tap: outward direction of the surface (default 0,0,1)");
  add(app, g, "--depth", "LENGTH", o.depth, "press, tap: how far below the point (default 2 mm)");
  add(app, g, "--clearance", "LENGTH", o.clearance,
      "press, tap: how far above it the hand starts (default 5 mm)");
  add(app, g, "--speed", "SPEED", o.speed,
      "press, stroke, insert: per second (default 50 mm/s; stroke 100 mm/s)");
  add(app, g, "--hold", "SECONDS", o.hold,
      "press, insert: rest at the far end (default 0.2; insert 0.1)");
  add(app, g, "--repeats", "N", o.repeats, "stroke: there and back N times (default 1)");
  add(app, g, "--frequency", "HZ", o.frequency, "tap: taps a second (default 4)");
  add(app, g, "--taps", "N", o.taps, "tap: how many (default 4)");
  addFlag(app, g, "--back", o.back, "insert: come back the same way");
  g = "The loop";
  addChoice(app, g, "--renderer", {"constraint", "paper"}, o.renderer,
            "constraint or paper (default: as the scene says)", "NAME");
  add(app, g, "--rate", "HZ", o.rate, "ticks a second (default 1000)")
      ->check(CLI::Range(1.0, 100000.0));
  addDevice(
      app, g, o.device,
      std::string("follow the motion with a simulated device, in a hand that feels the force: "
                  "virtual:NAME, NAME one of ") +
          deviceModels() +
          "; virtual: may be left out unless NAME is falcon or inverse3. Or let a hand move "
          "a device: falcon, inverse3, hd (OpenHaptics), dhd (Force Dimension), evdev (SpaceMouse, "
          "gamepad or mouse, whose force is shown, not felt; evdev:/dev/input/eventN: that one). "
          "Default: a hand that follows the motion whatever it feels");
  add(app, g, "--seconds", "S", o.seconds,
      "a device that a hand holds: for how long (default: until Ctrl-C)")
      ->check(CLI::Range(0.1, 86400.0));
  addFlag(app, g, "--realtime", o.realtime,
          "keep to the clock (default: as fast as the machine goes)");
  addList(
      app, g, "--set", "MATERIAL.KEY=VALUE@TIME", o.set,
      "change a content while the hand moves, may be repeated: syrup.viscosity=9@0.5 (N.s/m, s); "
      "also flow, lattice.force, cutting");
  addRealDevice(app, o.real);
  g = "The paper's renderer (default: as the scene's `paper` says)";
  add(app, g, "--epsilon", "LENGTH", o.epsilon,
      "so near to the surface a contact point is on it (default 1 um)");
  add(app, g, "--halvings", "N", o.halvings,
      "of the way in which the surface is searched, at most (default 48)")
      ->check(CLI::Range(1, 1000));
  add(app, g, "--alpha", "SHARE", o.alpha, "of the step back onto the surface (default 1)")
      ->check(CLI::Range(0.0, 1e6));
  addChoice(app, g, "--alpha-form", {"by_field", "printed", "newton"}, o.alpha_form,
            "printed, newton, or by_field: newton where the field is not a distance (default)",
            "FORM");
  addChoice(app, g, "--interior", {"together", "wall"}, o.interior,
            "at a wall from within: wall and content together (default), or the wall alone", "HOW");
  g = "What keeps a device stable (default: as the scene's `device` says, or nothing)";
  addChoice(app, g, "--passivity", {"observe", "control"}, o.passivity,
            "observe the energy that the loop gives to the hand, or control it by damping", "WHAT");
  add(app, g, "--hand-force", "FORCE", o.hand_force,
      "passivity: the hand's largest force; no tick then gives more than there is: 5 (N)");
  add(app, g, "--coupling", "WHAT", o.coupling,
      "a spring and a damper between hand and tool: springs or any_scene (designed for --device), "
      "or STIFFNESS,DAMPING: 800 N/m,4 N.s/m");
  g = "Limits of the force, in this order (default: as the scene's `force` says, or none)";
  add(app, g, "--max-force", "FORCE", o.max_force,
      "shorten longer forces to this, direction kept: 3 (N), 500mN");
  add(app, g, "--slew", "FORCE/s", o.slew,
      "let the force grow, in any direction, by no more than this a second: 100 (N/s); it may drop "
      "at once");
  add(app, g, "--ramp", "TIME", o.ramp,
      "start without force, and reach all of it after this: "
      "0.2 (s), 200ms");
  g = "Output files";
  add(app, g, "--trace", "FILE.csv", o.trace, "write one row a tick (SI units)")->check(named);
  auto* record = add(app, g, "--record", "FILE.npy", o.record,
                     "write all that goes into each tick and comes out, for replay and NumPy; "
                     "beside it FILE.npy.json and FILE.npy.states")
                     ->check(named);
  add(app, g, "--states", "N", o.states,
      "record: keep a state every N ticks, from which a replay can begin; 0: none (default 10000)")
      ->check(CLI::Range(0, 1000000000))
      ->needs(record);
  add(app, g, "--image", "FILE.png", o.image,
      "draw the scene cut open, with the path and the forces")
      ->check(named);
  add(app, g, "--plot", "FILE.svg", o.plot, "draw the force over the depth of the hand")
      ->check(named);
  add(app, g, "--write-scene", "FILE.yaml", o.write_scene,
      "a mesh, image or grid: the scene that it is touched as")
      ->check(named);
  g = "A mesh, an image or a grid instead of a scene (without a motion: pressed on from above)";
  add(app, g, "--above", "VALUE", o.above,
      "image, grid of densities: the surface around what is greater");
  addFlag(app, g, "--distances", o.distances,
          "image of signed distances, negative inside: the surface where they are 0");
  addList(app, g, "--labels", "NAME,...", o.labels,
          "image: a layer for each of these labels, values or names")
      ->delimiter(',');
  add(app, g, "--names", "FILE", o.names, "image: table of names of its labels");
  add(app, g, "--layer", "NAME", o.layer, "grid: this one of a file (default: every level set)");
  add(app, g, "--voxel", "LENGTH", o.voxel,
      "mesh, image: of the grid that is made, in mm or with a unit (default: as in a scene)");
  add(app, g, "--units", "UNIT", o.units,
      "mesh, or grid that does not say: what one unit is (default: mm; glTF and GLB are meters)");
  addScan(app, "What an image or a mesh leaves open", o.scan, true);
}

void defineReplay(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ReplayOptions>(invocation);
  app.add_option("record", o.record);
  const char* g = "Options";
  add(app, g, "--scene", "SCENE", o.scene, "feel this scene instead of the record's")->check(named);
  addChoice(app, g, "--renderer", {"constraint", "paper"}, o.renderer,
            "constraint or paper (default: the one of the record)", "NAME");
  add(app, g, "--from", "TICK", o.from,
      "compare from this tick on, and begin at the last state saved before it (default 0)")
      ->check(tickNumber);
}

void defineQuery(CLI::App& app, Invocation& invocation) {
  auto& o = choose<QueryOptions>(invocation);
  app.add_option("input", o.input);
  const char* g = "Points, one of (in the scene's unit; RAS mm for an image)";
  addList(app, g, "--at", "X,Y,Z ...", o.at, "at these points");
  add(app, g, "--points", "FILE.csv", o.points, "at the points of a file with the header x,y,z");
  g = "Options";
  add(app, g, "--field", "NAME", o.field, "scene: this field or layer only");
  addScan(app, "What an image leaves open", o.scan, false);
}

void defineRender(CLI::App& app, Invocation& invocation) {
  auto& o = choose<RenderOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "Output";
  add(app, g, "-o,--output", "FILE.png", o.output,
      "the picture (required); with --turn or --replay FILE.webp, or FILE.png for frames "
      "FILE-0001.png "
      "and so on");
  add(app, g, "--size", "WxH", o.size, "in pixels (default 1600x1000)");
  g = "Where to cut (default: along the trace, else through the middle)";
  add(app, g, "--plane", "AXIS=VALUE", o.plane, "across an axis: x=12 (the scene's unit)");
  add(app, g, "--cut", "X,Y,Z,NX,NY,NZ", o.cut,
      "any plane: a point and a normal; looked at against it");
  g = "What to show";
  add(app, g, "--trace", "FILE.csv", o.trace, "the path and the forces of a `touch --trace`");
  add(app, g, "--image", "IMAGE", o.image,
      "gray values of this scan, or of this image of the scene (default: the scene's first "
      "that has no names)");
  add(app, g, "--iso", "LENGTH", o.iso,
      "lines of equal distance from the nearest layer's surface, so far apart: 5 (the scene's "
      "unit)");
  add(app, g, "--forces", "N", o.forces,
      "arrows where it is cut, N along its longer side: the force on a hand that was led there "
      "from the "
      "nearest place outside and rests")
      ->check(CLI::Range(2, 100));
  g = "In space, instead of a flat cut (whole, or with --plane or --cut what is behind that)";
  add(app, g, "--view", "FROM", o.view,
      "from where: corner, front, back, left, right, top, bottom (of the patient in a scan), +x, "
      "-x, +y, -y, "
      "+z, -z, or X,Y,Z at the viewer");
  add(app, g, "--around", "X,Y,Z,RADIUS", o.around,
      "view: look at this point, and so far around it (the scene's unit; default: all)");
  addList(app, g, "--opacity", "LAYER=SHARE", o.opacity,
          "view: see through this layer: skin=0.3; may be repeated");
  addList(app, g, "--slice", "AXIS=VALUE", o.slices,
          "view: a slice with its gray values that stands in the scene; may be repeated");
  add(app, g, "--turn", "FRAMES", o.turn, "view: turn once about z, so many pictures, 20 a second")
      ->check(CLI::Range(2, 720));
  add(app, g, "--replay", "FRAMES", o.replay,
      "view: the hand and the force on their way along the trace, so many pictures")
      ->check(CLI::Range(2, 2000));
}

void defineExplain(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ExplainOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "What to look at";
  addFlag(app, g, "--measure", o.measure,
          "make all of it, and what is needed, and tell memory and time");
  g = "The device that the scene is for";
  addDevice(app, g, o.device,
            std::string("list what is felt beside what this device can hold, and what cures what "
                        "it cannot: ") +
                deviceModels() + " (virtual:NAME means the same)");
  add(app, g, "--rate", "HZ", o.rate, "device: ticks a second (default 1000)")
      ->check(CLI::Range(1.0, 100000.0));
  add(app, "Output files", "--svg", "FILE.svg", o.svg,
      "draw the table of transitions: regions, and the ports between them");
}

void defineReport(CLI::App& app, Invocation& invocation) {
  auto& o = choose<ReportOptions>(invocation);
  app.add_option("inputs", o.inputs);
  add(app, "Output", "-o,--output", "FILE.html", o.output, "the page (required)");
  const char* g = "The device that the scene is for";
  addDevice(app, g, o.device,
            "list what is felt beside what this device can hold, as palpate explain does");
  add(app, g, "--rate", "HZ", o.rate, "device: ticks a second (default 1000)")
      ->check(CLI::Range(1.0, 100000.0));
}

}  // namespace

Verb touchVerb() {
  return {
      "touch",
      "Move a probe through a scene and feel it",
      "palpate touch data/scenes/container.yaml --insert 0,0,60 0,0,0 --back --trace trace.csv",
      "palpate touch SCENE|MESH|IMAGE|GRID.vdb MOTION [OPTIONS]",
      R"(Prints the regions in the order in which they were entered, with the depth below the first
surface met and the peak force in each; the ports passed; how long a tick takes; and what each
grid cost. A press or tap that meets nothing ends with 1. A trace has the header
t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,tick_ns
and the same input gives the same trace, bit for bit except tick_ns.)",
      {"--stroke", "--insert"},
      defineTouch,
      [](const Invocation& i) {
        need(!chosen<TouchOptions>(i).scene.empty(), "SCENE, MESH, IMAGE or GRID");
      },
      true};
}

Verb replayVerb() {
  return {
      "replay",
      "Feel a record anew, and say whether the same comes out",
      "palpate replay press.npy --from 5000",
      "palpate replay FILE.npy [OPTIONS]",
      R"(Feeds the readings of a record (palpate touch ... --record FILE.npy) to the same scene, or to another,
and compares what comes out of each tick with the record, bit for bit: velocity, proxy, forces,
region, ports. It reports the first tick that is different and the largest differences of force and
proxy. States are for the build that saved them; any build can replay from the first tick.
Exit code 0 if all is the same, 1 if not; 3 if the record cannot be read.)",
      {},
      defineReplay,
      [](const Invocation& i) { need(!chosen<ReplayOptions>(i).record.empty(), "FILE.npy"); }};
}

Verb queryVerb() {
  return {
      "query",
      "Value, gradient, region and material at points; or an image's intensity",
      "palpate query data/scenes/container.yaml --at 0,0,14 0,0,16",
      "palpate query SCENE|IMAGE POINTS [OPTIONS]",
      R"(An image (NIfTI, NRRD, MetaImage, a DICOM series) is read at RAS points in mm, trilinear between voxel centers; outside
these there is no value.)",
      {"--at"},
      defineQuery,
      [](const Invocation& i) {
        const auto& o = chosen<QueryOptions>(i);
        need(!o.input.empty(), "SCENE or IMAGE");
        if (o.at.empty() == o.points.empty()) {
          throw usageError(
              o.at.empty() ? "no points were given" : "--at and --points exclude one another",
              "write --at X,Y,Z ... or --points FILE.csv");
        }
      }};
}

Verb explainVerb() {
  return {"explain",
          "Show what a scene means: regions, walls, ports, what can be reached",
          "palpate explain data/scenes/container.yaml --svg ports.svg",
          "palpate explain SCENE [OPTIONS]",
          "",
          {},
          defineExplain,
          [](const Invocation& i) { need(!chosen<ExplainOptions>(i).scene.empty(), "SCENE"); },
          true};
}

Verb renderVerb() {
  return {
      "render",
      "Draw a scene cut open, or in space (.png; turning or replayed: .webp)",
      "palpate render data/scenes/container.yaml -o container.png --plane y=0",
      "palpate render SCENE -o OUT.png|OUT.webp [OPTIONS]",
      R"(With --view the scene stands in space, shaded by the exact normals of its fields; a trace is drawn as
the tip's path, colored by the force on the hand, faint where something hides it. An animation repeats for ever.)",
      {},
      defineRender,
      [](const Invocation& i) {
        const auto& o = chosen<RenderOptions>(i);
        need(!o.scene.empty(), "SCENE");
        need(!o.output.empty(), "-o OUT.png");
        if (!o.plane.empty() && !o.cut.empty()) {
          throw usageError("--plane and --cut exclude one another", "");
        }
      },
      true};
}

Verb reportVerb() {
  return {"report",
          "Write a page about touches, scenes and benches (.html)",
          "palpate report trace.csv data/scenes/container.yaml -o report.html",
          "palpate report FILE... -o OUT.html [OPTIONS]",
          R"(A chapter for each FILE:
  trace.csv, record.npy   of palpate touch: what was touched, regions, force and energy over time,
                          ports passed, time of a tick; of a record also what it was made with
  scene.yaml              the scene cut open, its regions, walls and table of states, its grids and
                          what they lost; with --device the budget of stability
  bench.json              what palpate bench or palpate accuracy printed with --json: times, errors,
                          the machine
The path of a trace is drawn into the scene that is given with it; a record brings its own scene. The
page holds its pictures and plots and loads nothing. Exit code 3 if a FILE cannot be read.)",
          {},
          defineReport,
          [](const Invocation& i) {
            const auto& o = chosen<ReportOptions>(i);
            need(!o.inputs.empty(), "a trace, record, scene or bench");
            need(!o.output.empty(), "-o OUT.html");
          },
          true};
}

}  // namespace palpate::tools
