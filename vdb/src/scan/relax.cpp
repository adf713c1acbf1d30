#include "scan/relax.h"

#include "brick/instruction_set.h"
#include "scan/relax_kernel.h"

namespace palpate::vdb {
namespace {

bool useAvx2() noexcept {
  static const bool use = isSupported(InstructionSet::kAvx2);
  return use;
}

}  // namespace

void hessianForce(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                  float* out) noexcept {
  (useAvx2() ? hessianForceAvx2 : hessianForcePlain)(patch, rows, weights, out);
}

void diffuse(const Patch& patch, std::uint64_t rows, int stride, const float* share,
             float* out) noexcept {
  (useAvx2() ? diffuseAvx2 : diffusePlain)(patch, rows, stride, share, out);
}

void hessianForcePlain(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                       float* out) noexcept {
  hessianForceOf(patch, rows, weights, out);
}

void diffusePlain(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                  float* out) noexcept {
  diffuseOf(patch, rows, stride, share, out);
}

}  // namespace palpate::vdb
