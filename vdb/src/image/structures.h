#pragma once
/// Puts structures that were segmented one by one together into one label image.

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "palpate/vdb/image.h"

namespace palpate::vdb {

/// Voxels `begin` to before `end` of a volume.
struct VoxelRun {
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// The voxels of one structure as runs along i, which takes little memory: most neighbors along i
/// belong to the same structure.
struct Structure {
  std::string name;
  int label = 0;  ///< from 1
  std::vector<VoxelRun> runs;
  std::uint64_t voxels = 0;

  /// Adds voxels; they must come in order, each once.
  void add(std::uint64_t begin, std::uint64_t end) {
    if (!runs.empty() && runs.back().end == begin) {
      runs.back().end = end;
    } else {
      runs.push_back({begin, end});
    }
    voxels += end - begin;
  }
};

/// Counts how many voxels of each structure went to another one.
class Overlaps {
 public:
  /// Records that `voxels` voxels of `loser` went to `winner`.
  void add(int winner, int loser, std::uint64_t voxels) { pairs_[{winner, loser}] += voxels; }
  /// Adds one note on all shared voxels, if there are any. `voxels`: their number; `rule`: which
  /// structure gets them; `voxel_volume` [m3].
  void tell(std::uint64_t voxels, const std::string& rule, const NameTable& names,
            double voxel_volume, std::vector<std::string>& notes) const;

 private:
  std::map<std::pair<int, int>, std::uint64_t> pairs_;
};

/// Label values of an image of `image.size`. Where structures overlap, the one that `priority`
/// names first gets the voxel; otherwise the one with fewer voxels, and of equal ones the later.
/// `what`: "masks", for the note on shared voxels. That note goes to `image.notes`, as does one on
/// structures without voxels.
/// @throws Error (kInput, labels.priority) for a name that no structure has.
[[nodiscard]] std::vector<float> mergeStructures(const std::vector<Structure>& structures,
                                                 const std::string& what,
                                                 const std::vector<std::string>& priority,
                                                 Image& image);

}  // namespace palpate::vdb
