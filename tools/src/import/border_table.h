#pragma once
/// The wall between two tissues that touch: data/materials/borders.yaml.

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
  kOutside  ///< space without a label outside any body; no tissue has this class
};
inline constexpr std::size_t kTissueClasses = 6;
[[nodiscard]] const char* className(TissueClass of);
[[nodiscard]] std::optional<TissueClass> classNamed(std::string_view name);

struct Border {
  enum class Wall { kNone, kFirst, kSecond, kStiffer };
  Wall wall = Wall::kNone;
  bool ruptures = false;  ///< a port in each direction
  bool lining = false;    ///< if one of the two has a lining, the lining is the wall
};

class BorderTable {
 public:
  /// `wall` refers to the first or the second of the two arguments.
  [[nodiscard]] const Border& between(TissueClass first, TissueClass second) const;
  /// The project's own table. @throws Error (kInput) unless it has every pair exactly once.
  [[nodiscard]] static const BorderTable& own();

 private:
  friend class BorderReader;
  std::array<Border, kTissueClasses * kTissueClasses> borders_;
};

}  // namespace palpate::tools
