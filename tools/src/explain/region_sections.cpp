#include "explain/explain_sections.h"
#include "json_parts.h"
#include "report_rows.h"
#include "text.h"

// Sections on the regions of a scene, and on the walls between them.

namespace palpate::tools {
namespace {

Json wallJson(const Scene& scene, const Wall& wall) {
  const Material* m = wall.absent ? nullptr : materialOf(scene, wall.material);
  return {{"absent", wall.absent}, {"material", m == nullptr ? Json() : materialJson(*m)}};
}

/// The ports of a sheet, by name.
std::string openingsOf(const Scene& scene, const Sheet& sheet) {
  std::string all;
  for (const Port& port : scene.ports()) {
    if (port.sheet < 0) continue;
    if (&scene.passages().sheets()[static_cast<std::size_t>(port.sheet)] != &sheet) continue;
    all += (all.empty() ? "" : ", ") + port.name;
  }
  return all.empty() ? "-" : all;
}

}  // namespace

void addDevice(const Scene& scene, Report& report) {
  const DeviceMapping& device = scene.device();
  const double unit = scene.metersPerUnit();
  const Box3 reach = device.reach();
  const Mat3& axes = device.rotation;
  report.json["device"] = {
      {"offset", vectorJson(device.offset / unit)},
      {"axes", Json::array({vectorJson(axes[0]), vectorJson(axes[1]), vectorJson(axes[2])})},
      {"scale", device.scale},
      {"force", device.force},
      {"stiffness_at_hand", device.stiffnessAtHand()},
      {"clutch", device.clutch},
      {"reach", reach.isBounded()
                    ? Json::array({vectorJson(reach.lo / unit), vectorJson(reach.hi / unit)})
                    : Json()}};
  if (reach.isBounded()) {
    report.text += "The device reaches from " + formatVector(reach.lo / unit) + " to " +
                   formatVector(reach.hi / unit) + "\n";
  }
  if (axes != Mat3(1.0)) {
    report.text += "The device's x, y and z point along " + formatDirection(axes[0]) + ", " +
                   formatDirection(axes[1]) + " and " + formatDirection(axes[2]) + "\n";
  }
  if (device.stiffnessAtHand() != 1.0) {
    report.text += "At the hand a stiffness is " + formatNumber(device.stiffnessAtHand(), 4) +
                   " times that of the scene\n";
  }
}

void addRegions(const Scene& scene, Report& report) {
  const auto regions = scene.regions();
  const double unit = scene.metersPerUnit();
  ReportRows rows({"region", "made from", "content", "wall", "can be entered", "a point of it"});
  std::string unreachable;
  for (std::size_t i = 0; i < regions.size(); ++i) {
    const Region& r = regions[i];
    const Material* content = materialOf(scene, r.content);
    const std::string source = i == kOutside ? "-" : r.source.empty() ? "formula" : r.source;
    Json json = {{"name", r.name},
                 {"source", source},
                 {"left_out", r.left_out.empty() ? Json() : Json(r.left_out)},
                 {"content", content == nullptr ? Json() : materialJson(*content)},
                 {"reachable", r.reachable},
                 {"reach", reachName(r.reach)},
                 {"seed", r.has_seed ? vectorJson(r.seed / unit) : Json()}};
    if (!r.reachable) {
      const std::string why =
          r.left_out.empty() ? whyUnreachable(scene, static_cast<RegionId>(i)) : r.left_out;
      json["why_unreachable"] = why;
      unreachable += "  " + r.name + ": " + why + "\n";
      report.notes.push_back("The probe can never get into " + r.name + ": " + why);
    }
    rows.add({r.name, source, content == nullptr ? "-" : contentText(*content),
              i == kOutside ? "-" : wallText(scene, {r.wall_absent, r.wall}),
              r.reach == Reach::kNo ? "NO" : reachName(r.reach),
              r.has_seed ? formatVector(r.seed / unit, 3) : "-"},
             std::move(json));
  }
  rows.writeTo(report, "regions", "Regions (outermost first)");
  if (!unreachable.empty()) report.text += "\nThe probe can never get into\n" + unreachable;
}

void addWalls(const Scene& scene, Report& report) {
  const auto regions = scene.regions();
  ReportRows walls({"between", "and", "felt from the first", "felt from the second"});
  for (std::size_t i = 0; i < regions.size(); ++i) {
    for (std::size_t j = i + 1; j < regions.size(); ++j) {
      const auto a = static_cast<RegionId>(i);
      const auto b = static_cast<RegionId>(j);
      if (!scene.touches(a, b)) continue;
      const Wall& from_a = scene.passages().wall(a, b);
      const Wall& from_b = scene.passages().wall(b, a);
      walls.add(
          {regions[a].name, regions[b].name, wallText(scene, from_a), wallText(scene, from_b)},
          {{"between", Json::array({regions[a].name, regions[b].name})},
           {"from_first", wallJson(scene, from_a)},
           {"from_second", wallJson(scene, from_b)}});
    }
  }
  walls.writeTo(report, "walls", "Walls (between regions that touch)");
  ReportRows sheets({"sheet", "wall", "extent", "ports"});
  for (const Sheet& sheet : scene.passages().sheets()) {
    const Wall wall{false, sheet.material};
    sheets.add({sheet.name, wallText(scene, wall),
                sheet.mask < 0 ? "all of its surface" : "limited", openingsOf(scene, sheet)},
               {{"name", sheet.name}, {"where", sheet.mask >= 0}, {"wall", wallJson(scene, wall)}});
  }
  sheets.writeTo(report, "sheets", "Sheets (the same region on both sides)");
}

}  // namespace palpate::tools
