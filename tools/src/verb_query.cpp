#include <cmath>
#include <optional>

#include "asked_fields.h"
#include "input_kind.h"
#include "json_parts.h"
#include "loaded_scene.h"
#include "output_files.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/image.h"
#include "points_file.h"
#include "scan_options.h"
#include "text.h"
#include "verbs.h"

namespace palpate::tools {
namespace {

std::vector<Vec3> queryPoints(const QueryOptions& options, const LengthUnit& unit) {
  if (!options.points.empty()) return readPoints(inputName(options.points), unit);
  std::vector<Vec3> points;
  for (const std::string& text : options.at) points.push_back(parsePoint(text, unit, "--at"));
  return points;
}

Report queryImage(const QueryOptions& options, Console& console) {
  if (!options.field.empty()) {
    throw Error(ErrorKind::kUsage,
                {"usage.command_line", "--field applies to scenes, not to images"});
  }
  const LengthUnit mm = {"mm", 1e-3};
  const std::vector<Vec3> points = queryPoints(options, mm);
  const vdb::Image image = vdb::readImage(options.input, imageOptions(options.scan));
  for (const auto& note : image.notes) console.note(options.input + ": " + note);
  Report report;
  report.json = {{"schema", "palpate.query/1"},
                 {"image", options.input},
                 {"length_unit", "mm"},
                 {"points", Json::array()}};
  Table table({"at (RAS mm)", "intensity"});
  std::size_t outside = 0;
  for (const Vec3& p : points) {
    const double value = image.interpolate(p);
    const bool there = std::isfinite(value);
    if (!there) ++outside;
    report.json["points"].push_back(
        {{"at", vectorJson(p / mm.meters)}, {"value", there ? Json(value) : Json()}});
    table.add({formatVector(p / mm.meters, 6), there ? formatNumber(value, 8) : "outside"});
  }
  if (outside > 0) {
    console.note(std::to_string(outside) + " of " + std::to_string(points.size()) +
                 " points lie outside the box of the voxel centers; there is no value there");
  }
  report.text = table.text("");
  return report;
}

Json contentJson(const Scene& scene, const Region& region, const Vec3& p) {
  if (region.content < 0) return {};
  return materialJson(scene.materials()[static_cast<std::size_t>(region.content)], &p);
}

Json sampleJson(const AskedField& asked, const FieldSample& s, double unit) {
  Json json = {{"name", asked.name},
               {"value", s.value / unit},
               {"gradient", vectorJson(s.gradient)},
               {"metric", metricName(asked.field->metric())},
               {"in_band", s.in_band}};
  return json;
}

Report queryScene(const QueryOptions& options, Console& console) {
  refuseScanOptions(options.scan, false);
  LoadedScene loaded(options.input, console);
  const LengthUnit unit = loaded.unit();
  const std::vector<Vec3> points = queryPoints(options, unit);
  const ScenePtr scene = loaded.compile();
  const std::vector<AskedField> fields = chooseFields(*scene, options.field, "query.unknown_field");

  Report report;
  report.json = {{"schema", "palpate.query/1"},
                 {"scene", options.input},
                 {"length_unit", unit.name},
                 {"points", Json::array()}};
  for (const Vec3& p : points) {
    const Region& region = scene->regions()[scene->regionAt(p)];
    Json json = {
        {"at", vectorJson(p / unit.meters)},
        {"region", region.name},
        {"content", contentJson(*scene, region, p)},
        {"wall", region.wall < 0
                     ? Json()
                     : materialJson(scene->materials()[static_cast<std::size_t>(region.wall)], &p)},
        {"fields", Json::array()}};
    report.text += "at " + formatVector(p / unit.meters, 6) + " " + unit.name + ": " + region.name;
    if (region.content >= 0) {
      const Material& m = scene->materials()[static_cast<std::size_t>(region.content)];
      report.text += ", content " + m.name + " (" + formatNumber(m.viscosity.at(p)) + " N.s/m)";
    }
    if (region.wall >= 0) {
      const Material& m = scene->materials()[static_cast<std::size_t>(region.wall)];
      report.text += ", wall " + m.name + " (" + formatNumber(m.stiffness.at(p)) + " N/m)";
    }
    report.text += "\n";
    Table table({"field", "value [" + unit.name + "]", "gradient", "value is"});
    for (const AskedField& asked : fields) {
      const FieldSample s = asked.field->sample(p);
      json["fields"].push_back(sampleJson(asked, s, unit.meters));
      table.add({asked.name,
                 (s.in_band       ? ""
                  : s.value < 0.0 ? "< "
                                  : "> ") +
                     formatNumber(s.value / unit.meters, 8),
                 s.in_band ? formatVector(s.gradient, 6) : "-",
                 s.in_band ? metricName(asked.field->metric()) : "beyond the band"});
    }
    report.text += table.text("  ");
    report.json["points"].push_back(std::move(json));
  }
  return report;
}

}  // namespace

Report run(const QueryOptions& options, const GeneralOptions&, Console& console) {
  switch (inputKind(options.input)) {
    case InputKind::kImage:
      return queryImage(options, console);
    case InputKind::kScene:
      return queryScene(options, console);
    case InputKind::kGrid:
    case InputKind::kMesh:
      break;
  }
  throw inputError(
      "query.kind", "only scenes and images can be queried",
      "name the grid or mesh in a scene file: fields: {part: {mesh: {file: part.stl}}}",
      options.input);
}

}  // namespace palpate::tools
