
#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "output_files.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/text.h"
#include "picture/picture.h"
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

}  // namespace

Report run(const RenderOptions& options, const GeneralOptions& general, Console& console) {
  if (!vdb::hasExtension(options.output, ".png")) {
    throw usageError("the output " + options.output + " must end in .png");
  }
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
  const Picture drawn = drawPicture(*scene, picture, console);
  const CutPlane& plane = drawn.plane;
  files.write(options.output, drawn.png);
  checkStop();
  files.commit();

  Report report;
  report.json = {
      {"schema", "palpate.render/1"},
      {"scene", options.scene},
      {"output", options.output},
      {"width", picture.width},
      {"height", picture.height},
      {"plane", {{"point_m", vectorJson(plane.point)}, {"normal", vectorJson(plane.normal())}}},
      {"grids", loaded.gridsJson()}};
  const std::string lost = loaded.lossText();
  report.text = "Cut " + plane.name + "\nWrote " + options.output + "\n" +
                (lost.empty() ? "" : "\nGrids\n" + lost);
  return report;
}

}  // namespace palpate::tools
