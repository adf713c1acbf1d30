#include "check/file_check.h"
#include "input_kind.h"
#include "json_parts.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

FileCheck checkFile(const std::string& file, const CheckOptions& options, Console& console) {
  switch (inputKind(file)) {
    case InputKind::kMesh:
      return checkMeshFile(file, options, console);
    case InputKind::kGrid:
      return checkGridFile(file, options, console);
    case InputKind::kScene:
      return checkSceneFile(file, console);
    case InputKind::kImage:
      break;
  }
  throw inputError("check.kind", "this is an image; check looks at meshes, grids and scenes",
                   "palpate info describes an image; palpate bake makes a grid of it", file);
}

}  // namespace

Json findingsJson(const std::vector<Finding>& findings) {
  Json all = Json::array();
  for (const Finding& f : findings) {
    all.push_back({{"code", f.code},
                   {"message", f.message},
                   {"count", f.count},
                   {"place_m", f.place ? vectorJson(*f.place) : Json()}});
  }
  return all;
}

std::string findingsText(const std::vector<Finding>& findings, const char* indent) {
  std::string text;
  for (const Finding& f : findings) text += indent + ("- " + f.message) + "\n";
  return text;
}

Json problemJson(const Problem& problem) {
  return {{"code", problem.code},
          {"message", problem.message},
          {"hint", problem.hint.empty() ? Json() : Json(problem.hint)}};
}

std::string problemText(const Problem& problem) {
  return problem.message + (problem.hint.empty() ? "" : " (" + problem.hint + ")");
}

std::string countOf(std::uint64_t count, const std::string& one, const std::string& many) {
  return formatCount(count) + " " + (count == 1 ? one : many);
}

std::string placeText(const Vec3& place, const LengthUnit& unit) {
  return formatVector(place / unit.meters) + " " + unit.name;
}

Report run(const CheckOptions& options, const GeneralOptions&, Console& console) {
  Report report;
  Json files = Json::array();
  for (const std::string& file : options.files) {
    checkStop();
    FileCheck one = checkFile(file, options, console);
    if (!report.text.empty()) report.text += "\n";
    report.text += one.text;
    report.is_yes = report.is_yes && one.is_yes;
    files.push_back(std::move(one.json));
  }
  report.json = {{"schema", "palpate.check/1"}, {"ok", report.is_yes}, {"files", std::move(files)}};
  return report;
}

}  // namespace palpate::tools
