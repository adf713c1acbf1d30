#include "command_line.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <functional>
#include <memory>
#include <set>

#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"

namespace palpate::tools {
namespace {

Error usageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.command_line", std::move(message), std::move(hint)});
}

/// Our layout of --help: wide first column, no type decorations that the text does not explain.
class HelpFormatter : public CLI::Formatter {
 public:
  HelpFormatter() { column_width(30); }
  std::string make_option_opts(const CLI::Option* option) const override {
    return option->get_option_text().empty() ? "" : " " + option->get_option_text();
  }
  std::string make_usage(const CLI::App* app, std::string) const override {
    return "\nUsage: " + app->get_name() + "\n";
  }
  std::string make_description(const CLI::App* app) const override {
    return app->get_description() + "\n";
  }
  std::string make_positionals(const CLI::App*) const override { return {}; }
};

struct Verb {
  const char* name;
  const char* line;     ///< what it does, in one line
  const char* example;  ///< one that runs from the project's folder
  const char* usage;
  const char* details;                ///< after the options; may be empty
  std::set<std::string> point_lists;  ///< options that take several points after one another
  std::function<void(CLI::App&, Invocation&)> define;
  std::function<void(const Invocation&)> check;  ///< what must be there
};

template <class Options>
Options& choose(Invocation& invocation) {
  return invocation.options.emplace<Options>();
}

/// An option with the placeholder `what`, in help group `group`.
template <class T>
CLI::Option* add(CLI::App& app, const char* group, const char* names, const char* what, T& value,
                 const char* text) {
  auto* option = app.add_option(names, value, text)->group(group)->option_text(what);
  if constexpr (!std::is_same_v<T, std::vector<std::string>>) {
    option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
  }
  return option;
}

void addFlag(CLI::App& app, const char* group, const char* names, bool& value, const char* text) {
  app.add_flag(names, value, text)->group(group);
}

void need(bool there, const char* what) {
  if (!there) throw usageError(std::string(what) + " is missing", "");
}

/// A list that takes one value for each mention.
void addList(CLI::App& app, const char* group, const char* names, const char* what,
             std::vector<std::string>& values, const char* text) {
  add(app, group, names, what, values, text)->expected(1)->take_all()->allow_extra_args(false);
}

void defineTouch(CLI::App& app, Invocation& invocation) {
  auto& o = choose<TouchOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "The hand's motion, exactly one of";
  add(app, g, "--path", "FILE.csv", o.path,
      "follow a recorded hand: header t,x,y,z in s and m, one row a tick");
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
  add(app, g, "--renderer", "NAME", o.renderer, "constraint or paper (default: as the scene says)")
      ->check(CLI::IsMember({"constraint", "paper"}));
  add(app, g, "--rate", "HZ", o.rate, "ticks a second (default 1000)")
      ->check(CLI::Range(1.0, 100000.0));
  addFlag(app, g, "--realtime", o.realtime,
          "keep to the clock (default: as fast as the machine goes)");
  g = "Limits of the force, in this order (default: none)";
  add(app, g, "--max-force", "FORCE", o.max_force,
      "shorten longer forces to this, direction kept: 3 (N), 500mN");
  add(app, g, "--slew", "FORCE/s", o.slew,
      "let the force grow by no more than this a second: 100 (N/s); it may drop at once");
  add(app, g, "--ramp", "TIME", o.ramp,
      "start without force, and reach all of it after this: "
      "0.2 (s), 200ms");
  g = "Output files";
  add(app, g, "--trace", "FILE.csv", o.trace, "write one row a tick (SI units)");
  add(app, g, "--image", "FILE.png", o.image,
      "draw the scene cut open, with the path and the forces");
}

void defineBake(CLI::App& app, Invocation& invocation) {
  auto& o = choose<BakeOptions>(invocation);
  app.add_option("input", o.input);
  const char* g = "Output";
  add(app, g, "-o,--output", "FILE.vdb", o.output, "where the grids go (required)");
  add(app, g, "--voxel", "LENGTH", o.voxel,
      "voxel size, in the input's unit or with a unit: 0.5mm (default: that of an image or grid; "
      "else 1/128 of the longest side)");
  add(app, g, "--half-width", "VOXELS", o.half_width,
      "width of the narrow band on each side of the surface (default 6)")
      ->check(CLI::Range(2.0, 64.0));
  addList(app, g, "--layer", "NAME", o.layers,
          "scene: only this layer, may be repeated; mesh, --above: what to call it");
  g = "From a mesh";
  add(app, g, "--units", "UNIT", o.units,
      "what one unit of the mesh is: mm (default), cm, m, um, in");
  g = "From a NIfTI image";
  add(app, g, "--above", "VALUE", o.above, "the surface around all voxels greater than this");
  add(app, g, "--keep", "largest|all", o.keep, "--above: which pieces (default largest)")
      ->check(CLI::IsMember({"largest", "all"}));
  addFlag(app, g, "--fill", o.fill, "--above: close enclosed cavities");
  add(app, g, "--labels", "NAME,...", o.labels,
      "one grid for each of these labels: values, names, or patterns such as 'lung*'")
      ->expected(1)
      ->delimiter(',')
      ->take_all()
      ->allow_extra_args(false);
  add(app, g, "--names", "FILE", o.names, "name table: lines `index name` or `value,name`");
}

void defineInfo(CLI::App& app, Invocation& invocation) {
  auto& o = choose<InfoOptions>(invocation);
  app.add_option("files", o.files);
  add(app, "Options", "--units", "UNIT", o.units,
      "what one unit of a mesh is: mm (default), cm, m, um, in");
}

void defineQuery(CLI::App& app, Invocation& invocation) {
  auto& o = choose<QueryOptions>(invocation);
  app.add_option("input", o.input);
  const char* g = "Points, one of (in the scene's unit; RAS mm for an image)";
  addList(app, g, "--at", "X,Y,Z ...", o.at, "at these points");
  add(app, g, "--points", "FILE.csv", o.points, "at the points of a file with the header x,y,z");
  g = "Options";
  add(app, g, "--field", "NAME", o.field, "scene: this field or layer only");
}

void defineExplain(CLI::App& app, Invocation& invocation) {
  app.add_option("scene", choose<ExplainOptions>(invocation).scene);
}

void defineRender(CLI::App& app, Invocation& invocation) {
  auto& o = choose<RenderOptions>(invocation);
  app.add_option("scene", o.scene);
  const char* g = "Output";
  add(app, g, "-o,--output", "FILE.png", o.output, "the picture (required)");
  add(app, g, "--size", "WxH", o.size, "in pixels (default 1600x1000)");
  g = "Where to cut (default: along the trace, else through the middle)";
  add(app, g, "--plane", "AXIS=VALUE", o.plane, "across an axis: x=12 (the scene's unit)");
  add(app, g, "--cut", "X,Y,Z,NX,NY,NZ", o.cut,
      "any plane: a point and a normal; looked at against it");
  g = "What to show";
  add(app, g, "--trace", "FILE.csv", o.trace, "the path and the forces of a `touch --trace`");
  add(app, g, "--image", "IMAGE", o.image,
      "grey values of this NIfTI file, or of this image of the scene (default: the scene's first "
      "that has no names)");
}

void defineBench(CLI::App& app, Invocation& invocation) {
  auto& o = choose<BenchOptions>(invocation);
  app.add_option("what", o.what);
  const char* g = "What to run";
  addList(app, g, "--scene", "NAME", o.scenes, "only this scene, may be repeated (default: all)");
  add(app, g, "--renderer", "NAME", o.renderer, "only constraint or only paper (default: both)")
      ->check(CLI::IsMember({"constraint", "paper"}));
  add(app, g, "--repeat", "N", o.repeats, "runs, of which the shortest time counts (default 10)")
      ->check(CLI::Range(1, 100000));
  g = "Output files";
  add(app, g, "--csv", "FILE.csv", o.csv, "the table, one row for each scene and renderer");
  add(app, g, "--svg", "FILE.svg", o.svg, "a plot of error against time");
}

void defineHelp(CLI::App& app, Invocation& invocation) {
  auto& o = choose<HelpOptions>(invocation);
  app.add_option("verb", o.verb);
  addFlag(app, "Options", "--markdown", o.markdown,
          "everything, as the reference in tools/README.md");
}

template <class Options>
const Options& chosen(const Invocation& invocation) {
  return std::get<Options>(invocation.options);
}

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {
      {"touch",
       "Move a probe through a scene and feel it",
       "palpate touch data/scenes/container.yaml --insert 0,0,60 0,0,0 --back --trace trace.csv",
       "palpate touch SCENE MOTION [OPTIONS]",
       "Prints the regions in the order in which they were entered, with the depth below the "
       "first\n"
       "surface met and the peak force in each; the ports passed; how long a tick takes; and what "
       "each\n"
       "grid cost. A trace has the header\n"
       "t,hip_x,hip_y,hip_z,proxy_x,proxy_y,proxy_z,force_x,force_y,force_z,region,contact,event,"
       "tick_ns\n"
       "and the same input gives the same trace, bit for bit except tick_ns.",
       {"--stroke", "--insert"},
       defineTouch,
       [](const Invocation& i) { need(!chosen<TouchOptions>(i).scene.empty(), "SCENE"); }},
      {"bake",
       "Turn a scene, a mesh or a scan into narrow-band level sets (.vdb)",
       "palpate bake data/scenes/container.yaml -o container.vdb --voxel 0.5",
       "palpate bake INPUT -o OUT.vdb [OPTIONS]",
       "INPUT is a scene file, a mesh (.stl .obj .ply .gltf .glb) or an image (.nii .nii.gz). Each "
       "layer\n"
       "becomes a grid `<layer>/surface`. An image needs --above or --labels.",
       {},
       defineBake,
       [](const Invocation& i) {
         need(!chosen<BakeOptions>(i).input.empty(), "INPUT");
         need(!chosen<BakeOptions>(i).output.empty(), "-o OUT.vdb");
       }},
      {"info",
       "Say what a file is: scene, grid, mesh or scan",
       "palpate info /usr/share/mricron/templates/ch2.nii.gz",
       "palpate info FILE... [OPTIONS]",
       "",
       {},
       defineInfo,
       [](const Invocation& i) { need(!chosen<InfoOptions>(i).files.empty(), "FILE"); }},
      {"query",
       "Value, gradient, region and material at points; or an image's intensity",
       "palpate query data/scenes/container.yaml --at 0,0,14 0,0,16",
       "palpate query SCENE|IMAGE POINTS [OPTIONS]",
       "An image (.nii .nii.gz) is read at RAS points in mm, trilinear between voxel centres; "
       "outside\n"
       "these there is no value.",
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
       }},
      {"explain",
       "Show what a scene means: regions, walls, ports, what can be reached",
       "palpate explain data/scenes/container.yaml",
       "palpate explain SCENE [OPTIONS]",
       "",
       {},
       defineExplain,
       [](const Invocation& i) { need(!chosen<ExplainOptions>(i).scene.empty(), "SCENE"); }},
      {"render",
       "Draw a scene cut open (.png)",
       "palpate render data/scenes/container.yaml -o container.png --plane y=0",
       "palpate render SCENE -o OUT.png [OPTIONS]",
       "",
       {},
       defineRender,
       [](const Invocation& i) {
         const auto& o = chosen<RenderOptions>(i);
         need(!o.scene.empty(), "SCENE");
         need(!o.output.empty(), "-o OUT.png");
         if (!o.plane.empty() && !o.cut.empty()) {
           throw usageError("--plane and --cut exclude one another", "");
         }
       }},
      {"bench",
       "Measure contact: how long a tick takes, and how far off its force is",
       "palpate bench contact --scene sphere --scene torus --svg contact.svg",
       "palpate bench contact [OPTIONS]",
       "Runs both renderers along the same paths on scenes of known truth and compares the forces "
       "with\n"
       "closed forms, or with a slow oracle where there is none. `missed` counts ticks where one "
       "has a\n"
       "force and the other none; `step` and `turn` are the largest from tick to tick, with the "
       "true ones\n"
       "beside them. Scenes: sphere, sphere-baked, sphere-deep, sphere-small, sphere-hollow, "
       "ellipsoid,\n"
       "quadric, torus, box-edge, box-room, crease, groove, saddle, container, balls-1, "
       "balls-1000,\n"
       "balls-10000.",
       {},
       defineBench,
       [](const Invocation& i) { need(!chosen<BenchOptions>(i).what.empty(), "contact"); }},
      {"help",
       "Print help, also as the reference manual",
       "palpate help touch",
       "palpate help [VERB] [--markdown]",
       "",
       {},
       defineHelp,
       [](const Invocation&) {}},
  };
  return all;
}

const Verb* findVerb(std::string_view name) {
  const auto& all = verbs();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Verb& v) { return v.name == name; });
  return at == all.end() ? nullptr : &*at;
}

std::unique_ptr<CLI::App> makeApp(const Verb& verb, Invocation& invocation) {
  auto app = std::make_unique<CLI::App>(verb.line, verb.usage);
  app->formatter(std::make_shared<HelpFormatter>());
  app->set_help_flag();  // ours is handled before parsing, so that it never competes with errors
  verb.define(*app, invocation);
  const char* g = "General";
  if (verb.name != std::string_view("help")) {
    addFlag(*app, g, "--json", invocation.general.json, "print one JSON object instead of text");
    addFlag(*app, g, "--quiet", invocation.general.quiet, "no notes and no progress on stderr");
    const auto& o = invocation.options;
    if (std::holds_alternative<TouchOptions>(o) || std::holds_alternative<BakeOptions>(o) ||
        std::holds_alternative<RenderOptions>(o) || std::holds_alternative<BenchOptions>(o)) {
      addFlag(*app, g, "--force", invocation.general.force, "replace existing output files");
    }
  }
  app->footer((verb.details[0] != '\0' ? std::string(verb.details) + "\n\n" : "") +
              "Example: " + verb.example);
  return app;
}

std::string verbHelp(const Verb& verb) {
  Invocation scratch;
  auto app = makeApp(verb, scratch);
  bool unused = false;
  app->add_flag("-h,--help", unused, "print this")->group("General");
  std::string text = app->help();
  for (std::size_t at = 0; (at = text.find("\n\n\n")) != std::string::npos;) text.erase(at, 1);
  return text;
}

std::string overview() {
  std::string text =
      "palpate - feel what is inside a scanned or modelled object\n\nUsage: palpate VERB "
      "[OPTIONS]\n\n";
  for (const Verb& verb : verbs()) {
    text += "  " + std::string(verb.name) + std::string(10 - std::string(verb.name).size(), ' ') +
            verb.line + "\n            " + verb.example + "\n";
  }
  return text +
         "\n  palpate VERB --help   all about one verb\n  palpate --version     the version\n\n"
         "Results go to stdout, everything else to stderr; --json gives one JSON object.\n"
         "Exit code: 0 done, 1 the operation failed, 2 wrong usage, 3 bad input, 4 device, 130 "
         "interrupted.\n";
}

std::string markdown() {
  std::string text = "```\n" + overview() + "```\n";
  for (const Verb& verb : verbs()) {
    text += "\n### palpate " + std::string(verb.name) + "\n\n```\n" + verbHelp(verb) + "```\n";
  }
  return text;
}

Error unknownVerb(const std::string& word) {
  std::vector<std::string_view> names;
  std::string list;
  for (const Verb& verb : verbs()) {
    names.emplace_back(verb.name);
    list += (list.empty() ? "" : ", ") + std::string(verb.name);
  }
  const std::string close = suggest(word, names);
  return usageError("there is no verb '" + word + "'",
                    close.empty() ? "the verbs are " + list : "did you mean '" + close + "'?");
}

/// For an option that nobody knows: what may have been meant.
Error unknownArgument(const CLI::App& app, const Verb& verb, const std::string& argument) {
  const std::string more = "see palpate " + std::string(verb.name) + " --help";
  if (argument.empty() || argument[0] != '-') {
    return usageError("'" + argument + "' is one argument too many", more);
  }
  std::vector<std::string> names = {"--help"};
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string word = argument.substr(0, argument.find('='));
  const std::string close =
      suggest(word, std::vector<std::string_view>(names.begin(), names.end()));
  return usageError("'" + std::string(verb.name) + "' has no option " + word,
                    close.empty() ? more : "did you mean " + close + "?");
}

bool looksLikePoint(const std::string& text) {
  return std::count(text.begin(), text.end(), ',') == 2 &&
         text.find_first_not_of("0123456789+-.eE, ") == std::string::npos;
}

/// `--insert A B C` becomes `--insert A --insert B --insert C`, so that a list of points never swallows
/// what follows it; and "-.5,..." is told apart from a short option.
std::vector<std::string> spreadPoints(const Verb& verb, const std::vector<std::string>& arguments) {
  std::vector<std::string> out;
  std::string list;
  bool first = false;
  for (const std::string& argument : arguments) {
    if (verb.point_lists.contains(argument)) {
      list = argument;
      first = true;
      out.push_back(argument);
      continue;
    }
    if (!list.empty() && looksLikePoint(argument)) {
      if (!first) out.push_back(list);
      first = false;
    } else {
      list.clear();
    }
    out.push_back(argument.starts_with("-.") ? "-0" + argument.substr(1) : argument);
  }
  return out;
}

}  // namespace

std::string helpText(const HelpOptions& options) {
  if (options.markdown) return markdown();
  if (options.verb.empty()) return overview();
  const Verb* verb = findVerb(options.verb);
  if (verb == nullptr) throw unknownVerb(options.verb);
  return verbHelp(*verb);
}

Invocation parseCommandLine(const std::vector<std::string>& arguments) {
  Invocation invocation;
  // General options may stand before the verb as well.
  std::size_t at = 0;
  std::vector<std::string> rest;
  while (at < arguments.size() && arguments[at].starts_with("--") && arguments[at] != "--help" &&
         arguments[at] != "--version") {
    if (arguments[at] != "--json" && arguments[at] != "--quiet" && arguments[at] != "--force") {
      throw usageError("'" + arguments[at] + "' is not a general option", "the verb comes first");
    }
    rest.push_back(arguments[at++]);
  }
  if (at == arguments.size()) {
    throw usageError("a verb is missing", "palpate --help lists them");
  }
  const std::string& word = arguments[at];
  if (word == "--help" || word == "-h") {
    invocation.print = overview();
    return invocation;
  }
  if (word == "--version") {
    invocation.print = "palpate " PALPATE_VERSION "\n";
    return invocation;
  }
  const Verb* verb = findVerb(word);
  if (verb == nullptr) throw unknownVerb(word);
  rest.insert(rest.end(), arguments.begin() + static_cast<std::ptrdiff_t>(at) + 1, arguments.end());
  if (std::any_of(rest.begin(), rest.end(),
                  [](const std::string& a) { return a == "--help" || a == "-h"; })) {
    invocation.print = verbHelp(*verb);
    return invocation;
  }

  invocation.verb = word;
  auto app = makeApp(*verb, invocation);
  rest = spreadPoints(*verb, rest);
  std::reverse(rest.begin(), rest.end());  // as CLI11 wants them
  try {
    app->parse(std::move(rest));
  } catch (const CLI::ExtrasError&) {
    const auto extras = app->remaining();
    const auto option = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& a) { return a.starts_with('-'); });
    throw unknownArgument(*app, *verb, option != extras.end() ? *option : extras.front());
  } catch (const CLI::ParseError& error) {
    throw usageError(error.what(), "see palpate " + word + " --help");
  }
  try {
    verb->check(invocation);
  } catch (const Error& error) {
    Problem problem = error.problem();
    if (problem.hint.empty()) problem.hint = "usage: " + std::string(verb->usage);
    throw Error(ErrorKind::kUsage, problem);
  }
  return invocation;
}

}  // namespace palpate::tools
