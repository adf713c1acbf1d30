#pragma once
/// A scanned body as regions, and the scene file that is made from them.

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "import/region_plan.h"
#include "palpate/vdb/label_survey.h"

namespace palpate::tools {

/// Labels of air that reach the image's border: they are outside, not regions.
struct OpenAir {
  std::string name;
  std::vector<int> labels;
  std::string why;
  std::uint64_t voxels = 0;
  double volume = 0.0;  ///< [m3]
};

/// A way to touch the scene that its header suggests.
struct SuggestedWay {
  std::string what;  ///< "from the front to the middle"
  Vec3 from{0.0};    ///< [m]
  Vec3 to{0.0};      ///< [m]
};

/// A hole that the user wanted drilled through bone.
struct BurrHole {
  Vec3 outer{0.0}, inner{0.0};  ///< [m] ends of its axis
  double radius = 0.0;          ///< [m]
  int label = 0;                ///< of its voxels
  std::uint64_t voxels = 0;
  std::string through;  ///< names of the regions, with commas
};

/// Everything that the scene is written from.
struct ImportedScan {
  vdb::Image labels;
  vdb::NameTable names;
  std::map<int, std::uint64_t> counts;  ///< voxels of each label before changes, and of a burr hole
  RegionPlan plan;
  std::vector<OpenAir> open_air;
  vdb::LabelSurvey survey;  ///< for the plan's regions
  bool has_body = false;
  vdb::VoxelMask body;                     ///< the voxels of the body; empty without one
  std::optional<SuggestedWay> way;         ///< not given: the best of six ways is chosen
  std::vector<int> body_labels;            ///< the labels of its mask, if it comes from a mask
  std::uint64_t image_voxels = 0;          ///< of all images that the scene reads
  std::uint64_t ct_voxels = 0;             ///< of the image that stiffness comes from; 0: none
  double voxel = 0.0;                      ///< [m] of the grids
  std::vector<vdb::IslandChange> changes;  ///< changes made to the labels
  std::optional<BurrHole> burr_hole;
  bool is_relabeled = false;  ///< the labels were made of models

  /// Whether the labels differ from those of the file, so that they are written to a new file.
  [[nodiscard]] bool isChanged(const ImportOptions& options) const {
    return options.min_island.has_value() || burr_hole.has_value() || is_relabeled;
  }
  [[nodiscard]] std::string nameOf(std::size_t region) const;
  /// The neighbors of a region, with their shares of the region's surface, the largest first; parts
  /// cut by the image's border have no known neighbor.
  [[nodiscard]] std::vector<std::pair<std::string, double>> neighborsOf(std::size_t region) const;
};

/// Formats a volume given in [m3].
[[nodiscard]] std::string cubicCentimeters(double volume);

/// Estimate of a grid's active voxels, before it is made. `area` [m2] of the surface, `volume` [m3]
/// inside, `voxel` [m].
[[nodiscard]] double estimateVoxels(double area, double volume, double voxel);

/// [s] Estimate of the processor time until the first tick of `palpate touch`. Of the
/// `active_voxels` in `grids`, `to_make` are to be made, and the others were kept before.
[[nodiscard]] double estimateSeconds(std::size_t grids, double active_voxels, double to_make);

/// The tissues of all regions, those of a body first, and of their linings; each once.
/// @throws Error (kInput) as requireTissue().
[[nodiscard]] std::vector<const Tissue*> tissuesOf(const ImportedScan& scan,
                                                   const TissueTable& tissues);

/// [bytes] Estimate of the largest memory of `palpate touch` at any time.
[[nodiscard]] double estimateMemory(const ImportedScan& scan, const TissueTable& tissues,
                                    double active_voxels);

/// File names as the scene uses them.
struct SceneFiles {
  std::vector<std::string> labels;  ///< one image, or masks
  std::string names;                ///< may be empty
  std::string body;                 ///< mask, or the image with `skin`; empty: no body
  std::string image;                ///< with gray values; may be empty
};
[[nodiscard]] std::string writeScene(const ImportOptions& options, const ImportedScan& scan,
                                     const TissueTable& tissues, const SceneFiles& files);

/// @throws Error (kInput) if the table has no tissue of this name, which a body needs.
[[nodiscard]] const Tissue& requireTissue(const TissueTable& tissues, const std::string& name);

}  // namespace palpate::tools
