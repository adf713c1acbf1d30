#pragma once
/// Walks through a .vdb file and checks every length in it before OpenVDB reads it.

#include <cstdint>
#include <iosfwd>
#include <memory>
#include <string>

namespace palpate::vdb {

/// OpenVDB 10 trusts a file: it uses lengths of texts and of packed chunks unchecked for
/// allocations and reads, and a wrong one makes it write past the end of a leaf. This walk reads
/// the same bytes in the same order without building anything: a file that passes it is read by
/// OpenVDB within bounds.
///
/// Supported are files of format 222 (OpenVDB 2, 2013) or later, with standard trees (5, 4, 3) of
/// numbers, vectors, bool and mask.
class VdbWalk {
 public:
  /// `stream` must be seekable, have its exceptions on and stay until the walk ends.
  explicit VdbWalk(std::istream& stream);
  ~VdbWalk();
  VdbWalk(const VdbWalk&) = delete;
  VdbWalk& operator=(const VdbWalk&) = delete;

  /// Reads the file from its start: checks the header, every grid's name, metadata and transform;
  /// if the file can only be read in order, the trees too. Leaves the stream at its start.
  /// @throws std::runtime_error saying what is inconsistent, std::ios_base::failure where the file
  /// ends early.
  void checkHeads();

  /// Checks the tree of the grid whose header begins at byte `grid_position`, and which has the
  /// type `grid_type` ("Tree_float_5_4_3"); without voxels only the tree's topology. Leaves the
  /// stream where it was. @throws as checkHeads().
  void checkTree(std::int64_t grid_position, const std::string& grid_type, bool is_half,
                 bool with_voxels);

  /// True if trees of that type can be walked.
  [[nodiscard]] static bool canWalk(const std::string& grid_type);

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace palpate::vdb
