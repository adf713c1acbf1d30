#pragma once
/// Scene: what compile() makes of a description. Immutable, shared, and all that the loop reads.

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

/// Whether there is a sequence of transitions, from the start and with the ports in their order,
/// that leads somewhere. Of the shapes it looks at what touches what: a region in two parts counts
/// as one.
enum class Reach : std::uint8_t {
  kNo,         ///< none, however long
  kUndecided,  ///< none was found, nor that there is none
  kYes,        ///< one was found
};

/// A region as the loop and the reports see it.
struct Region {
  std::string name;
  int content = -1;  ///< index into Scene::materials(); -1: nothing is felt
  int wall = -1;     ///< own wall's material; -1 where absent (and for outside)
  bool wall_absent = false;
  Reach reach = Reach::kYes;  ///< by ports and absent walls from the start region
  bool reachable = true;      ///< unless reach is kNo
  FieldPtr field;  ///< the layer's whole field (label group share applied); null for outside and
                   ///< for what was left out
  std::string
      left_out;  ///< why the layer was not made: its place belongs to what is around; else empty
  std::string source;        ///< what it was made from; empty if analytic
  Vec3 seed{0.0, 0.0, 0.0};  ///< [m] a point of the region; meaningless unless has_seed
  bool has_seed = false;     ///< false: no point of it was found (an empty or dropped region)
};

class PALPATE_EXPORT Scene {
 public:
  ~Scene();
  Scene(const Scene&) = delete;
  Scene& operator=(const Scene&) = delete;

  [[nodiscard]] std::span<const Region> regions() const noexcept { return regions_; }
  [[nodiscard]] std::span<const Material> materials() const noexcept { return materials_; }
  [[nodiscard]] std::span<const Port> ports() const noexcept { return ports_; }
  /// Whether the port can ever be passed.
  [[nodiscard]] Reach reachOf(PortId port) const { return reach_of_port_[port]; }
  /// True if the two regions were found to have a wall (or an absent one) between them.
  [[nodiscard]] bool touches(RegionId a, RegionId b) const {
    return a != b && touch_[a * regions_.size() + b];
  }
  [[nodiscard]] RegionId startRegion() const noexcept { return start_; }
  [[nodiscard]] bool keepsMemory() const noexcept { return keep_memory_; }
  [[nodiscard]] RendererKind renderer() const noexcept { return renderer_; }
  /// What the renderers' limits are where their settings give none.
  [[nodiscard]] const ForceRequest& forceLimits() const noexcept { return force_; }
  /// For the paper's renderer.
  [[nodiscard]] const PaperParameters& paper() const noexcept { return paper_; }
  [[nodiscard]] const DeviceMapping& device() const noexcept { return device_; }
  [[nodiscard]] const std::string& lengthUnit() const noexcept { return length_unit_; }
  [[nodiscard]] double metersPerUnit() const noexcept { return meters_per_unit_; }
  /// The named fields of the description that were made, with their names, for `query`.
  [[nodiscard]] std::span<const NamedField> fields() const noexcept { return fields_; }

  /// Region at `p` [m]. Allocates a scratch of signs: for set-up, queries and pictures.
  [[nodiscard]] RegionId regionAt(const Vec3& p) const;
  /// Region by name; throws Error (kInput) with a suggestion if there is none.
  [[nodiscard]] RegionId regionNamed(const std::string& name) const;
  /// Box around all bounded layers and sheets [m]; empty if there is none.
  [[nodiscard]] Box3 bounds() const;

  /// Space cut into regions, and what stands between them, for the library's own renderers.
  [[nodiscard]] const Partition& partition() const noexcept { return *partition_; }
  [[nodiscard]] const Passages& passages() const noexcept { return *passages_; }

 private:
  friend class SceneCompiler;
  explicit Scene(Partition partition);

  std::unique_ptr<const Partition> partition_;  ///< never null, as passages_
  std::vector<Region> regions_;
  std::vector<Material> materials_;
  std::unique_ptr<const Passages> passages_;
  std::span<const Port> ports_;  ///< of passages_
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

using ScenePtr = std::shared_ptr<const Scene>;

/// What a scene is compiled for.
enum class Purpose {
  kTouch,  ///< to be felt: what costs work and the probe can certainly not feel is left out
           ///< (Region::left_out)
  kShow,   ///< to be looked at: with all of its layers
};

/// Checks a description against itself and its geometry, makes its fields, and builds the scene. To
/// be touched, a layer that costs work is left out if it lies beyond the device's workspace, or if
/// no way leads into it and nothing that the probe can enter comes near it; ports into it lead
/// nowhere then. Of the others only what lies within the workspace and somewhat beyond is made: 5 %
/// of its diagonal, and as deep as a wall is felt through
/// (`composite`). A probe that presses no deeper than that feels the whole; further off a cut shape
/// goes on as it is at the cut.
/// @throws Error (kInput) pointing at the offending place: unknown layer or material, a port
/// between regions that do not touch, `on` not a leaf of either region, a cycle in `after`, ...
[[nodiscard]] PALPATE_EXPORT ScenePtr compile(const SceneDescription& description,
                                              const Progress& progress = {},
                                              Purpose purpose = Purpose::kTouch);

}  // namespace palpate
