#pragma once
/// GraySlices: a scan's gray values on planes across the axes, as small pictures for a page.

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "palpate/vdb/image.h"
#include "report.h"

namespace palpate::tools {

/// Keeps a lattice of shades in place of the scan. Its memory, and the time that a request takes,
/// do not grow with the scan.
class GraySlices {
 public:
  static constexpr int kLongest = 256;  ///< points along the lattice's longest side, at most

  /// Covers the part of `image` within `view`, as densely as its voxels do, or as kLongest allows.
  /// Asks `is_wanted` now and then; once that returns false, the rest stays empty.
  GraySlices(const std::shared_ptr<const vdb::Image>& image, const Box3& view,
             const std::function<bool()>& is_wanted);

  /// Whether no point of the lattice has a shade.
  [[nodiscard]] bool isEmpty() const noexcept { return shades_.empty(); }
  /// For a page: the file, the box that the slices fill, and how many there are across each axis.
  [[nodiscard]] Json json() const;
  /// Slice `index` across `axis`; nothing if there is none. Little-endian: "PSLC", width and height
  /// (uint32), and a byte for each point, beginning with the lowest row: 0 for no value, else from
  /// 1, black, to 255. Across x the width runs along y and the height along z; across y, along x
  /// and z; across z, along x and y.
  [[nodiscard]] std::optional<std::string> slice(std::size_t axis, std::size_t index) const;

 private:
  using Index = std::array<std::size_t, 3>;

  [[nodiscard]] std::size_t at(const Index& i) const {
    return i[0] + size_[0] * (i[1] + size_[1] * i[2]);
  }

  std::string source_;
  Box3 box_;           ///< [m] made of one cubic cell around each point of the lattice
  double step_ = 0.0;  ///< [m] from point to point
  Index size_{};
  std::vector<std::uint8_t> shades_;
};

}  // namespace palpate::tools
