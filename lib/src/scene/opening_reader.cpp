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

constexpr int kMostTimes = 1000;

/// [N] at which the port opens, either way, anywhere.
double mostForceOf(const PortDescription& port) {
  return std::max(port.opens_at.range().most, port.back.value_or(0.0).range().most);
}

}  // namespace

void RegionReader::readPorts(const Node& ports) {
  const Document& document = loader_.document();
  const auto& nodes = readList(document, ports, "'ports'", 1, kMostItems);
  for (const Node& node : nodes) {
    MapReader reader(loader_, node, "a port");
    PortDescription port;
    port.name = readName(reader, "port");
    port.place = document.place(node.find("name")->mark);
    refuseSecond("port", port, scene_.ports);
    if (const Node* sheet = reader.optional("sheet")) {
      port.sheet = readSheetName(reader, *sheet);
    } else {
      const Between between = readBetween(reader);
      port.from = between.a;
      port.to = between.b;
    }
    if (const Node* on = reader.optional("on")) {
      port.on = fields_.readName(*on, "'on'");
      port.on_name = on->text;
      port.on_note = fields_.hidingPlace(on->text);
    }
    if (const Node* where = reader.optional("where")) port.where = loader_.field(*where);
    if (const Node* direction = reader.optional("direction")) {
      constexpr PortDirection kDirections[] = {PortDirection::kBoth, PortDirection::kIn,
                                               PortDirection::kOut};
      port.direction =
          kDirections[readChoice(document, *direction, "'direction'", {"both", "in", "out"})];
    }
    (void)reader.optional("after");  // when all ports are known
    port.opens_at = readParameter(reader, "opens_at", Dimension::kForce, {});
    if (reader.optional("back") != nullptr) {
      port.back = readParameter(reader, "back", Dimension::kForce, {});
    }
    readPuncture(reader, port);
    reader.finish();
    scene_.ports.push_back(std::move(port));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    if (const Node* after = nodes[i].find("after")) readAfter(*after, scene_.ports[i]);
  }
}

void RegionReader::requireOpeningForce(const MapReader& reader, std::string_view key,
                                       const PortDescription& port) {
  if (mostForceOf(port) > 0.0) return;
  throw reader.errorAt(
      key, "scene.no_opening_force",
      inQuotes(key) + " is about a port that opens by force, and this one is always open",
      "give it the force: opens_at: 2 N");
}

/// How it opens by force, and what that leaves behind.
void RegionReader::readPuncture(MapReader& reader, PortDescription& port) const {
  if (const Node* hole = reader.optional("hole")) {
    requireOpeningForce(reader, "hole", port);
    MapReader inner(loader_, *hole, "'hole'");
    port.hole_radius = inner.requireLength("radius");
    if (port.hole_radius <= 0.0) {
      throw inner.errorAt("radius", "scene.range", "'radius' must be more than 0");
    }
    port.reopens_at = readParameter(inner, "reopens_at", Dimension::kForce, {});
    if (port.reopens_at.range().least > mostForceOf(port)) {
      throw inner.errorAt("reopens_at", "scene.range",
                          "'reopens_at' is more than what opens the port where it has no hole",
                          "make it less than opens_at and back");
    }
    inner.finish();
  }
  if (const Node* rate = reader.optional("rate")) {
    requireOpeningForce(reader, "rate", port);
    MapReader inner(loader_, *rate, "'rate'");
    port.rate.ratio = inner.requireNumber("ratio");
    if (!(port.rate.ratio > 0.0)) {
      throw inner.errorAt("ratio", "scene.range", "'ratio' must be more than 0",
                          "less than 1: a fast hand needs less force; more than 1: it needs more");
    }
    (void)inner.require("speed");
    port.rate.speed = inner.quantityOr("speed", Dimension::kVelocity, 0.0);
    if (!(port.rate.speed > 0.0)) {
      throw inner.errorAt("speed", "scene.range", "'speed' must be more than 0");
    }
    inner.finish();
  }
  if (reader.optional("rearm") != nullptr) {
    requireOpeningForce(reader, "rearm", port);
    port.rearm = reader.lengthOr("rearm", 0.0);
    if (port.rearm < 0.0) {
      throw reader.errorAt("rearm", "scene.range", "'rearm' must be 0 or more");
    }
  }
}

/// Of the sheet that a port is in.
std::string RegionReader::readSheetName(MapReader& reader, const Node& sheet) const {
  const Document& document = loader_.document();
  for (const std::string_view key : {"between", "on"}) {
    if (!reader.has(key)) continue;
    throw reader.errorAt(key, "scene.one_of",
                         inQuotes(key) + " and 'sheet' do not go together in a port",
                         "a port in a sheet has the same region on both sides; say where in the "
                         "sheet it is with 'where'");
  }
  std::string name = readText(document, sheet, "'sheet'");
  const std::vector<std::string_view> names = namesOf(scene_.sheets);
  if (std::find(names.begin(), names.end(), name) == names.end()) {
    throw document.error(sheet.mark, "scene.unknown_sheet", "there is no sheet " + inQuotes(name),
                         suggestOrList(name, names, "sheets: "));
  }
  return name;
}

/// A name, or {port, times}.
AfterDescription RegionReader::readBefore(const Node& item) const {
  const Document& document = loader_.document();
  if (item.kind != Node::Kind::kMap) return {readText(document, item, "a port")};
  MapReader reader(loader_, item, "an item of 'after'");
  AfterDescription before(reader.requireText("port"));
  if (reader.optional("times") != nullptr) {
    const double times = reader.numberOr("times", 1.0);
    if (times != std::floor(times) || times < 1.0 || times > kMostTimes) {
      throw reader.errorAt(
          "times", "scene.range",
          "'times' must be a whole number from 1 to " + std::to_string(kMostTimes));
    }
    before.times = static_cast<int>(times);
  }
  reader.finish();
  return before;
}

void RegionReader::readAfter(const Node& after, PortDescription& port) const {
  const Document& document = loader_.document();
  const std::vector<std::string_view> names = namesOf(scene_.ports);
  for (const Node& item : readList(document, after, "'after'", 1, 0)) {
    AfterDescription before = readBefore(item);
    const Node* named = item.kind == Node::Kind::kMap ? item.find("port") : &item;
    if (std::find(names.begin(), names.end(), before.port) == names.end()) {
      throw document.error(named->mark, "scene.unknown_port",
                           "there is no port " + inQuotes(before.port),
                           suggestOrList(before.port, names, "ports: "));
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

void RegionReader::readSheets(const Node& sheets) {
  const Document& document = loader_.document();
  for (const Node& node : readList(document, sheets, "'sheets'", 1, kMostItems)) {
    MapReader reader(loader_, node, "a sheet");
    SheetDescription sheet;
    sheet.name = readName(reader, "sheet");
    sheet.place = document.place(node.find("name")->mark);
    refuseSecond("sheet", sheet, scene_.sheets);
    sheet.on = loader_.field(reader.require("on"));
    if (const Node* where = reader.optional("where")) sheet.where = loader_.field(*where);
    if (const Node* wall = reader.optional("wall")) {
      const WallDescription made_of = readWall(*wall);
      if (made_of.absent) {
        throw document.error(wall->mark, "scene.kind", "a sheet that is absent is no sheet",
                             "name a material, or leave the sheet out");
      }
      sheet.material = made_of.material;
    }
    reader.finish();
    scene_.sheets.push_back(std::move(sheet));
  }
}

}  // namespace palpate
