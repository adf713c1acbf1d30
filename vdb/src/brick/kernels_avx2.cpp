// The kernels for processors with AVX2 and FMA (2013 and later).

#define PALPATE_TARGET "avx2,fma"
#define PALPATE_KERNELS avx2Kernels
#include "brick/kernels_x86.h"
