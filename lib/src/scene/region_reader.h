#pragma once
/// Reads layers, walls, ports, sheets and start of a scene: everything that names regions and
/// materials.

#include "palpate/scene/scene_file.h"
#include "scene/field_reader.h"

namespace palpate {

/// Fills a description whose materials are already known. Call its members in the order of
/// declaration: each refers to what those before it defined.
class RegionReader {
 public:
  RegionReader(const SceneLoader& loader, const SceneRegistry& registry, FieldReader& fields,
               SceneDescription& scene)
      : loader_(loader), registry_(registry), fields_(fields), scene_(scene) {}

  void readLayers(const std::vector<MapReader>& layers);
  void readWalls(const std::vector<MapReader>& walls);
  void readPorts(const std::vector<MapReader>& ports);
  void readSheets(const std::vector<MapReader>& sheets);
  void readStart(const MapReader& start);

 private:
  struct Between {
    std::string a;
    std::string b;
  };

  [[nodiscard]] static std::string readName(const MapReader& reader, std::string_view what);
  [[nodiscard]] static SourcePlace placeOf(const MapReader& reader, std::string_view key);
  void readSurface(const MapReader& reader, LayerDescription& layer) const;
  [[nodiscard]] const Material& material(const Node& node, const std::string& what) const;
  [[nodiscard]] WallDescription readWall(const Node& node) const;
  [[nodiscard]] std::string readSide(const Node& node) const;
  [[nodiscard]] Between readBetween(const MapReader& reader) const;
  void requireRegion(const Node& node, bool globs) const;
  static void requireOpeningForce(const MapReader& reader, std::string_view key,
                                  const PortDescription& port);
  static void readPuncture(const MapReader& reader, PortDescription& port);
  [[nodiscard]] std::string readSheetName(const MapReader& reader) const;
  [[nodiscard]] AfterDescription readBefore(const Node& item) const;
  void readAfter(const Node& after, PortDescription& port) const;

  const SceneLoader& loader_;
  const SceneRegistry& registry_;
  FieldReader& fields_;
  SceneDescription& scene_;
};

}  // namespace palpate
