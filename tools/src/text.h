#pragma once
/// Numbers, points and tables: parsed from the command line, and formatted for people.

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/math.h"
#include "palpate/materials/material.h"

namespace palpate::tools {

/// The unit of lengths that state none.
struct LengthUnit {
  std::string name = "mm";
  double meters = 1e-3;  ///< [m] size of one unit
};
/// @throws Error (kUsage) for an unknown unit.
[[nodiscard]] LengthUnit lengthUnit(const std::string& name);

// Parsers. `what` names the option in the message. @throws Error (kUsage).
[[nodiscard]] double parseLength(std::string_view text, const LengthUnit& unit, const char* what);
[[nodiscard]] double parseSpeed(std::string_view text, const LengthUnit& unit, const char* what);
/// A plain number is in N, N/m, N.s/m, N/s or s.
[[nodiscard]] double parseForce(std::string_view text, const char* what);
[[nodiscard]] double parseStiffness(std::string_view text, const char* what);
[[nodiscard]] double parseDamping(std::string_view text, const char* what);
[[nodiscard]] double parseForceRate(std::string_view text, const char* what);
[[nodiscard]] double parseTime(std::string_view text, const char* what);
/// [bytes] "500MB", "1.5 GB" (powers of ten, as formatBytes() writes them) or "2GiB"; at least 1.
[[nodiscard]] std::uint64_t parseBytes(std::string_view text, const char* what);
/// "X,Y,Z": three numbers without a unit.
[[nodiscard]] Vec3 parseVector(std::string_view text, const char* what);
/// "X,Y,Z" in `unit`; converted to [m].
[[nodiscard]] Vec3 parsePoint(std::string_view text, const LengthUnit& unit, const char* what);
[[nodiscard]] std::vector<std::string_view> split(std::string_view text, char separator);

// Formatters.
[[nodiscard]] std::string formatNumber(double value, int digits = 4);   ///< "%.{digits}g", "inf"
[[nodiscard]] std::string formatParameter(const Parameter& parameter);  ///< "200", "200 to 900"
[[nodiscard]] std::string formatVector(const Vec3& v, int digits = 4);  ///< "(x, y, z)"
[[nodiscard]] std::string formatDirection(const Vec3& v);               ///< two decimals
[[nodiscard]] std::string formatBytes(std::uint64_t bytes);  ///< "12.3 MB" (powers of ten)
[[nodiscard]] std::string formatCount(std::uint64_t count);  ///< "1 234 567"
[[nodiscard]] std::string formatNanoseconds(double ns);      ///< "830 ns", "1.2 us"
[[nodiscard]] std::string formatSeconds(double seconds);     ///< "41.2 ms", "0.41 s"

/// Columns of text under headings; numbers are right-aligned.
class Table {
 public:
  explicit Table(std::vector<std::string> heading) { rows_.push_back(std::move(heading)); }
  void add(std::vector<std::string> row) { rows_.push_back(std::move(row)); }
  [[nodiscard]] bool empty() const noexcept { return rows_.size() == 1; }
  /// All rows, the heading first.
  [[nodiscard]] const std::vector<std::vector<std::string>>& rows() const noexcept { return rows_; }
  [[nodiscard]] std::string text(std::string_view indent) const;

 private:
  std::vector<std::vector<std::string>> rows_;
};

}  // namespace palpate::tools
