// RegionReader's ports, and its sheets.

#include <algorithm>
#include <cmath>

#include "scene/messages.h"
#include "scene/named_items.h"
#include "scene/parameter_reader.h"
#include "scene/region_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

/// [N] The largest force at which the port opens, in either direction, anywhere.
double mostForceOf(const PortDescription& port) {
  return std::max(port.opens_at.range().most, port.back.value_or(0.0).range().most);
}

}  // namespace

void RegionReader::readPorts(const std::vector<MapReader>& ports) {
  constexpr PortDirection kDirections[] = {PortDirection::kBoth, PortDirection::kIn,
                                           PortDirection::kOut};
  for (const MapReader& reader : ports) {
    PortDescription port;
    port.name = readName(reader, "port");
    port.place = placeOf(reader, "name");
    refuseSecond("port", port, scene_.ports);
    if (reader.has("sheet")) {
      port.sheet = readSheetName(reader);
    } else if (reader.has("between")) {
      const Between between = readBetween(reader);
      port.from = between.a;
      port.to = between.b;
    } else {
      throw reader.errorAt("", "scene.missing_key", "a port has no 'between'", "add between: ...");
    }
    if (const Node* on = reader.find("on")) {
      port.on = fields_.readName(*on, "'on'");
      port.on_name = on->text;
      port.on_note = fields_.hidingPlace(on->text);
    }
    if (const Node* where = reader.find("where")) port.where = loader_.field(*where);
    port.direction = kDirections[reader.choice("direction")];
    port.opens_at = readParameter(reader, "opens_at");
    if (reader.has("back")) port.back = readParameter(reader, "back");
    readPuncture(reader, port);
    scene_.ports.push_back(std::move(port));
  }
  // Only now all ports are known.
  for (std::size_t i = 0; i < ports.size(); ++i) {
    if (const Node* after = ports[i].find("after")) readAfter(*after, scene_.ports[i]);
  }
}

void RegionReader::requireOpeningForce(const MapReader& reader, std::string_view key,
                                       const PortDescription& port) {
  if (mostForceOf(port) > 0.0) return;
  throw reader.errorAt(
      key, "scene.no_opening_force",
      inQuotes(key) + " applies to ports that open by force, and this one is always open",
      "give it the force: opens_at: 2 N");
}

/// Reads `hole`, `rate` and `rearm`, which only a port that opens by force may have.
void RegionReader::readPuncture(const MapReader& reader, PortDescription& port) {
  for (const char* key : {"hole", "rate", "rearm"}) {
    if (reader.has(key)) requireOpeningForce(reader, key, port);
  }
  if (reader.has("hole")) {
    const MapReader hole = reader.map("hole");
    port.hole_radius = hole.value("radius");
    port.reopens_at = readParameter(hole, "reopens_at");
    if (port.reopens_at.range().least > mostForceOf(port)) {
      throw hole.errorAt("reopens_at", "scene.range",
                         "'reopens_at' is more than the force that opens the port without a hole",
                         "make it less than opens_at and back");
    }
  }
  if (reader.has("rate")) {
    const MapReader rate = reader.map("rate");
    port.rate.ratio = rate.value("ratio");
    port.rate.speed = rate.value("speed");
  }
  port.rearm = reader.value("rearm");
}

/// Reads the name of the sheet that a port is in.
std::string RegionReader::readSheetName(const MapReader& reader) const {
  const Document& document = loader_.document();
  for (const std::string& key : reader.words("sheet").excludes) {
    if (!reader.has(key)) continue;
    throw reader.errorAt(key, "scene.one_of",
                         "a port has either " + inQuotes(key) + " or 'sheet', not both",
                         "a port in a sheet has the same region on both sides; say where in the "
                         "sheet it is with 'where'");
  }
  const Node& sheet = *reader.find("sheet");
  std::string name = readText(document, sheet, "'sheet'");
  const std::vector<std::string_view> names = namesOf(scene_.sheets);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw unknownName(document, sheet.mark, "sheet", name, names);
  }
  return name;
}

/// A name, or {port, times}.
AfterDescription RegionReader::readBefore(const Node& item) const {
  const Document& document = loader_.document();
  if (item.kind != Node::Kind::kMap) return {readText(document, item, "a port")};
  const MapReader reader(loader_, item, "an item of 'after'", "passed_before");
  return {reader.text("port"), static_cast<int>(reader.value("times"))};
}

void RegionReader::readAfter(const Node& after, PortDescription& port) const {
  const Document& document = loader_.document();
  const std::vector<std::string_view> names = namesOf(scene_.ports);
  for (const Node& item : readList(document, after, "'after'", 1, 0)) {
    AfterDescription before = readBefore(item);
    const Node* named = item.kind == Node::Kind::kMap ? item.find("port") : &item;
    if (std::find(names.begin(), names.end(), before.port) == names.end()) {
      throw unknownName(document, named->mark, "port", before.port, names);
    }
    if (before.port == port.name) {
      throw document.error(named->mark, "scene.cycle",
                           "the port " + inQuotes(before.port) + " cannot come after itself");
    }
    const bool is_listed =
        std::any_of(port.after.begin(), port.after.end(),
                    [&](const AfterDescription& other) { return other.port == before.port; });
    if (is_listed) {
      throw document.error(
          named->mark, "scene.duplicate_name", inQuotes(before.port) + " is listed twice",
          "to ask for more than one passing: {port: " + before.port + ", times: 2}");
    }
    port.after.push_back(std::move(before));
  }
}

void RegionReader::readSheets(const std::vector<MapReader>& sheets) {
  for (const MapReader& reader : sheets) {
    SheetDescription sheet;
    sheet.name = readName(reader, "sheet");
    sheet.place = placeOf(reader, "name");
    refuseSecond("sheet", sheet, scene_.sheets);
    sheet.on = loader_.field(*reader.find("on"));
    if (const Node* where = reader.find("where")) sheet.where = loader_.field(*where);
    if (const Node* wall = reader.find("wall")) {
      const WallDescription made_of = readWall(*wall);
      if (made_of.absent) {
        throw reader.errorAt("wall", "scene.kind", "a sheet cannot be absent",
                             "name a material, or leave the sheet out");
      }
      sheet.material = made_of.material;
    }
    scene_.sheets.push_back(std::move(sheet));
  }
}

}  // namespace palpate
