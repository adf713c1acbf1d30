#pragma once
/// Structures that were segmented one by one, put together into one label image.

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

/// One structure, in little memory: few of its voxels have a neighbor along i that is not its own.
struct Structure {
  std::string name;
  int label = 0;  ///< from 1
  std::vector<VoxelRun> runs;
  std::uint64_t voxels = 0;

  /// Voxels that come in their order, each once.
  void add(std::uint64_t begin, std::uint64_t end) {
    if (!runs.empty() && runs.back().end == begin) {
      runs.back().end = end;
    } else {
      runs.push_back({begin, end});
    }
    voxels += end - begin;
  }
};

/// How much of which structure went to which other one.
class Overlaps {
 public:
  /// So many voxels of `loser` are `winner`'s.
  void add(int winner, int loser, std::uint64_t voxels) { pairs_[{winner, loser}] += voxels; }
  /// One note on all shared voxels, if there are any. `voxels`: their number; `rule`: who has them;
  /// `voxel_volume` [m3].
  void tell(std::uint64_t voxels, const std::string& rule, const NameTable& names,
            double voxel_volume, std::vector<std::string>& notes) const;

 private:
  std::map<std::pair<int, int>, std::uint64_t> pairs_;
};

/// Label values of an image of `image.size`. Where structures overlap, the one that `priority`
/// names first has the voxel; else the one of fewer voxels, of equal ones the later. `what`:
/// "masks", for the note on shared voxels, which goes to `image.notes` as one on structures without
/// voxels does.
/// @throws Error (kInput, labels.priority) for a name that no structure has.
[[nodiscard]] std::vector<float> mergeStructures(const std::vector<Structure>& structures,
                                                 const std::string& what,
                                                 const std::vector<std::string>& priority,
                                                 Image& image);

}  // namespace palpate::vdb
