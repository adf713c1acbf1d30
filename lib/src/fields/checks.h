#pragma once
/// Checks of the parameters that make a field. Private to fields.

#include <string_view>
#include <vector>

#include "palpate/fields/field.h"

namespace palpate::fields {

/// Lengths outside this range do not come from a haptic object but from a wrong unit, and their
/// squares and cubes start to leave the range of double.
inline constexpr double kSmallestLength = 1e-12;  ///< [m]
inline constexpr double kLargestLength = 1e12;    ///< [m]

/// `shape` and `parameter` name the place in the message; all throw Error (kInput).
void checkLength(std::string_view shape, std::string_view parameter, double value);
void checkNonNegative(std::string_view shape, std::string_view parameter, double value);
void checkRange(std::string_view shape, std::string_view parameter, double value, double lowest,
                double highest);
void checkFinite(std::string_view shape, std::string_view parameter, double value);
void checkPoint(std::string_view shape, std::string_view parameter, const Vec3& value);
void checkLengths(std::string_view shape, std::string_view parameter, const Vec3& value);
/// Returns `value` scaled to length 1; throws if it has no direction.
[[nodiscard]] Vec3 checkedDirection(std::string_view shape, std::string_view parameter,
                                    const Vec3& value);
/// Returns `value`; throws if it is null.
[[nodiscard]] FieldPtr checkedOperand(std::string_view shape, FieldPtr value);
/// Throws if there are fewer than `fewest`, or one is null.
void checkOperands(std::string_view shape, const std::vector<FieldPtr>& operands,
                   std::size_t fewest);
/// Throws if `field` has a band (a grid) that ends nearer than `reach` [m] to its surface: a value
/// outside the band is not a distance.
void checkBand(std::string_view shape, const Field& field, double reach);

}  // namespace palpate::fields
