#include "brick/brick_field.h"

namespace palpate::vdb {

BrickField::BrickField(const LevelSet& grid, Sampler sampler, InstructionSet set,
                       const Box3& within)
    : bricks_(grid, sampler, within), view_(bricks_.view()) {
  const BrickKernels kernels = kernelsFor(set);
  const bool cubic = sampler == Sampler::kCubic;
  sample_ = cubic ? kernels.cubic : kernels.linear;
  jet_ = cubic ? kernels.cubic_jet : nullptr;
}

}  // namespace palpate::vdb
