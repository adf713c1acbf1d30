#pragma once
/// Keeps damaged files that crash a foreign library from taking this process along.

#include <cstdint>

namespace palpate::vdb {

/// Assimp (glTF, GLB and what else it reads) and GDCM's unpackers (compressed DICOM pixels) are
/// told what files hold in ways that cannot all be checked beforehand, and answer some damage with
/// a crash or without end. In a child process of their own they end alone: readMesh() and
/// readImage() then throw Error (kInput, mesh.unreadable or dicom.pixels). Everything else is read
/// by code that checks each length itself.
struct LibraryLimits {
  bool in_child = false;  ///< the command sets it; a fork() takes some milliseconds
  /// [bytes] that a child may take beyond what this process has; 0: 512 MB and 32 times the file.
  /// Not enforced in builds with the address sanitizer, which reserves terabytes.
  std::uint64_t memory = 0;
  /// [s] of processor time of a child; 0: 15 s and one more for each MB of the file.
  double seconds = 0.0;
};

/// For all reading from now on, by any thread. Not to be called while files are being read. A child
/// is made by fork(): locks that other threads hold stay locked in it, so read while no other
/// thread uses these two libraries.
void setLibraryLimits(const LibraryLimits& limits) noexcept;
[[nodiscard]] LibraryLimits libraryLimits() noexcept;

}  // namespace palpate::vdb
