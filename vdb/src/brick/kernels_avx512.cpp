// The kernels for processors with AVX-512 F and VL: four lanes as with AVX2, in twice the registers.

#define PALPATE_TARGET "avx2,fma,avx512f,avx512vl"
#define PALPATE_KERNELS avx512Kernels
#include "brick/kernels_x86.h"
