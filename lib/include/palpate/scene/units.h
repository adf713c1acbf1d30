#pragma once
/// Physical quantities written with their unit ("1500 N/m"), and length units.

#include <optional>
#include <string_view>

#include "palpate/export.h"

namespace palpate {

/// The kind of physical quantity that a text must state, with its SI unit.
enum class Dimension {
  kLength,      ///< m
  kForce,       ///< N
  kStiffness,   ///< N/m
  kDamping,     ///< N.s/m
  kVelocity,    ///< m/s
  kTime,        ///< s
  kFrequency,   ///< Hz
  kStiffness2,  ///< N/m^2
  kDamping2,    ///< N.s/m^2
  kMass,        ///< kg
  kForceRate,   ///< N/s
};

/// Meters in one `unit` ("mm", "cm", "m", "um", "in"); nothing if the unit is not known.
[[nodiscard]] PALPATE_EXPORT std::optional<double> metersPer(std::string_view unit) noexcept;

/// Outcome of reading a quantity's text.
struct Quantity {
  /// Whether the text could be read, and if not, why.
  enum class Status {
    kOk,
    kNotANumber,     ///< does not begin with a finite number
    kMissingUnit,    ///< a number alone
    kUnknownUnit,    ///< the text after the number is not a known unit
    kWrongDimension  ///< the unit is known, but of another dimension
  };
  Status status = Status::kNotANumber;  ///< `si` has a meaning only with kOk
  double si = 0.0;                      ///< value in SI
  std::string_view unit = {};           ///< as written
};

/// Reads "1500 N/m", "1.5 N/mm", "4 N.s/m", "0.5 Ns/m", "2.8 N", "3 mm", "30 um".
[[nodiscard]] PALPATE_EXPORT Quantity parseQuantity(std::string_view text,
                                                    Dimension dimension) noexcept;

/// A plain decimal number that is the whole text and finite, not octal, hex or inf; else nothing.
[[nodiscard]] PALPATE_EXPORT std::optional<double> parseNumber(std::string_view text) noexcept;

/// The SI unit and others that are understood, for messages: "N/m (also N/mm, N/cm, kN/m)".
[[nodiscard]] PALPATE_EXPORT std::string_view unitHelp(Dimension dimension) noexcept;

}  // namespace palpate
