#pragma once
/// Segments of a .seg.nrrd file: names, colors, and the voxels of each.

#include <array>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"
#include "palpate/vdb/label_codes.h"

namespace palpate::vdb {

struct Segment {
  int number = 0;  ///< the number N of its keys SegmentN_...
  std::string name;
  int stored = 1;  ///< value of its voxels in its layer of the file
  int layer = 0;
  int label = 1;  ///< value of its voxels in the image that is returned
  std::optional<LabelColor> color;
  std::optional<LabelCode> code;
  std::optional<std::array<int, 6>> extent;  ///< [voxels] first and last along i, j, k
};

class Segments {
 public:
  /// Reads the header's key/value pairs. A segment keeps its label value unless an earlier one has
  /// the same (in another layer); then it gets the smallest value above all others. @throws Error
  /// (kInput, nrrd.segment).
  Segments(const std::map<std::string, std::string>& pairs, int layers, std::string path);

  [[nodiscard]] bool empty() const noexcept { return segments_.empty(); }
  [[nodiscard]] LabelTable table() const;
  [[nodiscard]] LabelCodes codes() const;
  /// Notes on label values that were changed.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// Merges the layers, each of `size`, into one label image. Where segments overlap, the later one
  /// in the file gets the voxel; a note says how many voxels that concerns. `voxel_volume` [m3].
  [[nodiscard]] std::vector<float> merged(const std::vector<std::vector<float>>& layers,
                                          const std::array<int, 3>& size, double voxel_volume,
                                          std::vector<std::string>& notes) const;

 private:
  [[nodiscard]] Error fail(const char* code, std::string message, std::string hint = {}) const;
  void readOne(const std::map<std::string, std::string>& pairs, int number, int layers);
  void numberLabels();

  std::vector<Segment> segments_;  ///< sorted by number
  std::vector<std::string> notes_;
  std::string path_;
};

}  // namespace palpate::vdb
