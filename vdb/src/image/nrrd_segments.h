#pragma once
/// Segments of a .seg.nrrd file: names, colors, and which voxels are whose.

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
  int number = 0;  ///< N of its keys SegmentN_...
  std::string name;
  int stored = 1;  ///< value of its voxels in its layer
  int layer = 0;
  int label = 1;  ///< value of its voxels in the image that is handed out
  std::optional<LabelColor> color;
  std::optional<LabelCode> code;
  std::optional<std::array<int, 6>> extent;  ///< [voxels] first and last along i, j, k
};

class Segments {
 public:
  /// From the header's key/value pairs. A segment keeps its label value unless one before it has
  /// the same (in another layer); then it gets the smallest above all. @throws Error (kInput,
  /// nrrd.segment).
  Segments(const std::map<std::string, std::string>& pairs, int layers, std::string path);

  [[nodiscard]] bool empty() const noexcept { return segments_.empty(); }
  [[nodiscard]] LabelTable table() const;
  [[nodiscard]] LabelCodes codes() const;
  /// What was done to label values.
  [[nodiscard]] const std::vector<std::string>& notes() const noexcept { return notes_; }

  /// One label image out of the layers, each of `size`. Where segments overlap, the later one in
  /// the file has the voxel; a note says how much that is. `voxel_volume` [m3].
  /// @throws Error (kInput, nrrd.segment, nrrd.segment_extent).
  [[nodiscard]] std::vector<float> merged(const std::vector<std::vector<float>>& layers,
                                          const std::array<int, 3>& size, double voxel_volume,
                                          std::vector<std::string>& notes) const;

 private:
  [[nodiscard]] Error fail(const char* code, std::string message, std::string hint = {}) const;
  void readOne(const std::map<std::string, std::string>& pairs, int number, int layers);
  void numberLabels();

  std::vector<Segment> segments_;  ///< by number
  std::vector<std::string> notes_;
  std::string path_;
};

}  // namespace palpate::vdb
