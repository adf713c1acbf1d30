#pragma once
/// Bricks: a level set compiled for the loop. See README.md, "Samplers".

#include <cstdint>
#include <memory>
#include <vector>

#include "brick/band_bounds.h"
#include "brick/brick_view.h"
#include "palpate/vdb/level_set.h"

namespace palpate::vdb {

/// Owns the memory that a BrickView refers to. Can be moved, and never changes after it is made;
/// any number of threads may read.
class Bricks {
 public:
  /// Copies `grid`, in parallel. `sampler` is kCubic or kTrilinear. The band is taken as it is:
  /// with one that is too narrow no cell is known. Samples are right within the box `within` [m]
  /// only.
  /// @throws Error (kOperation) if the bricks would take more than `max_memory` [bytes]; 0: no
  /// limit.
  Bricks(const LevelSet& grid, Sampler sampler, const Box3& within = Box3::everything(),
         std::uint64_t max_memory = 0);

  [[nodiscard]] const BrickView& view() const noexcept { return view_; }
  [[nodiscard]] std::size_t count() const noexcept { return count_; }
  [[nodiscard]] std::uint64_t memory() const noexcept;  ///< [bytes]
  /// [-] Bound of the slope of the sampled function, everywhere.
  [[nodiscard]] double lipschitz() const noexcept { return lipschitz_; }
  /// [m] Contains every point with a negative value.
  [[nodiscard]] const Box3& bounds() const noexcept { return bounds_; }

 private:
  struct Release {
    void operator()(std::byte* memory) const noexcept;
  };

  std::unique_ptr<std::byte, Release> bricks_;
  std::vector<std::uint32_t> blocks_;
  std::vector<std::uint32_t> coarse_;
  BrickView view_;
  std::size_t count_ = 0;
  double lipschitz_ = 1.0;
  Box3 bounds_;
};

/// Properties that the bricks of `grid` would have, found without keeping the bricks.
struct BrickSurvey {
  BandBounds bounds;
  double lipschitz = 1.0;  ///< as Bricks::lipschitz()
};
/// Computes a sharper bound, which takes longer, if BandBounds::within() is below `least_within`
/// [voxels] by slopes alone.
[[nodiscard]] BrickSurvey surveyBricks(const LevelSet& grid, Sampler sampler,
                                       double least_within = 0.0);

}  // namespace palpate::vdb
