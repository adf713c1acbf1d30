#include "trace_reader.h"

#include <charconv>
#include <utility>

#include "palpate/core/error.h"
#include "palpate/render/trace.h"
#include "palpate/scene/units.h"

namespace palpate::tools {
namespace {

constexpr std::size_t kColumns = 14;
constexpr std::size_t kNumbers = 10;  // number of leading columns that hold numbers
/// Longest row: an unclosed quote must not take the whole file.
constexpr std::size_t kLongestRow = 1U << 20U;

}  // namespace

TraceReader::TraceReader(std::string file) : file_(std::move(file)), in_(file_, std::ios::binary) {
  if (!in_) throw inputError("trace.missing", "cannot read the file", "check the path", file_);
  const bool has_header = nextLine();
  if (!line_.empty() && line_.back() == '\r') line_.pop_back();
  if (!has_header || line_ + "\n" != TraceText::header()) {
    fail("this is not a trace", "write one with palpate touch SCENE ... --trace FILE.csv");
  }
}

bool TraceReader::nextLine() {
  if (!std::getline(in_, line_)) return false;
  ++number_;
  return true;
}

bool TraceReader::nextFields() {
  do {
    if (!nextLine()) return false;
  } while (line_.empty() || line_ == "\r");
  fields_.assign(1, {});
  bool is_quoted = false;
  for (std::size_t i = 0, taken = 0;; ++i) {
    if (i == line_.size()) {
      if (!is_quoted) {
        if (fields_.back().ends_with('\r')) fields_.back().pop_back();
        return true;
      }
      taken += line_.size();
      if (taken > kLongestRow || !nextLine()) fail("a quoted name has no end");
      fields_.back() += '\n';
      i = static_cast<std::size_t>(-1);  // the next round starts at the beginning of the line
    } else if (line_[i] == '"') {
      const bool is_doubled = is_quoted && i + 1 < line_.size() && line_[i + 1] == '"';
      if (is_doubled) {
        fields_.back() += '"';
        ++i;
      } else {
        is_quoted = !is_quoted;
      }
    } else if (line_[i] == ',' && !is_quoted) {
      if (fields_.size() > kColumns) fail("a row of a trace has 14 columns");
      fields_.emplace_back();
    } else {
      fields_.back() += line_[i];
    }
  }
}

bool TraceReader::next(TraceLine& row) {
  if (!nextFields()) return false;
  if (fields_.size() != kColumns) fail("a row of a trace has 14 columns");
  double numbers[kNumbers] = {};
  row.is_finite = true;
  for (std::size_t i = 0; i < kNumbers; ++i) {
    const std::string& field = fields_[i];
    const auto value = parseNumber(field);
    const bool is_broken = field == "nan" || field == "-nan" || field == "inf" || field == "-inf";
    if (!value && !is_broken) fail("'" + field + "' is not a number");
    row.is_finite = row.is_finite && !is_broken;
    numbers[i] = value.value_or(0.0);
  }
  row.t = numbers[0];
  row.hip = {numbers[1], numbers[2], numbers[3]};
  row.proxy = {numbers[4], numbers[5], numbers[6]};
  row.force = {numbers[7], numbers[8], numbers[9]};
  row.region = std::move(fields_[10]);
  if (fields_[11] != "0" && fields_[11] != "1")
    fail("contact is 0 or 1, not '" + fields_[11] + "'");
  row.contact = fields_[11] == "1";
  row.ports = std::move(fields_[12]);
  const std::string& time = fields_[13];
  const auto [end, wrong] = std::from_chars(time.data(), time.data() + time.size(), row.tick_ns);
  if (wrong != std::errc{} || end != time.data() + time.size()) {
    fail("'" + time + "' is not a whole number of nanoseconds");
  }
  return true;
}

void TraceReader::fail(std::string message, std::string hint) const {
  throw Error(ErrorKind::kInput,
              {"trace.line", std::move(message), std::move(hint), file_, number_, 1, line_});
}

}  // namespace palpate::tools
