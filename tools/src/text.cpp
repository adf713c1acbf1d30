#include "text.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "palpate/core/error.h"
#include "palpate/core/text.h"
#include "palpate/scene/units.h"
#include "palpate/vdb/text.h"

namespace palpate::tools {
namespace {

using vdb::trimmed;

Error usageError(const char* what, std::string message, std::string hint) {
  return Error(ErrorKind::kUsage,
               {"usage.value", std::string(what) + ": " + std::move(message), std::move(hint)});
}

double parseWithUnit(std::string_view text, Dimension dimension, double plain_unit,
                     const std::string& plain_name, const char* what) {
  if (const auto plain = parseNumber(text)) return *plain * plain_unit;
  const Quantity quantity = parseQuantity(text, dimension);
  if (quantity.status == Quantity::Status::kOk) return quantity.si;
  throw usageError(
      what, "'" + std::string(text) + "' is not a number or a quantity",
      "a number means " + plain_name + "; or write the unit: " + std::string(unitHelp(dimension)));
}

std::size_t columns(std::string_view text) {  // UTF-8: continuation bytes take no column
  return static_cast<std::size_t>(
      std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xC0) != 0x80; }));
}

bool looksNumeric(const std::string& text) {
  return !text.empty() && (text[0] == '-' || text[0] == '.' || (text[0] >= '0' && text[0] <= '9'));
}

}  // namespace

LengthUnit lengthUnit(const std::string& name) {
  if (const auto meters = metersPer(name)) return {name, *meters};
  throw usageError("--units", "'" + name + "' is not a length unit", "one of mm, cm, m, um, in");
}

double parseLength(std::string_view text, const LengthUnit& unit, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kLength, unit.meters, unit.name, what);
}

double parseSpeed(std::string_view text, const LengthUnit& unit, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kVelocity, unit.meters, unit.name + "/s", what);
}

double parseForce(std::string_view text, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kForce, 1.0, "N", what);
}

double parseStiffness(std::string_view text, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kStiffness, 1.0, "N/m", what);
}

double parseDamping(std::string_view text, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kDamping, 1.0, "N.s/m", what);
}

double parseForceRate(std::string_view text, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kForceRate, 1.0, "N/s", what);
}

double parseTime(std::string_view text, const char* what) {
  return parseWithUnit(trimmed(text), Dimension::kTime, 1.0, "s", what);
}

std::uint64_t parseBytes(std::string_view text, const char* what) {
  struct Unit {
    std::string_view name;
    double bytes;
  };
  static constexpr std::array<Unit, 9> kUnits{{{"KiB", 1024.0},
                                               {"MiB", 1048576.0},
                                               {"GiB", 1073741824.0},
                                               {"TiB", 1099511627776.0},
                                               {"kB", 1e3},
                                               {"MB", 1e6},
                                               {"GB", 1e9},
                                               {"TB", 1e12},
                                               {"B", 1.0}}};
  text = trimmed(text);
  for (const Unit& unit : kUnits) {
    if (!text.ends_with(unit.name)) continue;
    const auto count = parseNumber(trimmed(text.substr(0, text.size() - unit.name.size())));
    const double bytes = count ? *count * unit.bytes : 0.0;
    if (bytes >= 1.0 && bytes < 1e18) return static_cast<std::uint64_t>(bytes);
    break;
  }
  throw usageError(what, "'" + std::string(text) + "' is not an amount of memory",
                   "write a number with its unit: 500MB, 2GB (also kB, TB, MiB, GiB)");
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> parts;
  for (;;) {
    const auto at = text.find(separator);
    parts.push_back(trimmed(text.substr(0, at)));
    if (at == std::string_view::npos) return parts;
    text.remove_prefix(at + 1);
  }
}

Vec3 parseVector(std::string_view text, const char* what) {
  const auto parts = split(text, ',');
  Vec3 v{0.0};
  bool good = parts.size() == 3;
  for (int i = 0; good && i < 3; ++i) {
    const auto number = parseNumber(parts[static_cast<std::size_t>(i)]);
    good = number.has_value();
    if (good) v[i] = *number;
  }
  if (!good) {
    throw usageError(what, "'" + std::string(text) + "' is not three numbers",
                     "write X,Y,Z without blanks, as in 0,-12.5,40");
  }
  return v;
}

Vec3 parsePoint(std::string_view text, const LengthUnit& unit, const char* what) {
  return parseVector(text, what) * unit.meters;
}

std::string formatNumber(double value, int digits) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0.0 ? "inf" : "-inf";
  return shortNumber(value == 0.0 ? 0.0 : value, digits);  // no "-0"
}

std::string formatParameter(const Parameter& parameter) {
  const MaterialMap::Range range = parameter.range();
  if (parameter.isConstant()) return formatNumber(range.least);
  return formatNumber(range.least) + " to " + formatNumber(range.most);
}

std::string formatVector(const Vec3& v, int digits) {
  return "(" + formatNumber(v.x, digits) + ", " + formatNumber(v.y, digits) + ", " +
         formatNumber(v.z, digits) + ")";
}

std::string formatDirection(const Vec3& v) { return formatVector(glm::round(v * 100.0) / 100.0); }

std::string formatBytes(std::uint64_t bytes) {
  const auto value = static_cast<double>(bytes);
  if (value < 1e3) return std::to_string(bytes) + " B";
  if (value < 1e6) return formatNumber(value / 1e3, 3) + " kB";
  if (value < 1e9) return formatNumber(value / 1e6, 3) + " MB";
  return formatNumber(value / 1e9, 3) + " GB";
}

std::string formatCount(std::uint64_t count) {
  std::string text = std::to_string(count);
  for (auto at = static_cast<std::ptrdiff_t>(text.size()) - 3; at > 0; at -= 3) {
    text.insert(static_cast<std::size_t>(at), 1, ' ');
  }
  return text;
}

std::string formatNanoseconds(double ns) {
  if (ns < 1e3) return formatNumber(ns, 3) + " ns";
  if (ns < 1e6) return formatNumber(ns / 1e3, 3) + " us";
  return formatNumber(ns / 1e6, 3) + " ms";
}

std::string formatSeconds(double seconds) {
  if (seconds < 1e-3) return formatNumber(seconds * 1e6, 3) + " us";
  if (seconds < 0.1) return formatNumber(seconds * 1e3, 3) + " ms";
  return formatNumber(seconds, 3) + " s";
}

std::string Table::text(std::string_view indent) const {
  std::vector<std::size_t> widths;
  for (const auto& row : rows_) {
    widths.resize(std::max(widths.size(), row.size()), 0);
    for (std::size_t i = 0; i < row.size(); ++i) widths[i] = std::max(widths[i], columns(row[i]));
  }
  // A column is right-aligned if everything below its heading looks like a number.
  std::vector<bool> right(widths.size(), rows_.size() > 1);
  for (std::size_t r = 1; r < rows_.size(); ++r) {
    for (std::size_t i = 0; i < rows_[r].size(); ++i) {
      if (!looksNumeric(rows_[r][i]) && rows_[r][i] != "-") right[i] = false;
    }
  }
  std::string out;
  for (const auto& row : rows_) {
    std::string line(indent);
    for (std::size_t i = 0; i < row.size(); ++i) {
      const std::string pad(widths[i] - columns(row[i]), ' ');
      line += right[i] ? pad + row[i] : row[i] + pad;
      if (i + 1 < row.size()) line += "  ";
    }
    line.erase(line.find_last_not_of(' ') + 1);
    out += line + "\n";
  }
  return out;
}

}  // namespace palpate::tools
