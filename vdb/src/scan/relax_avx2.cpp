// Compiled for processors with AVX2; called where they are.
#include "scan/relax.h"

#if defined(__AVX2__)

#include "scan/relax_kernel.h"

namespace palpate::vdb {

void hessianForceAvx2(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                      float* out) noexcept {
  hessianForceOf(patch, rows, weights, out);
}

void diffuseAvx2(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                 float* out) noexcept {
  diffuseOf(patch, rows, stride, share, out);
}

}  // namespace palpate::vdb

#else

namespace palpate::vdb {

void hessianForceAvx2(const Patch& patch, std::uint64_t rows, const RelaxWeights& weights,
                      float* out) noexcept {
  hessianForcePlain(patch, rows, weights, out);
}

void diffuseAvx2(const Patch& patch, std::uint64_t rows, int stride, const float* share,
                 float* out) noexcept {
  diffusePlain(patch, rows, stride, share, out);
}

}  // namespace palpate::vdb

#endif
