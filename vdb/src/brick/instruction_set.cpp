#include "brick/instruction_set.h"

#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>

#include "palpate/core/error.h"

namespace palpate::vdb {

bool isSupported(InstructionSet set) noexcept {
  if (set == InstructionSet::kBase) return true;
#if defined(__x86_64__)
  return __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
#else
  return false;
#endif
}

InstructionSet chosenInstructionSet() {
  const InstructionSet best =
      isSupported(InstructionSet::kAvx2) ? InstructionSet::kAvx2 : InstructionSet::kBase;
  const char* const asked = std::getenv("PALPATE_INSTRUCTION_SET");
  if (asked == nullptr || *asked == '\0') return best;
  const std::string name = asked;
  if (name == "base") return InstructionSet::kBase;
  if (name != "avx2") {
    throw inputError("bricks.instruction_set", "PALPATE_INSTRUCTION_SET is '" + name + "'",
                     "set it to base or avx2, or unset it");
  }
  if (best != InstructionSet::kAvx2) {
    throw inputError("bricks.instruction_set",
                     "PALPATE_INSTRUCTION_SET is avx2, but this processor has no AVX2 and FMA",
                     "unset it");
  }
  return InstructionSet::kAvx2;
}

BrickKernels kernelsFor(InstructionSet set) noexcept {
#if defined(__x86_64__)
  if (set == InstructionSet::kAvx2) return avx2Kernels();
#endif
  static_cast<void>(set);
  return baseKernels();
}

FieldSample sampleWithoutBrick(const BrickView& view, std::uint32_t entry) noexcept {
  return {entry == BrickView::kInside ? -view.plateau : view.plateau, Vec3(0.0), false};
}

FieldSample sampleBeyond(const BrickView& view, const Vec3& p) noexcept {
  if (!isFinite(p)) return {std::numeric_limits<double>::quiet_NaN(), Vec3(0.0), false};
  const Vec3 last = view.origin + view.extent * view.voxel;
  const Vec3 out = glm::max(glm::max(view.origin - p, p - last), Vec3(0.0));
  // hypot, because squares overflow far away.
  return {view.plateau + std::hypot(out.x, out.y, out.z), Vec3(0.0), false};
}

}  // namespace palpate::vdb
