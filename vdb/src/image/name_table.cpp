#include <charconv>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "palpate/core/error.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

constexpr std::string_view kBlanks = " \t\r\v\f";

std::string_view trimmed(std::string_view text) {
  const auto first = text.find_first_not_of(kBlanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlanks) - first + 1);
}

template <typename Number>
std::optional<Number> numberIn(std::string_view text) {
  Number value{};
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// One field of a CSV row, with or without quotes; takes it and its comma off the front of `row`.
std::string takeCsvField(std::string_view& row) {
  std::string field;
  std::string_view rest = trimmed(row);
  if (rest.starts_with('"')) {
    std::size_t i = 1;
    for (; i < rest.size(); ++i) {
      if (rest[i] != '"') {
        field += rest[i];
      } else if (i + 1 < rest.size() && rest[i + 1] == '"') {
        field += rest[i++];
      } else {
        break;
      }
    }
    rest.remove_prefix(std::min(rest.size(), i + 1));
    const auto comma = rest.find(',');
    row = comma == std::string_view::npos ? std::string_view{} : rest.substr(comma + 1);
    return field;
  }
  const auto comma = row.find(',');
  field = trimmed(row.substr(0, comma));
  row = comma == std::string_view::npos ? std::string_view{} : row.substr(comma + 1);
  return field;
}

/// Columns between tabs if there is one, else between runs of blanks.
std::vector<std::string_view> columnsOf(std::string_view line) {
  const bool tabs = line.find('\t') != std::string_view::npos;
  std::vector<std::string_view> columns;
  while (!line.empty()) {
    const auto end = line.find_first_of(tabs ? "\t" : kBlanks);
    const std::string_view column = trimmed(line.substr(0, end));
    if (!column.empty()) columns.push_back(column);
    line = end == std::string_view::npos ? std::string_view{} : line.substr(end + 1);
  }
  return columns;
}

class TableReader {
 public:
  explicit TableReader(const std::string& path) : path_(path) {}

  void addLine(std::string_view line) {
    ++line_;
    if (line_ == 1 && line.starts_with("\xEF\xBB\xBF")) line.remove_prefix(3);
    line = trimmed(line);
    if (line.empty() || line.front() == '#') return;
    if (!csv_) csv_ = line.find(',') != std::string_view::npos;
    if (*csv_) {
      addCsv(line);
    } else {
      addColumns(line);
    }
    header_may_come_ = false;
  }

  NameTable finish() {
    if (table_.empty()) {
      line_ = 0;
      throw fail("labels.table_empty", "the table names no label", kExpected);
    }
    return std::move(table_);
  }

 private:
  static constexpr const char* kExpected =
      "each line is `index name` or `index name code`, or CSV `value,name`";

  Error fail(const char* code, std::string message, std::string hint = {}) const {
    Problem problem{code, std::move(message), std::move(hint), path_};
    problem.line = line_;
    return Error(ErrorKind::kInput, std::move(problem));
  }

  void addCsv(std::string_view line) {
    std::string_view rest = line;
    const std::string value = takeCsvField(rest);
    const std::string name = takeCsvField(rest);
    if (header_may_come_ && !value.empty() && !numberIn<double>(value)) return;
    add(value, name);
  }

  void addColumns(std::string_view line) {
    const auto columns = columnsOf(line);
    // A name with blanks in it would be cut off, or another format misread; both are refused.
    for (std::size_t i = 2; i < columns.size(); ++i) {
      if (!numberIn<double>(columns[i])) {
        throw fail("labels.table_row",
                   "`" + std::string(columns[i]) + "` follows the name and is not a number",
                   std::string(kExpected) + "; a name with blanks needs CSV or tabs");
      }
    }
    add(columns[0], columns.size() > 1 ? columns[1] : std::string_view{});
  }

  void add(std::string_view value_text, std::string_view name) {
    const auto value = numberIn<int>(value_text);
    if (!value) {
      throw fail("labels.table_row", "`" + std::string(value_text) + "` is not a label value",
                 kExpected);
    }
    if (name.empty()) {
      throw fail("labels.table_row", "label " + std::to_string(*value) + " has no name", kExpected);
    }
    const auto [entry, is_new] = table_.emplace(*value, name);
    if (!is_new && entry->second != name) {
      throw fail("labels.table_duplicate",
                 "label " + std::to_string(*value) + " is named `" + std::string(name) +
                     "` here and `" + entry->second + "` before",
                 "keep one of the two lines");
    }
  }

  const std::string& path_;
  int line_ = 0;
  std::optional<bool> csv_;  ///< decided by the first line that is not a comment
  bool header_may_come_ = true;
  NameTable table_;
};

}  // namespace

NameTable readNameTable(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) {
    throw inputError("labels.table_missing", "this is a directory, not a table of names", {}, path);
  }
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw inputError("labels.table_missing", "the table of names cannot be read", {}, path);
  TableReader reader(path);
  for (std::string line; std::getline(file, line);) reader.addLine(line);
  return reader.finish();
}

}  // namespace palpate::vdb
