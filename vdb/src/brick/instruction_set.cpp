#include "brick/instruction_set.h"

#include <array>
#include <cmath>
#include <cstdlib>
#include <limits>
#include <string>
#include <string_view>
#include <utility>

#include "palpate/core/error.h"

namespace palpate::vdb {

bool isSupported(InstructionSet set) noexcept {
#if defined(__x86_64__)
  const bool avx2 = __builtin_cpu_supports("avx2") != 0 && __builtin_cpu_supports("fma") != 0;
  const bool avx512 =
      __builtin_cpu_supports("avx512f") != 0 && __builtin_cpu_supports("avx512vl") != 0;
#else
  constexpr bool avx2 = false;
  constexpr bool avx512 = false;
#endif
  switch (set) {
    case InstructionSet::kBase:
      return true;
    case InstructionSet::kAvx2:
      return avx2;
    case InstructionSet::kAvx512:
      return avx2 && avx512;
  }
  return false;
}

InstructionSet chosenInstructionSet() {
  constexpr std::array kNamed{std::pair{"base", InstructionSet::kBase},
                              std::pair{"avx2", InstructionSet::kAvx2},
                              std::pair{"avx512", InstructionSet::kAvx512}};
  const char* const asked = std::getenv("PALPATE_INSTRUCTION_SET");
  if (asked == nullptr || *asked == '\0') {
    for (const InstructionSet set : {InstructionSet::kAvx512, InstructionSet::kAvx2}) {
      if (isSupported(set)) return set;
    }
    return InstructionSet::kBase;
  }
  for (const auto& [name, set] : kNamed) {
    if (std::string_view(asked) != name) continue;
    if (isSupported(set)) return set;
    throw inputError("bricks.instruction_set",
                     std::string("PALPATE_INSTRUCTION_SET is ") + name +
                         ", but this processor does not have those instructions",
                     "unset it");
  }
  throw inputError("bricks.instruction_set",
                   std::string("PALPATE_INSTRUCTION_SET is '") + asked + "'",
                   "set it to base, avx2 or avx512, or unset it");
}

BrickKernels kernelsFor(InstructionSet set) noexcept {
#if defined(__x86_64__)
  if (set == InstructionSet::kAvx512) return avx512Kernels();
  if (set == InstructionSet::kAvx2) return avx2Kernels();
#endif
  static_cast<void>(set);
  return baseKernels();
}

FieldSample sampleWithoutBrick(const BrickView& view, std::uint32_t entry, const Vec3& p) noexcept {
  if (entry != BrickView::kBeyond) {
    return {entry == BrickView::kInside ? -view.plateau : view.plateau, Vec3(0.0), false};
  }
  if (!isFinite(p)) return {std::numeric_limits<double>::quiet_NaN(), Vec3(0.0), false};
  const Vec3 last = view.origin + view.voxel * Vec3(view.size[0], view.size[1], view.size[2]);
  const Vec3 out = glm::max(glm::max(view.origin - p, p - last), Vec3(0.0));
  // hypot, because squares overflow for far points.
  return {view.plateau + std::hypot(out.x, out.y, out.z), Vec3(0.0), false};
}

}  // namespace palpate::vdb
