#include "explain/explain_sections.h"
#include "open_device.h"
#include "output_files.h"
#include "palpate/core/error.h"
#include "verbs.h"

namespace palpate::tools {

Report run(const ExplainOptions& options, const GeneralOptions& general, Console& console) {
  const double rate = options.rate.value_or(1000.0);
  if (options.rate && !simulationOf(options.device, rate)) {
    throw Error(ErrorKind::kUsage, {"usage.explain", "--rate needs a device", "add --device NAME"});
  }
  OutputFiles files(general);
  if (!options.svg.empty())
    files.announce(options.svg, {options.scene}, OutputFiles::Streams::kYes);
  LoadedScene loaded(options.scene, console);
  const ScenePtr compiled = loaded.compile(Purpose::kTouch);
  const Scene& scene = *compiled;
  const SceneDescription& description = loaded.description();
  const std::string start = scene.regions()[scene.startRegion()].name;
  const std::string renderer = scene.renderer() == RendererKind::kPaper ? "paper" : "constraint";

  Report report;
  report.json = {{"schema", "palpate.explain/1"},
                 {"scene", options.scene},
                 {"length_unit", scene.lengthUnit()},
                 {"renderer", renderer},
                 {"start", start},
                 {"memory", scene.keepsMemory() ? "keep" : "until outside"}};
  report.text = options.scene + ": the probe starts in " + start + "; renderer " + renderer +
                "; lengths in " + scene.lengthUnit() + "\n";
  addDevice(scene, report);
  addRegions(scene, report);
  addWalls(scene, report);
  addPorts(scene, description, report);
  addTransitions(scene, description, report);
  addMaps(scene, description, report);
  addWallNotes(scene, report);
  addStability(scene, options.device, rate, report);
  addSources(scene, loaded, report);
  report.json["measured"] = Json();
  if (options.measure) addMeasured(options.scene, console, report);
  report.json["svg"] = options.svg.empty() ? Json() : Json(options.svg);
  if (!options.svg.empty()) {
    files.write(options.svg, transitionPicture(scene, description, options.scene));
    files.commit();
    report.text += "\nWritten  " + options.svg + "\n";
  }
  return report;
}

}  // namespace palpate::tools
