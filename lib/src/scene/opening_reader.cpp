// RegionReader's ports, and its sheets.

#include <algorithm>

#include "scene/messages.h"
#include "scene/named_items.h"
#include "scene/parameter_reader.h"
#include "scene/region_reader.h"
#include "scene/values.h"

namespace palpate {
namespace {

/// [N] at which the port opens, either way, anywhere.
double mostForceOf(const PortDescription& port) {
  return std::max(port.opens_at.range().most, port.back.value_or(0.0).range().most);
}

}  // namespace

double RegionReader::readForce(MapReader& reader, std::string_view key, double fallback) const {
  const double force = reader.quantityOr(key, Dimension::kForce, fallback);
  if (force < 0.0) {
    throw reader.errorAt(key, "scene.range", inQuotes(key) + " must be 0 N or more");
  }
  return force;
}

void RegionReader::readPorts(const Node& ports) {
  const Document& document = loader_.document();
  const auto& nodes = readList(document, ports, "'ports'", 1, kMostItems);
  for (const Node& node : nodes) {
    MapReader reader(loader_, node, "a port");
    PortDescription port;
    port.name = readName(reader, "port");
    port.place = document.place(node.find("name")->mark);
    refuseSecond("port", port, scene_.ports);
    const Between between = readBetween(reader);
    port.from = between.a;
    port.to = between.b;
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

/// What opening it by force leaves behind.
void RegionReader::readPuncture(MapReader& reader, PortDescription& port) const {
  if (const Node* hole = reader.optional("hole")) {
    requireOpeningForce(reader, "hole", port);
    MapReader inner(loader_, *hole, "'hole'");
    port.hole_radius = inner.requireLength("radius");
    if (port.hole_radius <= 0.0) {
      throw inner.errorAt("radius", "scene.range", "'radius' must be more than 0");
    }
    port.reopens_at = readForce(inner, "reopens_at", 0.0);
    if (port.reopens_at > mostForceOf(port)) {
      throw inner.errorAt("reopens_at", "scene.range",
                          "'reopens_at' is more than what opens the port where it has no hole",
                          "make it less than opens_at and back");
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

void RegionReader::readAfter(const Node& after, PortDescription& port) const {
  const Document& document = loader_.document();
  const std::vector<std::string_view> names = namesOf(scene_.ports);
  for (const Node& item : readList(document, after, "'after'", 1, 0)) {
    const std::string name = readText(document, item, "a port");
    if (std::find(names.begin(), names.end(), name) == names.end()) {
      throw document.error(item.mark, "scene.unknown_port", "there is no port " + inQuotes(name),
                           suggestOrList(name, names, "ports: "));
    }
    if (name == port.name) {
      throw document.error(item.mark, "scene.cycle",
                           "the port " + inQuotes(name) + " cannot come after itself");
    }
    if (std::find(port.after.begin(), port.after.end(), name) != port.after.end()) {
      throw document.error(item.mark, "scene.duplicate_name", inQuotes(name) + " is listed twice");
    }
    port.after.push_back(name);
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
