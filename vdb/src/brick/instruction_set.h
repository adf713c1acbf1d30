#pragma once
/// The instruction set that reads bricks: the best that the processor has, chosen once, at set-up.
/// Results of one set are the same everywhere; results of two sets differ by rounding.

#include "brick/brick_view.h"

namespace palpate::vdb {

enum class InstructionSet {
  kBase,    ///< what the compiler may use in any case: SSE2 on x86-64
  kAvx2,    ///< AVX2 and FMA
  kAvx512,  ///< the same, with the 32 registers of AVX-512 (F and VL), still 256 bits wide: wider
            ///< ones were slower
};

/// The best set of this processor, unless the environment variable PALPATE_INSTRUCTION_SET says
/// `base`, `avx2` or `avx512`. @throws Error (kInput) for another word, or for a set that the
/// processor lacks.
[[nodiscard]] InstructionSet chosenInstructionSet();

[[nodiscard]] bool isSupported(InstructionSet set) noexcept;

/// `set` must be supported.
[[nodiscard]] BrickKernels kernelsFor(InstructionSet set) noexcept;

/// The variants that kernelsFor() chooses from.
[[nodiscard]] BrickKernels baseKernels() noexcept;
#if defined(__x86_64__)
[[nodiscard]] BrickKernels avx2Kernels() noexcept;
[[nodiscard]] BrickKernels avx512Kernels() noexcept;
#endif

}  // namespace palpate::vdb
