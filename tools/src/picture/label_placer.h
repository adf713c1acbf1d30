#pragma once
/// Finds free space for names on a section.

#include <optional>
#include <vector>

#include "picture/section.h"

namespace palpate::tools {

/// Works on cells of a few pixels. Placed labels and marked lines are kept free of later labels.
class LabelPlacer {
 public:
  explicit LabelPlacer(const Section& section);

  /// Keeps labels off a drawn line.
  void markBusy(const std::vector<Pixel>& line);

  /// The middle of a label of this size that lies wholly in `region`, as far from its walls as
  /// possible.
  [[nodiscard]] std::optional<Pixel> placeInside(RegionId region, double width, double height);

  /// The middle of a label near `anchor`, on empty space if there is some nearby.
  [[nodiscard]] std::optional<Pixel> placeNear(const Pixel& anchor, double width, double height);

  /// The innermost point of a region in the section; nothing if the section does not show the
  /// region.
  [[nodiscard]] std::optional<Pixel> innermost(RegionId region) const;

 private:
  [[nodiscard]] std::size_t index(int x, int y) const {
    return static_cast<std::size_t>(x) +
           static_cast<std::size_t>(columns_) * static_cast<std::size_t>(y);
  }
  void measureDepth();
  void take(int x, int y, int w, int h);
  /// Sums `counts` over rectangles of cells.
  template <class Counts>
  [[nodiscard]] std::vector<int> sums(Counts counts) const;
  [[nodiscard]] int sum(const std::vector<int>& table, int x, int y, int w, int h) const;

  int columns_;
  int rows_;
  std::vector<RegionId> region_;
  std::vector<float> depth_;  ///< [cells] distance to another region or to the edge
  std::vector<bool> busy_;
};

}  // namespace palpate::tools
