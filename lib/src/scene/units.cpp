#include "palpate/scene/units.h"

#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "scene/unit_table.h"

namespace palpate {
namespace {

struct Unit {
  std::string_view name;
  Dimension dimension;
  double si;  ///< SI units in one of this unit
};

// Every unit that is understood; the SI unit of a dimension comes first.
constexpr std::array kUnits = {
    Unit{"m", Dimension::kLength, 1.0},          Unit{"mm", Dimension::kLength, 1e-3},
    Unit{"cm", Dimension::kLength, 1e-2},        Unit{"um", Dimension::kLength, 1e-6},
    Unit{"in", Dimension::kLength, 0.0254},      Unit{"N", Dimension::kForce, 1.0},
    Unit{"mN", Dimension::kForce, 1e-3},         Unit{"kN", Dimension::kForce, 1e3},
    Unit{"N/m", Dimension::kStiffness, 1.0},     Unit{"N/mm", Dimension::kStiffness, 1e3},
    Unit{"N/cm", Dimension::kStiffness, 1e2},    Unit{"kN/m", Dimension::kStiffness, 1e3},
    Unit{"N.s/m", Dimension::kDamping, 1.0},     Unit{"Ns/m", Dimension::kDamping, 1.0},
    Unit{"N.s/mm", Dimension::kDamping, 1e3},    Unit{"Ns/mm", Dimension::kDamping, 1e3},
    Unit{"m/s", Dimension::kVelocity, 1.0},      Unit{"mm/s", Dimension::kVelocity, 1e-3},
    Unit{"cm/s", Dimension::kVelocity, 1e-2},    Unit{"s", Dimension::kTime, 1.0},
    Unit{"ms", Dimension::kTime, 1e-3},          Unit{"us", Dimension::kTime, 1e-6},
    Unit{"Hz", Dimension::kFrequency, 1.0},      Unit{"kHz", Dimension::kFrequency, 1e3},
    Unit{"N/m^2", Dimension::kStiffness2, 1.0},  Unit{"N/mm^2", Dimension::kStiffness2, 1e6},
    Unit{"N/cm^2", Dimension::kStiffness2, 1e4}, Unit{"N.s/m^2", Dimension::kDamping2, 1.0},
    Unit{"Ns/m^2", Dimension::kDamping2, 1.0},   Unit{"N.s/mm^2", Dimension::kDamping2, 1e6},
    Unit{"kg", Dimension::kMass, 1.0},           Unit{"g", Dimension::kMass, 1e-3},
    Unit{"N/s", Dimension::kForceRate, 1.0},     Unit{"mN/s", Dimension::kForceRate, 1e-3},
    Unit{"kN/s", Dimension::kForceRate, 1e3},
};

bool isDigit(char c) noexcept { return c >= '0' && c <= '9'; }

std::size_t digitsAt(std::string_view text, std::size_t at) noexcept {
  std::size_t count = 0;
  while (at + count < text.size() && isDigit(text[at + count])) ++count;
  return count;
}

// Length of the decimal number that `text` starts with; 0 if it starts with none.
// [+-] digits [. digits] [e [+-] digits], no leading zero but in "0" and "0.5", at least one digit.
std::size_t numberLength(std::string_view text) noexcept {
  std::size_t at = !text.empty() && (text[0] == '+' || text[0] == '-') ? 1 : 0;
  const std::size_t whole = digitsAt(text, at);
  if (whole > 1 && text[at] == '0') return 0;
  at += whole;
  std::size_t fraction = 0;
  if (at < text.size() && text[at] == '.') {
    fraction = digitsAt(text, at + 1);
    if (whole + fraction > 0) at += 1 + fraction;
  }
  if (whole + fraction == 0) return 0;
  if (at < text.size() && (text[at] == 'e' || text[at] == 'E')) {
    std::size_t exponent = at + 1;
    if (exponent < text.size() && (text[exponent] == '+' || text[exponent] == '-')) ++exponent;
    const std::size_t digits = digitsAt(text, exponent);
    if (digits > 0) at = exponent + digits;
  }
  return at;
}

// True if the text continues behind its first digits the way numbers do for other readers: "1_000",
// "1,5", "0x1F".
bool continuesNumber(std::string_view text, std::size_t length) noexcept {
  if (length >= text.size()) return false;
  const char next = text[length];
  const bool letter = (next >= 'a' && next <= 'z') || (next >= 'A' && next <= 'Z');
  if (!letter) return next != ' ';
  const bool zero = text[length - 1] == '0' && (length == 1 || !isDigit(text[length - 2]));
  return zero && std::string_view("xXoObB").find(next) != std::string_view::npos;
}

std::string helpFor(Dimension dimension) {
  const std::vector<std::string_view> names = unitNames(dimension);
  std::string help(names[0]);
  for (std::size_t i = 1; i < names.size(); ++i) {
    help += (i == 1 ? " (also " : ", ") + std::string(names[i]);
  }
  return help + ")";
}

}  // namespace

double scaledTo(double value, double factor) noexcept {
  const double inverse = 1.0 / factor;
  return factor < 1.0 && inverse == std::round(inverse) ? value / inverse : value * factor;
}

std::vector<std::string_view> unitNames(Dimension dimension) {
  std::vector<std::string_view> names;
  for (const Unit& unit : kUnits) {
    if (unit.dimension == dimension) names.push_back(unit.name);
  }
  return names;
}

std::string_view dimensionName(Dimension dimension) noexcept {
  switch (dimension) {
    case Dimension::kLength:
      return "a length";
    case Dimension::kForce:
      return "a force";
    case Dimension::kStiffness:
      return "a stiffness";
    case Dimension::kDamping:
      return "a damping";
    case Dimension::kVelocity:
      return "a velocity";
    case Dimension::kTime:
      return "a time";
    case Dimension::kFrequency:
      return "a frequency";
    case Dimension::kStiffness2:
      return "a stiffness per length";
    case Dimension::kDamping2:
      return "a damping per length";
    case Dimension::kMass:
      return "a mass";
    case Dimension::kForceRate:
      return "a force per second";
  }
  return "a quantity";
}

std::optional<double> metersPer(std::string_view unit) noexcept {
  for (const Unit& known : kUnits) {
    if (known.dimension == Dimension::kLength && known.name == unit) return known.si;
  }
  return std::nullopt;
}

std::optional<double> parseNumber(std::string_view text) noexcept {
  if (text.empty() || numberLength(text) != text.size()) return std::nullopt;
  if (text[0] == '+') text.remove_prefix(1);  // from_chars knows no plus
  double value = 0.0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

Quantity parseQuantity(std::string_view text, Dimension dimension) noexcept {
  Quantity quantity;
  const std::size_t length = numberLength(text);
  const std::optional<double> number = parseNumber(text.substr(0, length));
  if (!number) return quantity;
  if (continuesNumber(text, length)) return quantity;
  std::size_t at = length;
  while (at < text.size() && text[at] == ' ') ++at;
  quantity.unit = text.substr(at);
  if (quantity.unit.empty()) {
    quantity.status = Quantity::Status::kMissingUnit;
    return quantity;
  }
  quantity.status = Quantity::Status::kUnknownUnit;
  for (const Unit& unit : kUnits) {
    if (unit.name != quantity.unit) continue;
    if (unit.dimension != dimension) {
      quantity.status = Quantity::Status::kWrongDimension;
      return quantity;
    }
    quantity.si = scaledTo(*number, unit.si);
    quantity.status =
        std::isfinite(quantity.si) ? Quantity::Status::kOk : Quantity::Status::kNotANumber;
    return quantity;
  }
  return quantity;
}

std::string_view unitHelp(Dimension dimension) noexcept {
  static const std::array texts = [] {
    std::array<std::string, static_cast<std::size_t>(Dimension::kForceRate) + 1> all;
    for (std::size_t i = 0; i < all.size(); ++i) all[i] = helpFor(static_cast<Dimension>(i));
    return all;
  }();
  return texts[static_cast<std::size_t>(dimension)];
}

}  // namespace palpate
