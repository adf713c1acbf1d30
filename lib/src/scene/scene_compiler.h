#pragma once
/// Turns a description into a Scene, with one step for each kind of thing.

#include <set>
#include <string>
#include <utility>
#include <vector>

#include "globs.h"
#include "label_share.h"
#include "palpate/core/text.h"
#include "palpate/interior/port_machine.h"
#include "palpate/scene/scene.h"
#include "palpate/scene/scene_file.h"
#include "survey.h"

namespace palpate {

/// Makes one Scene.
class SceneCompiler {
 public:
  SceneCompiler(const SceneDescription& description, const Progress& progress, Purpose purpose);
  ScenePtr build();

 private:
  /// Number of regions.
  [[nodiscard]] std::size_t count() const { return layers_.size() + 1; }

  // compile.cpp
  Partition makePartition(const Progress& progress);
  void regions();
  int material(const std::string& name, const SourcePlace& place);
  Wall wall(const WallDescription& given, const SourcePlace& place);
  void materials();
  std::vector<RegionId> matching(const std::string& globs, const SourcePlace& place);
  Error unknownRegion(const std::string& name, const SourcePlace& place);
  std::vector<Wall> makeWalls();

  // compile_passages.cpp
  std::vector<Port> makePorts();
  std::vector<Sheet> makeSheets();
  std::vector<LeafId> facetLeaves(const PortDescription& given, const Port& port);
  PortId portNamed(const std::string& name, const PortDescription& asker);
  int sheetNamed(const PortDescription& asker);
  void requireTouching(const PortDescription& given, const Port& port);
  static void refuse(const PortDescription& given);
  void refuseCycles(const std::vector<Port>& ports);

  // compile_reach.cpp
  void lookAround();
  RegionId start();
  [[nodiscard]] std::vector<bool> regionsOfSheet(std::size_t sheet,
                                                 const FieldSourcePtr& part) const;
  /// Pairs of regions, the lower one first, that were found to touch where the port is.
  [[nodiscard]] std::set<std::pair<RegionId, RegionId>> findPort(PortId id) const;
  /// Follows absent walls and ports from the start.
  void markReachable();

  [[nodiscard]] bool isLeftOut(RegionId region) const {
    return region != kOutside && !left_out_[region - 1U].empty();
  }
  /// Whether all regions that match `globs` are left out.
  [[nodiscard]] bool isNowhere(const std::string& globs) const;

  /// The needed part of the field, made if necessary.
  [[nodiscard]] const FieldPtr& made(const FieldSourcePtr& source,
                                     const Progress& progress = {}) const {
    return source->get(needed_, progress);
  }

  const SceneDescription& description_;
  const Box3 needed_;                  // [m] nothing beyond it matters
  std::vector<std::string> left_out_;  // by layer: the reason; empty if it is made
  std::vector<LeafBetween> between_;   // filled with the layers
  std::vector<FieldPtr> layers_;
  std::vector<int> mask_of_;  // by port: index of a mask of the partition; -1: none
  std::vector<int> sheet_mask_of_;
  std::vector<int> sheet_solid_of_;
  std::shared_ptr<Scene> scene_;
  std::vector<Box3> boxes_;
  Survey survey_;
  bool patient_ = false;
};

}  // namespace palpate
