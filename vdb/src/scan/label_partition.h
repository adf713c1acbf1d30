#pragma once
/// One smooth surface for each of several sets of labels, with one wall between neighbors.

#include <memory>
#include <mutex>
#include <vector>

#include "palpate/core/progress.h"
#include "palpate/vdb/image.h"
#include "scan/band.h"

namespace palpate::vdb {

/// A mask and a band of values around its surface.
struct MaskedBand {
  Mask mask;
  Band band;
};

/// Every layer, and all of them together, is smoothed by itself, u_i, and then takes
///   f_i = (u_i - min over all others of u_j) / 2,
/// what is in no layer being one of the others. Where only two meet u_j is -u_i and f_i is u_i; where more do,
/// the layers share the walls u_i = u_j, and any two have f_i = -f_j there: no gap, no overlap. Layers that
/// have a label in common do not limit each other.
/// Values are about distances, in steps of the image's smallest spacing.
class LabelPartition {
 public:
  /// `image` must outlive it. `layers`: the labels of each.
  LabelPartition(const Image& image, std::vector<std::vector<int>> layers);

  /// The mask is empty if no voxel has one of the layer's labels. Any thread.
  [[nodiscard]] MaskedBand layer(std::size_t index, const Progress& progress);

 private:
  [[nodiscard]] std::shared_ptr<const MaskedBand> smoothed(const std::vector<int>& labels,
                                                           const Progress& progress) const;
  [[nodiscard]] bool haveCommonLabel(std::size_t a, std::size_t b) const;
  [[nodiscard]] std::shared_ptr<const MaskedBand> cached(std::size_t index,
                                                         const Progress& progress);

  const Image& image_;
  std::vector<std::vector<int>> layers_;  ///< sorted; the last: all labels of the others
  std::vector<std::shared_ptr<const MaskedBand>> made_;
  std::mutex mutex_;
};

/// Where the values of a band are known to be near a mask's surface, but not on which side.
inline constexpr float kLeastValue = 1e-3F;

/// Voxels around a mask that its band needs.
inline constexpr int kBandMargin = Band::kReach + 1;

}  // namespace palpate::vdb
