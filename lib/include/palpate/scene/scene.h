#pragma once
/// Scene: the result of compiling a description. Immutable, shared, and the only thing that the
/// loop reads.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "palpate/export.h"
#include "palpate/interior/port.h"
#include "palpate/materials/material.h"
#include "palpate/scene/description.h"

namespace palpate {

class Partition;
class Passages;

/// Whether a sequence of transitions leads from the start to a place, with the ports passed in the
/// order that they demand. Of the shapes only one thing counts, which regions touch: a region in
/// two parts counts as one.
enum class Reach : std::uint8_t {
  kNo,         ///< there is none, however long
  kUndecided,  ///< none was found, nor a proof that there is none
  kYes,        ///< one was found
};

/// A region as the loop and the reports see it.
struct Region {
  std::string name;           ///< that of the layer, or "outside"
  int content = -1;           ///< index into Scene::materials(); -1: nothing is felt
  int wall = -1;              ///< material of its own wall; -1 where absent (and for outside)
  bool wall_absent = false;   ///< its own wall is a free crossing (false for outside)
  Reach reach = Reach::kYes;  ///< by ports and absent walls from the start region
  bool reachable = true;      ///< unless reach is kNo
  /// the layer's whole field (cut to its share of the label group); null for outside and for layers
  /// that were left out
  FieldPtr field;
  /// why the layer was not made (its space then belongs to its surroundings); else empty
  std::string left_out;
  std::string source;        ///< what it was made from; empty if analytic
  Vec3 seed{0.0, 0.0, 0.0};  ///< [m] a point of the region; meaningless unless has_seed
  bool has_seed = false;     ///< false: no point of it was found (an empty or dropped region)
};

/// A scene that is ready to be felt, as compile() makes it. Immutable, so that any number of
/// renderers, in any threads, may share one.
class PALPATE_EXPORT Scene {
 public:
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  /// Indexed by RegionId: outside, then the layers in the order of the description.
  [[nodiscard]] std::span<const Region> regions() const noexcept { return regions_; }
  /// The description's materials in its order, then "default wall" for walls that name none.
  [[nodiscard]] std::span<const Material> materials() const noexcept { return materials_; }
  /// Indexed by PortId, in the order of the description.
  [[nodiscard]] std::span<const Port> ports() const noexcept { return ports_; }
  /// Whether the port can ever be passed.
  [[nodiscard]] Reach reachOf(PortId port) const { return reach_of_port_[port]; }
  /// True if the two regions were found to have a wall (or an absent one) between them.
  [[nodiscard]] bool touches(RegionId a, RegionId b) const {
    return a != b && touch_[a * regions_.size() + b];
  }
  /// The region in which the proxy begins.
  [[nodiscard]] RegionId startRegion() const noexcept { return start_; }
  /// `memory: keep`: ports passed are never taken back nor cleared.
  [[nodiscard]] bool keepsMemory() const noexcept { return keep_memory_; }
  /// The renderer that the scene asks for; RendererSettings::kind takes precedence.
  [[nodiscard]] RendererKind renderer() const noexcept { return renderer_; }
  /// The renderers' limits where their own settings give none.
  [[nodiscard]] const ForceRequest& forceLimits() const noexcept { return force_; }
  /// Parameters of the paper's renderer.
  [[nodiscard]] const PaperParameters& paper() const noexcept { return paper_; }
  /// How the device's space lies in the world.
  [[nodiscard]] const DeviceMapping& device() const noexcept { return device_; }
  /// The unit that the scene file is written in ("mm"), for output that people read.
  [[nodiscard]] const std::string& lengthUnit() const noexcept { return length_unit_; }
  /// [m] The length of one lengthUnit().
  [[nodiscard]] double metersPerUnit() const noexcept { return meters_per_unit_; }
  /// The named fields of the description that were made, with their names, for `query`.
  [[nodiscard]] std::span<const NamedField> fields() const noexcept { return fields_; }

  /// Region at `p` [m]. Allocates a scratch array of signs: for set-up, queries and pictures.
  [[nodiscard]] RegionId regionAt(const Vec3& p) const;
  /// Region by name; throws Error (kInput) with a suggestion if there is none.
  [[nodiscard]] RegionId regionNamed(const std::string& name) const;
  /// Box around all bounded layers and sheets [m]; empty if there is none.
  [[nodiscard]] Box3 bounds() const;

  /// Space divided into regions, and the walls between them; for the library's own renderers.
  [[nodiscard]] const Partition& partition() const noexcept { return *partition_; }
  /// The rules of the ports, as a table of states and transitions; for the library's own renderers.
  [[nodiscard]] const Passages& passages() const noexcept { return *passages_; }

 private:
  friend class SceneCompiler;
  explicit Scene(Partition partition);

  std::unique_ptr<const Partition> partition_;  ///< never null, like passages_
  std::vector<Region> regions_;
  std::vector<Material> materials_;
  std::unique_ptr<const Passages> passages_;
  std::span<const Port> ports_;  ///< ports of passages_
  Box3 sheet_bounds_;            ///< [m]
  std::vector<bool> touch_;      ///< [a * regions + b], symmetric
  std::vector<Reach> reach_of_port_;
  ForceRequest force_;
  PaperParameters paper_;
  std::vector<NamedField> fields_;
  RegionId start_ = kOutside;
  bool keep_memory_ = false;
  RendererKind renderer_ = RendererKind::kConstraint;
  DeviceMapping device_;
  std::string length_unit_ = "m";
  double meters_per_unit_ = 1.0;
};

using ScenePtr = std::shared_ptr<const Scene>;  ///< shared and immutable

/// The purpose that a scene is compiled for.
enum class Purpose {
  /// to be felt: costly parts that the probe certainly cannot feel are left out (Region::left_out)
  kTouch,
  kShow,  ///< to be looked at: with all of its layers
};

/// Checks a description against itself and its geometry, makes its fields, and builds the scene. If
/// the purpose is touch, a costly layer is left out if it lies beyond the device's workspace, or if
/// no way leads into it and nothing that the probe can enter comes near it; ports into it then lead
/// nowhere. Of the other costly layers only the part within the workspace and a margin around it is
/// made: 5 % of its diagonal, and as deep as a wall is felt through (`composite`). A probe that
/// presses no deeper than that margin feels the whole; further away a cut shape continues as it is
/// at the cut.
/// @throws Error (kInput) pointing at the offending place: unknown layer or material, a port
/// between regions that do not touch, `on` not a leaf of either region, a cycle in `after`, ...
[[nodiscard]] PALPATE_EXPORT ScenePtr compile(const SceneDescription& description,
                                              const Progress& progress = {},
                                              Purpose purpose = Purpose::kTouch);

}  // namespace palpate
