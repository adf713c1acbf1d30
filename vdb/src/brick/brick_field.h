#pragma once
/// A field that reads bricks. Can be included without OpenVDB, for benchmarks.

#include "brick/bricks.h"
#include "brick/instruction_set.h"

namespace palpate::vdb {

/// The class is final and its members are inline: for a caller that knows the type, a query costs
/// one call through a pointer, to the kernel of the instruction set.
class BrickField final : public Field {
 public:
  /// `sampler` is kCubic or kTrilinear. The grid is taken as it is, not widened. Must not be
  /// queried outside the box `within` [m].
  explicit BrickField(const LevelSet& grid, Sampler sampler = Sampler::kCubic,
                      InstructionSet set = chosenInstructionSet(),
                      const Box3& within = Box3::everything());
  /// @throws Error (kOperation) if the bricks would take more than `max_memory` [bytes]; 0: no
  /// limit.
  BrickField(const LevelSet& grid, Sampler sampler, InstructionSet set, const Box3& within,
             std::uint64_t max_memory);

  [[nodiscard]] FieldSample sample(const Vec3& p) const noexcept override {
    return sample_(view_, p);
  }
  /// Trilinear: within a cell the Hessian has a zero diagonal, so that it is taken by finite
  /// differences across cells.
  [[nodiscard]] FieldJet jet(const Vec3& p) const noexcept override {
    return jet_ != nullptr ? jet_(view_, p) : Field::jet(p);
  }
  [[nodiscard]] Box3 bounds() const noexcept override { return bricks_.bounds(); }
  [[nodiscard]] Metric metric() const noexcept override { return Metric::kImplicit; }
  [[nodiscard]] double lipschitz() const noexcept override { return bricks_.lipschitz(); }
  [[nodiscard]] double featureSize() const noexcept override { return view_.voxel; }

  [[nodiscard]] const Bricks& bricks() const noexcept { return bricks_; }

 private:
  Bricks bricks_;
  BrickView view_;  ///< next to the pointers, so that a query finds both in one place
  BrickKernels::Sample sample_;
  BrickKernels::Jet jet_;
};

}  // namespace palpate::vdb
