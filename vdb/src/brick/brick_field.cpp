#include "brick/brick_field.h"

namespace palpate::vdb {

BrickField::BrickField(const LevelSet& grid, Sampler sampler, InstructionSet set,
                       const Box3& within)
    : BrickField(grid, sampler, set, within, 0) {}

BrickField::BrickField(const LevelSet& grid, Sampler sampler, InstructionSet set,
                       const Box3& within, std::uint64_t max_memory)
    : bricks_(grid, sampler, within, max_memory), view_(bricks_.view()) {
  const BrickKernels kernels = kernelsFor(set);
  const bool cubic = sampler == Sampler::kCubic;
  sample_ = cubic ? kernels.cubic : kernels.linear;
  jet_ = cubic ? kernels.cubic_jet : nullptr;
}

}  // namespace palpate::vdb
