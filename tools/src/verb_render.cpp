
#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "output_files.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
#include "picture/space_picture.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

constexpr int kSmallest = 320;  // [pixels] below this nothing can be read
constexpr int kLargest = 8000;

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

/// From the scene at the viewer; none: at a corner of the cut.
std::optional<Vec3> parseView(const std::string& text) {
  if (text == "corner") return std::nullopt;
  if (text.size() == 2 && (text[0] == '+' || text[0] == '-') && text[1] >= 'x' && text[1] <= 'z') {
    Vec3 toward(0.0);
    toward[text[1] - 'x'] = text[0] == '+' ? 1.0 : -1.0;
    return toward;
  }
  const Vec3 toward = parseVector(text, "--view");
  if (!(glm::length(toward) > 0.0)) {
    throw usageError("--view: " + text + " has no direction",
                     "corner, +x, -x, +y, -y, +z, -z or X,Y,Z");
  }
  return toward;
}

SpaceView parseSpace(const RenderOptions& options) {
  SpaceView view;
  view.toward = parseView(options.view);
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

/// What the options may not be together.
void checkOptions(const RenderOptions& o) {
  const bool is_moving = o.turn || o.replay;
  if (o.view.empty() && (is_moving || !o.opacity.empty())) {
    throw usageError("--opacity, --turn and --replay are of a picture in space",
                     "say from where it is seen: --view corner");
  }
  if (o.turn && o.replay) throw usageError("--turn and --replay exclude one another");
  if (o.replay && o.trace.empty()) {
    throw usageError("--replay shows a trace", "say which: --trace FILE.csv");
  }
  const char* extension = is_moving ? ".webp" : ".png";
  if (!vdb::hasExtension(o.output, extension)) {
    throw usageError("the output " + o.output + " must end in " + extension);
  }
}

}  // namespace

Report run(const RenderOptions& options, const GeneralOptions& general, Console& console) {
  checkOptions(options);
  const bool is_in_space = !options.view.empty();
  const SpaceView view = is_in_space ? parseSpace(options) : SpaceView{};
  PictureOptions picture;
  parseSize(options.size, picture);
  OutputFiles files(general);
  files.announce(options.output, {options.scene, options.trace, options.image});

  LoadedScene loaded(options.scene, console);
  const LengthUnit unit = loaded.unit();
  if (!options.plane.empty()) picture.plane = parsePlane(options.plane, unit);
  if (!options.cut.empty()) picture.plane = parseCut(options.cut, unit);
  if (!options.trace.empty()) picture.track = readTrack(options.trace);
  picture.image = pictureImage(loaded, options.image);
  picture.colors = loaded.colors();
  picture.anatomical = !loaded.images().empty();
  picture.title = vdb::fileName(options.scene);

  const ScenePtr scene = loaded.compile();
  std::optional<CutPlane> plane = picture.plane;
  if (is_in_space) {
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
                 {"output", options.output},
                 {"width", picture.width},
                 {"height", picture.height},
                 {"plane", plane ? Json{{"point_m", vectorJson(plane->point)},
                                        {"normal", vectorJson(plane->normal())}}
                                 : Json()},
                 {"grids", loaded.gridsJson()}};
  const std::string lost = loaded.lossText();
  report.text = (plane ? "Cut " + plane->name + "\n" : "") + "Wrote " + options.output + "\n" +
                (lost.empty() ? "" : "\nGrids\n" + lost);
  return report;
}

}  // namespace palpate::tools
