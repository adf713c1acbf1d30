#include "brick/brick_field.h"

namespace palpate::vdb {

BrickField::BrickField(const LevelSet& grid, Sampler sampler, InstructionSet set)
    : bricks_(grid, sampler), view_(bricks_.view()) {
  const BrickKernels kernels = kernelsFor(set);
  const bool cubic = sampler == Sampler::kCubic;
  sample_ = cubic ? kernels.cubic : kernels.linear;
  jet_ = cubic ? kernels.cubic_jet : nullptr;
}

}  // namespace palpate::vdb
