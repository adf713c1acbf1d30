#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "output_files.h"
#include "palpate/render/haptic_renderer.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
#include "picture/space_picture.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

constexpr int kSmallest = 320;  // [pixels] smaller pictures cannot be read
constexpr int kLargest = 8000;
constexpr double kNearest = 1e-6;  // [m] least radius of --around

Error usageError(std::string message, std::string hint = {}) {
  return Error(ErrorKind::kUsage, {"usage.render", std::move(message), std::move(hint)});
}

void parseSize(const std::string& text, PictureOptions& picture) {
  if (text.empty()) return;
  const auto parts = split(text, 'x');
  const auto number = [&](std::size_t i) {
    const auto value = i < parts.size() ? parseNumber(parts[i]) : std::nullopt;
    if (parts.size() != 2 || !value || *value < kSmallest || *value > kLargest ||
        *value != static_cast<int>(*value)) {
      throw usageError("--size: '" + text + "' is not WIDTHxHEIGHT",
                       "each from 320 to 8000, as in 1600x1000");
    }
    return static_cast<int>(*value);
  };
  picture.width = number(0);
  picture.height = number(1);
}

/// Direction from the scene to the viewer; not given: at a corner of the cut. In a scan the names
/// of sides are the patient's, whose front is towards larger y; in other scenes one looks along y,
/// with x to the right.
std::optional<Vec3> parseView(const std::string& text, bool is_anatomical) {
  if (text == "corner") return std::nullopt;
  const std::pair<const char*, Vec3> names[] = {{"front", {0.0, is_anatomical ? 1.0 : -1.0, 0.0}},
                                                {"back", {0.0, is_anatomical ? -1.0 : 1.0, 0.0}},
                                                {"right", {1.0, 0.0, 0.0}},
                                                {"left", {-1.0, 0.0, 0.0}},
                                                {"top", {0.0, 0.0, 1.0}},
                                                {"bottom", {0.0, 0.0, -1.0}}};
  for (const auto& [name, toward] : names) {
    if (text == name) return toward;
  }
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'x' && text[1] <= 'z') {
    Vec3 toward(0.0);
    toward[text[1] - 'x'] = text[0] == '+' ? 1.0 : -1.0;
    return toward;
  }
  constexpr const char* kNames =
      "corner, front, back, left, right, top, bottom, +x, -x, +y, -y, +z, -z or X,Y,Z";
  if (text.find(',') == std::string::npos) {
    throw usageError("--view: '" + text + "' is not a place to look from", kNames);
  }
  const Vec3 toward = parseVector(text, "--view");
  if (toward == Vec3(0.0)) throw usageError("--view: " + text + " has no direction", kNames);
  return toward;
}

SpaceView::Around parseAround(const std::string& text, const LengthUnit& unit) {
  const auto parts = split(text, ',');
  double numbers[4] = {};
  bool is_good = parts.size() == 4;
  for (std::size_t i = 0; is_good && i < 4; ++i) {
    const auto number = parseNumber(parts[i]);
    is_good = number.has_value();
    if (is_good) numbers[i] = *number * unit.meters;
  }
  if (!is_good) throw usageError("--around: '" + text + "' is not four numbers", "X,Y,Z,RADIUS");
  const SpaceView::Around around{Vec3(numbers[0], numbers[1], numbers[2]), numbers[3]};
  if (!HapticRenderer::isInReach(around.center) || !(around.radius >= kNearest) ||
      around.radius > HapticRenderer::kFarthest) {
    throw usageError("--around: nothing can be seen " + text + " from there",
                     "a point of the scene, and a radius of 1 um to 10 km");
  }
  return around;
}

/// Parses the options that do not depend on the scene.
SpaceView parseSpace(const RenderOptions& options) {
  SpaceView view;
  view.toward = parseView(options.view, false);
  for (const std::string& each : options.opacity) {
    const std::size_t at = each.rfind('=');
    const auto share =
        at == std::string::npos ? std::nullopt : parseNumber(std::string_view(each).substr(at + 1));
    if (!share || !(*share >= 0.0 && *share <= 1.0)) {
      throw usageError("--opacity: '" + each + "' is not LAYER=SHARE",
                       "a share is from 0, not seen, to 1: skin=0.3");
    }
    view.opacity[each.substr(0, at)] = *share;
  }
  if (options.turn) {
    view.motion = SpaceView::Motion::kTurn;
    view.frames = *options.turn;
  }
  if (options.replay) {
    view.motion = SpaceView::Motion::kReplay;
    view.frames = *options.replay;
  }
  return view;
}

/// Refuses combinations of options that make no sense.
void checkOptions(const RenderOptions& o) {
  const bool is_moving = o.turn || o.replay;
  const bool is_cut = !o.plane.empty() || !o.cut.empty();
  if (o.view.empty()) {
    if (is_moving || !o.opacity.empty() || !o.slices.empty() || !o.around.empty()) {
      throw usageError(
          "--around, --opacity, --slice, --turn and --replay apply to pictures in space",
          "add --view corner");
    }
  } else {
    if (o.forces && !is_cut) {
      throw usageError("--forces are drawn where the scene is cut", "say where: --plane y=0");
    }
    if (!o.iso.empty() && !is_cut && o.slices.empty()) {
      throw usageError("--iso: the lines are drawn where the scene is cut",
                       "say where: --plane y=0 or --slice y=0");
    }
  }
  if (o.turn && o.replay) throw usageError("--turn and --replay exclude one another");
  if (o.replay && o.trace.empty()) {
    throw usageError("--replay shows a trace", "say which: --trace FILE.csv");
  }
  const bool is_webp = vdb::hasExtension(o.output, ".webp");
  if (!vdb::hasExtension(o.output, ".png") && !(is_moving && is_webp)) {
    throw usageError(
        "the output " + o.output + " must end in .png" + (is_moving ? " or .webp" : ""),
        is_webp ? "a .webp moves: --turn or --replay" : "");
  }
}

double parseSpacing(const std::string& text, const LengthUnit& unit) {
  const double spacing = parseLength(text, unit, "--iso");
  if (!(spacing > 0.0)) throw usageError("--iso: " + text + " is not above 0");
  return spacing;
}

/// "turn.png", 0 -> "turn-0001.png"
std::string frameName(const std::string& output, int frame) {
  std::string number = std::to_string(frame + 1);
  number.insert(0, 4 - std::min<std::size_t>(4, number.size()), '0');
  const std::size_t dot = output.rfind('.');
  return output.substr(0, dot) + "-" + number + output.substr(dot);
}

}  // namespace

Report run(const RenderOptions& options, const GeneralOptions& general, Console& console) {
  checkOptions(options);
  const bool is_in_space = !options.view.empty();
  SpaceView view = is_in_space ? parseSpace(options) : SpaceView{};
  const bool has_frames =
      view.motion != SpaceView::Motion::kNone && vdb::hasExtension(options.output, ".png");
  PictureOptions picture;
  parseSize(options.size, picture);
  OutputFiles files(general);
  const std::vector<std::string> inputs = {options.scene, options.trace, options.image};
  std::vector<std::string> outputs;
  for (int i = 0; has_frames && i < view.frames; ++i) {
    outputs.push_back(frameName(options.output, i));
  }
  if (!has_frames) outputs.push_back(options.output);
  for (const std::string& output : outputs) files.announce(output, inputs);

  LoadedScene loaded(options.scene, console);
  const LengthUnit unit = loaded.unit();
  if (!options.plane.empty()) picture.plane = parsePlane(options.plane, unit);
  if (!options.cut.empty()) picture.plane = parseCut(options.cut, unit);
  for (const std::string& slice : options.slices) {
    view.slices.push_back(parsePlane(slice, unit, "--slice"));
  }
  if (!options.around.empty()) view.around = parseAround(options.around, unit);
  if (!options.iso.empty()) picture.line_spacing = parseSpacing(options.iso, unit);
  picture.forces = options.forces.value_or(0);
  if (!options.trace.empty()) picture.track = readTrack(options.trace);
  picture.image = pictureImage(loaded.images(), options.image);
  picture.colors = loaded.colors();
  picture.anatomical = !loaded.images().empty();
  picture.title = vdb::fileName(options.scene);
  if (is_in_space) view.toward = parseView(options.view, picture.anatomical);

  const ScenePtr scene = loaded.compile();
  std::optional<CutPlane> plane = picture.plane;
  if (has_frames) {
    (void)drawSpacePicture(*scene, picture, view, console, [&](int i, const std::string& png) {
      files.write(outputs[static_cast<std::size_t>(i)], png);
    });
  } else if (is_in_space) {
    files.write(options.output, drawSpacePicture(*scene, picture, view, console));
  } else {
    const Picture drawn = drawPicture(*scene, picture, console);
    plane = drawn.plane;
    files.write(options.output, drawn.png);
  }
  checkStop();
  files.commit();

  Report report;
  report.json = {{"schema", "palpate.render/1"},
                 {"scene", options.scene},
                 {"output", has_frames ? Json(outputs) : Json(options.output)},
                 {"width", picture.width},
                 {"height", picture.height},
                 {"plane", plane ? Json{{"point_m", vectorJson(plane->point)},
                                        {"normal", vectorJson(plane->normal())}}
                                 : Json()},
                 {"grids", loaded.gridsJson()}};
  if (view.motion != SpaceView::Motion::kNone) report.json["frames"] = view.frames;
  const std::string lost = loaded.lossText();
  report.text = (plane ? "Cut " + plane->name + "\n" : "") + "Wrote " + outputs.front() +
                (has_frames ? " to " + outputs.back() : "") + "\n" +
                (lost.empty() ? "" : "\nGrids\n" + lost);
  return report;
}

}  // namespace palpate::tools
