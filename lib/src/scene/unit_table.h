#pragma once
/// Facts on units that the scene reader needs beyond palpate/scene/units.h.

#include <string_view>
#include <vector>

#include "palpate/scene/units.h"

namespace palpate {

/// Converts `value`, in units of `factor`, to SI. It divides if the factor is one over a whole
/// number: 1/1000 is not a binary fraction, but 35/1000 rounds only once, to the same number as
/// 0.035 written in SI.
[[nodiscard]] double scaledTo(double value, double factor) noexcept;

/// Every spelling of a unit of `dimension`, the SI unit first.
[[nodiscard]] std::vector<std::string_view> unitNames(Dimension dimension);

/// "a stiffness", "a length", ...
[[nodiscard]] std::string_view dimensionName(Dimension dimension) noexcept;

}  // namespace palpate
