#pragma once
/// One smooth surface for each of several sets of labels, with one wall between neighbors.

#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <utility>
#include <vector>

#include "palpate/core/progress.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/scan_surface.h"
#include "scan/band.h"

namespace palpate::vdb {

/// A mask and a band of values around its surface.
struct MaskedBand {
  Mask mask;
  Band band;
  /// For lapped layers: voxels of other layers, which the mask may or may not hold. Otherwise
  /// empty.
  Mask neighbors = {};
  double excess = 0.0;  ///< [voxels] how much more volume the surface encloses than the mask has
  /// [steps] For lapped layers and layers without neighbors, by block: the value at which the
  /// layers that meet at a voxel part. The layer's own centers lie below it, all others above.
  /// Otherwise empty.
  std::vector<BandBlock::Values> parting = {};
};

/// Each layer, and all of them together, is smoothed by itself, which gives u_i and u_all. Then
/// each layer takes
///   f_i = (u_i - min over all others of u_j) / 2.
/// The space in no layer, u_0 = -u_all, is one of the others. Edges where three layers meet would
/// cost small layers some volume; so from each u_i except u_0 a number is subtracted that brings
/// f_i halfway back to the volume of its voxels. Where only two meet, u_j is -u_i and f_i is u_i;
/// where more meet, the layers share the walls u_i = u_j, where any two have f_i = -f_j: no gap, no
/// overlap. But a grid rounds off edges, and walls that meet form edges: there grids of f_i leave
/// gaps.
///
/// Lapped layers cover these gaps. They reach into each other, but not into the space in no layer:
///   e_i = max(min((u_i + u_all) / 2, u_all + groove), (u_i - min over the other layers of u_j) / 2
///   - lap)
/// The wall between two of them is where e_i = e_j, which is where u_i = u_j; and wherever u_all is
/// below -groove, at least one of them is negative. Far from other layers e_i equals f_i.
///
/// Subtracting a number from a layer's values moves no voxel's center to another side, and centers
/// keep a small distance from the walls between layers, so that each center is in its own layer.
///
/// Layers that have a label in common do not limit each other. Values are approximately distances,
/// in steps of the image's smallest spacing.
class LabelPartition {
 public:
  /// `image` must outlive it. `layers`: the labels of each.
  LabelPartition(const Image& image, std::vector<std::vector<int>> layers);

  /// The surface of a layer. The mask is empty if no voxel has one of its labels. Callable from any
  /// thread.
  [[nodiscard]] MaskedBand layer(std::size_t index, LabelEdge edge, const Progress& progress);

  /// -f_0: all layers together; nothing if no voxels of two layers lie beside each other. Callable
  /// from any thread.
  [[nodiscard]] std::optional<MaskedBand> unite(const Progress& progress);

 private:
  using Labels = std::vector<int>;  ///< sorted

  [[nodiscard]] std::shared_ptr<const MaskedBand> smoothed(const Labels& labels,
                                                           const Progress& progress) const;
  [[nodiscard]] const MaskedBand& cached(const Labels& labels, const Progress& progress);
  /// The layers that come near this one and have no label in common with it.
  [[nodiscard]] std::vector<std::size_t> neighborsOf(std::size_t index, const Progress& progress);

  /// The layers near one, the union of all including it, and the numbers subtracted from their
  /// values.
  struct Limits {
    const MaskedBand* whole = nullptr;
    std::vector<std::pair<const MaskedBand*, float>> others;

    /// The smallest of the other layers' values at an index of the image; NaN: none is near.
    [[nodiscard]] float leastAt(int x, int y, int z) const noexcept;
  };
  [[nodiscard]] Limits limitsOf(std::size_t index, const std::vector<std::size_t>& neighbors,
                                const Progress& progress);
  /// [steps] The number subtracted from a layer's own values.
  [[nodiscard]] float shiftOf(std::size_t index, const Progress& progress);

  const Image& image_;
  std::vector<Labels> layers_;
  std::map<Labels, std::shared_ptr<const MaskedBand>> made_;
  std::vector<std::optional<float>> shifts_;  ///< for each layer
  std::mutex mutex_;
};

/// Size of values that are near a mask's surface but whose side was not known.
inline constexpr float kLeastValue = 1e-3F;

/// Margin of voxels around a mask that its band needs.
inline constexpr int kBandMargin = Band::kReach + 1;

}  // namespace palpate::vdb
