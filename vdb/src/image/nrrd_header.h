#pragma once
/// A NRRD header, checked.

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "image/place.h"
#include "image/voxels.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {

enum class NrrdEncoding { kRaw, kGzip, kText };

struct NrrdHeader {
  std::vector<std::int64_t> sizes;       ///< for all axes, the fastest first
  std::array<std::size_t, 3> spatial{};  ///< the spatial axes
  std::optional<std::size_t> other;  ///< the axis that is not spatial, if it has several entries
  std::string other_kind;            ///< "list", "time", ...; empty: not stated
  VoxelCoding coding;
  NrrdEncoding encoding = NrrdEncoding::kRaw;
  std::string data_path;         ///< the header's own file, or the one that it names
  std::uint64_t data_begin = 0;  ///< [bytes] in that file, after the lines to skip
  /// [bytes] Of the unpacked data to skip; -1: raw data are the last of the file
  std::int64_t byte_skip = 0;
  Place place;  ///< [m], RAS
  std::string length_unit;
  std::map<std::string, std::string> pairs;  ///< `key:=value` lines
  std::vector<std::string> notes;

  [[nodiscard]] std::array<int, 3> size() const noexcept {
    return {static_cast<int>(sizes[spatial[0]]), static_cast<int>(sizes[spatial[1]]),
            static_cast<int>(sizes[spatial[2]])};
  }
  [[nodiscard]] std::uint64_t count() const noexcept {
    std::uint64_t product = 1;
    for (const std::int64_t n : sizes) product *= static_cast<std::uint64_t>(n);
    return product;
  }
};

/// @throws Error (kInput, codes "nrrd.*") if the file cannot be read or placed in space.
[[nodiscard]] NrrdHeader readNrrdHeader(const std::string& path, const ImageOptions& options);

}  // namespace palpate::vdb
