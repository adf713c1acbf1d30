#pragma once
/// Reads the file of a `touch --trace`, row by row.

#include <cstdint>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "palpate/core/math.h"

namespace palpate::tools {

struct TraceLine {
  double t = 0.0;            ///< [s]
  Vec3 hip{0.0};             ///< [m]
  Vec3 proxy{0.0};           ///< [m]
  Vec3 force{0.0};           ///< [N]
  std::string region;        ///< of the proxy
  bool contact = false;      ///< a closed wall is pressed
  std::string ports;         ///< passed in this tick, separated by ";"
  std::int64_t tick_ns = 0;  ///< [ns]
  bool is_finite = true;     ///< false: a broken sensor's reading, which has no place
};

class TraceReader {
 public:
  /// @throws Error (kInput): trace.missing, trace.line.
  explicit TraceReader(std::string file);
  /// The next row; false at the end. @throws Error (kInput, trace.line) with file:line.
  [[nodiscard]] bool next(TraceLine& row);

 private:
  /// Splits the next row, which is one line, or more if quoted names contain line ends.
  [[nodiscard]] bool nextFields();
  [[nodiscard]] bool nextLine();
  /// Throws an error at the line that was read last.
  [[noreturn]] void fail(std::string message, std::string hint = {}) const;

  std::string file_;
  std::ifstream in_;
  std::string line_;
  int number_ = 0;
  std::vector<std::string> fields_;
};

}  // namespace palpate::tools
