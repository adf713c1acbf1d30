#pragma once
/// What stands between two tissues that touch: data/materials/borders.yaml.

#include <array>
#include <cstddef>
#include <optional>
#include <string_view>

namespace palpate::tools {

enum class TissueClass {
  kRigid,
  kSolid,
  kMembrane,
  kFluid,
  kGas,
  kOutside  ///< what has no label and is in no body; no tissue has it
};
inline constexpr std::size_t kTissueClasses = 6;
[[nodiscard]] const char* className(TissueClass of);
[[nodiscard]] std::optional<TissueClass> classNamed(std::string_view name);

struct Border {
  enum class Wall { kNone, kFirst, kSecond, kStiffer };
  Wall wall = Wall::kNone;
  bool ruptures = false;  ///< a port each way
  bool lining = false;    ///< the lining of either, if it has one, is there instead
};

class BorderTable {
 public:
  /// `wall` names the first or second of these two.
  [[nodiscard]] const Border& between(TissueClass first, TissueClass second) const;
  /// The project's own. @throws Error (kInput) if it does not have every pair once.
  [[nodiscard]] static const BorderTable& own();

 private:
  friend class BorderReader;
  std::array<Border, kTissueClasses * kTissueClasses> borders_;
};

}  // namespace palpate::tools
