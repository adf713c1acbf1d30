#pragma once
/// A walk through a .vdb file that checks every length in it before OpenVDB sees any.

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

namespace palpate::vdb {

/// OpenVDB 10 believes what a file says: lengths of texts and of packed chunks go to its
/// allocations and reads as they are, and a damaged one writes past the end of a leaf. This walk
/// reads the same bytes in the same order without building anything: whatever it lets pass, OpenVDB
/// reads within bounds.
///
/// Walked are files of format 222 (OpenVDB 2, 2013) or later, and trees of the standard kind (5, 4,
/// 3) of numbers, vectors, bool and mask.
class VdbWalk {
 public:
  /// `stream` must be seekable, have its exceptions on and stay until the walk ends.
  explicit VdbWalk(std::istream& stream);
  ~VdbWalk();
  VdbWalk(const VdbWalk&) = delete;
  VdbWalk& operator=(const VdbWalk&) = delete;

  /// From the start of the file: the header, and every grid's name, metadata and transform; of
  /// files that are read in order only, their trees too. Leaves the stream at its start.
  /// @throws std::runtime_error with what makes no sense, std::ios_base::failure where the file
  /// ends early.
  void checkHeads();

  /// The tree of the grid whose head begins at byte `grid_position`, and is of `grid_type`
  /// ("Tree_float_5_4_3"); without its voxels only the tree's shape. Leaves the stream where it
  /// was. @throws as checkHeads().
  void checkTree(std::int64_t grid_position, const std::string& grid_type, bool is_half,
                 bool with_voxels);

  /// True if trees of that type can be walked.
  [[nodiscard]] static bool canWalk(const std::string& grid_type);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::vdb
