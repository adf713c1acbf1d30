#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>

#include "bench/machine_json.h"
#include "open_device.h"
#include "output_files.h"
#include "palpate/core/text.h"
#include "palpate/vdb/text.h"
#include "report_page/chapters.h"
#include "scene_hash.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

enum class PartKind { kTouch, kScene, kBench };

Json jsonOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  return Json::parse(std::string(std::istreambuf_iterator<char>(in), {}), nullptr, false);
}

PartKind kindOf(const std::string& file) {
  std::error_code failed;
  if (!std::filesystem::exists(file, failed)) {
    throw inputError("file.missing", "there is no such file", "check the path", file);
  }
  if (vdb::hasExtension(file, ".csv") || vdb::hasExtension(file, ".npy")) return PartKind::kTouch;
  if (vdb::hasExtension(file, ".yaml") || vdb::hasExtension(file, ".yml")) return PartKind::kScene;
  if (vdb::hasExtension(file, ".json")) {
    // A scene may also be JSON.
    const Json json = jsonOf(file);
    return json.is_object() && json.contains("schema") ? PartKind::kBench : PartKind::kScene;
  }
  throw inputError(
      "report.kind", "there is no chapter for such a file",
      "give a trace (.csv), a record (.npy), a scene (.yaml), or what bench or accuracy "
      "prints with --json (.json)",
      file);
}

/// The scene that was felt, if it has not changed; otherwise the reason why it is not shown.
std::unique_ptr<LoadedScene> feltScene(const RecordAbout& about, Console& console,
                                       std::string& why_not) {
  std::error_code failed;
  if (!std::filesystem::exists(about.scene, failed)) {
    why_not = "The scene that was felt is not there any more: " + about.scene;
    return nullptr;
  }
  if (sceneHash(about.scene, about.scene_text) != about.scene_hash) {
    why_not = "The scene has changed since it was felt, so it is not shown: " + about.scene;
    return nullptr;
  }
  return std::make_unique<LoadedScene>(about.scene, console, 0, about.scene_text);
}

}  // namespace

Report run(const ReportOptions& options, const GeneralOptions& general, Console& console) {
  const auto usage = [](const std::string& message, const std::string& hint) {
    return Error(ErrorKind::kUsage, {"usage.report", message, hint});
  };
  if (!vdb::hasExtension(options.output, ".html")) {
    throw usage("the output " + options.output + " must end in .html", "");
  }
  if (options.rate && options.device.name.empty()) {
    throw usage("--rate needs a device", "add --device NAME");
  }
  const double rate = options.rate.value_or(1000.0);
  (void)simulationOf(options.device, rate);  // reports errors in these options before any work
  OutputFiles files(general);
  files.announce(options.output, options.inputs);

  std::vector<Touch> touches;
  std::vector<std::string> scenes;
  std::vector<std::pair<std::string, Json>> benches;
  std::vector<std::string> names;
  for (const std::string& file : options.inputs) {
    names.push_back(vdb::fileName(file));
    switch (kindOf(file)) {
      case PartKind::kTouch:
        touches.push_back(readTouch(file));
        break;
      case PartKind::kScene:
        scenes.push_back(file);
        break;
      case PartKind::kBench:
        benches.emplace_back(file, jsonOf(file));
        checkBench(benches.back().second, file);
        break;
    }
  }

  HtmlPage page("Palpate: " + joined(names));
  for (const Touch& touch : touches) addTouchChapter(page, touch);
  // A path is drawn into a scene only if there is one touch and one scene: then they belong
  // together.
  const bool is_pair = touches.size() == 1 && scenes.size() == 1;
  for (const std::string& file : scenes) {
    const LoadedScene loaded(file, console);
    addSceneChapter(page, loaded,
                    {file, options.device, rate, is_pair ? touches.front().track : Track{}},
                    console);
  }
  for (const Touch& touch : touches) {
    if (!touch.source.about || !scenes.empty()) continue;
    const RecordAbout& about = *touch.source.about;
    std::string why_not;
    const std::unique_ptr<LoadedScene> loaded = feltScene(about, console, why_not);
    if (!loaded) {
      page.note(why_not);
      console.warn(why_not);
      continue;
    }
    addSceneChapter(page, *loaded, {about.scene, options.device, rate, touch.track}, console);
  }
  for (const auto& [file, bench] : benches) addBenchChapter(page, bench, file);

  files.write(options.output,
              page.text("Made by " + general.command + "\npalpate " + PALPATE_VERSION_STRING +
                        " on " + machineText(thisMachine())));
  checkStop();
  files.commit();
  Report report;
  report.json = {
      {"schema", "palpate.report/1"}, {"inputs", options.inputs}, {"output", options.output}};
  report.text = "Wrote " + options.output + "\n";
  return report;
}

}  // namespace palpate::tools
