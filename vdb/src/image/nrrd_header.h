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
  std::vector<std::int64_t> sizes;       ///< of all axes, the fastest first
  std::array<std::size_t, 3> spatial{};  ///< the axes that lie in space
  std::optional<std::size_t> other;      ///< the one that does not, of several entries
  std::string other_kind;                ///< "list", "time", ...; empty: not said
  VoxelCoding coding;
  NrrdEncoding encoding = NrrdEncoding::kRaw;
  std::string data_path;         ///< the header's own file, or the one it names
  std::uint64_t data_begin = 0;  ///< [bytes] in that file, lines that are skipped passed
  std::int64_t byte_skip = 0;    ///< [bytes] of the unpacked data; -1: raw data end the file
  Place place;                   ///< [m], RAS
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

/// @throws Error (kInput, codes "nrrd.*") for what cannot be read or placed in space.
[[nodiscard]] NrrdHeader readNrrdHeader(const std::string& path, const ImageOptions& options);

}  // namespace palpate::vdb
