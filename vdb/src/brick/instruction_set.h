#pragma once
/// Which instructions the bricks are read with: the best that the processor has, chosen once, at
/// set-up. Results of one set are the same everywhere; those of two differ by rounding.

#include "brick/brick_view.h"

namespace palpate::vdb {

enum class InstructionSet {
  kBase,    ///< what the compiler may use anyway: SSE2 on x86-64
  kAvx2,    ///< AVX2 and FMA
  kAvx512,  ///< the same on the 32 registers of AVX-512 (F and VL), of 256 bits still: wider ones
            ///< took longer
};

/// The best of this processor, unless the environment variable PALPATE_INSTRUCTION_SET says `base`,
/// `avx2` or `avx512`. @throws Error (kInput) for another word, or for a set that the processor
/// lacks.
[[nodiscard]] InstructionSet chosenInstructionSet();

[[nodiscard]] bool isSupported(InstructionSet set) noexcept;

/// `set` must be supported.
[[nodiscard]] BrickKernels kernelsFor(InstructionSet set) noexcept;

/// What kernelsFor() chooses from.
[[nodiscard]] BrickKernels baseKernels() noexcept;
#if defined(__x86_64__)
[[nodiscard]] BrickKernels avx2Kernels() noexcept;
[[nodiscard]] BrickKernels avx512Kernels() noexcept;
#endif

}  // namespace palpate::vdb
