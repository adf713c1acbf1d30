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

/// Keeps a lattice of shades in place of the scan: neither its memory nor the time of a request
/// grows with the scan.
class GraySlices {
 public:
  static constexpr int kLongest = 256;  ///< points along the lattice's longest side, at most

  /// Of the part of `image` within `view`, as dense as its voxels are, or as kLongest allows.
  /// `is_wanted` is asked now and then; once it says no, the rest is left empty.
  GraySlices(const std::shared_ptr<const vdb::Image>& image, const Box3& view,
             const std::function<bool()>& is_wanted);

  /// Whether nothing of the scan has a shade there.
  [[nodiscard]] bool isEmpty() const noexcept { return shades_.empty(); }
  /// For a page: the file, the box that the slices fill, and how many there are across each axis.
  [[nodiscard]] Json json() const;
  /// Slice `index` across `axis`: little-endian, "PSLC", width and height (uint32), and a byte for
  /// each point, those of the lowest height first: 0 without a value, else from 1, black, to 255.
  /// Across x the width runs along y and the height along z, across y along x and z, across z along
  /// x and y. None: there is no such slice.
  [[nodiscard]] std::optional<std::string> slice(std::size_t axis, std::size_t index) const;

 private:
  using Index = std::array<std::size_t, 3>;

  [[nodiscard]] std::size_t at(const Index& i) const {
    return i[0] + size_[0] * (i[1] + size_[1] * i[2]);
  }

  std::string source_;
  Box3 box_;           ///< [m] a cell of the lattice around each of its points
  double step_ = 0.0;  ///< [m] from point to point
  Index size_{};
  std::vector<std::uint8_t> shades_;
};

}  // namespace palpate::tools
