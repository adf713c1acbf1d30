#include <algorithm>
#include <array>
#include <filesystem>
#include <fstream>
#include <optional>
#include <string_view>

#include "image/header_text.h"
#include "image/utf8.h"
#include "palpate/core/error.h"
#include "palpate/core/stop.h"
#include "palpate/vdb/image.h"

namespace palpate::vdb {
namespace {

/// Removes one field of a CSV row, with or without quotes, and its comma from the front of `row`.
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

std::vector<std::string> csvFields(std::string_view row) {
  std::vector<std::string> fields;
  do {
    fields.push_back(takeCsvField(row));
  } while (!row.empty());
  return fields;
}

/// Columns separated by tabs if there is one, otherwise by runs of blanks.
std::vector<std::string_view> columnsOf(std::string_view line) {
  if (line.find('\t') == std::string_view::npos) return wordsOf(line);
  std::vector<std::string_view> columns;
  while (!line.empty()) {
    const auto end = line.find('\t');
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
    if (!kind_) kind_ = kindOf(line);
    switch (*kind_) {
      case Kind::kCsv:
        addCsv(line);
        break;
      case Kind::kSnap:
        addSnap(line);
        break;
      case Kind::kColumns:
        addColumns(line);
        break;
    }
    header_may_come_ = false;
  }

  LabelTable finish() {
    if (table_.names.empty()) {
      line_ = 0;
      throw fail("labels.table_empty", "the table names no label", kExpected);
    }
    return std::move(table_);
  }

 private:
  enum class Kind { kCsv, kSnap, kColumns };
  static constexpr const char* kExpected =
      "each line is `index name`, `index name code`, `index name R G B A`, CSV `value,name`, or as "
      "ITK-SNAP "
      "writes them";

  Error fail(const char* code, std::string message, std::string hint = {}) const {
    Problem problem{code, std::move(message), std::move(hint), path_};
    problem.line = line_;
    return Error(ErrorKind::kInput, std::move(problem));
  }

  /// Decides by the first meaningful line: ITK-SNAP has seven numbers, then a name in quotes.
  static Kind kindOf(std::string_view line) {
    const auto columns = wordsOf(line);
    if (columns.size() >= 8 && columns[7].starts_with('"')) return Kind::kSnap;
    return line.find(',') != std::string_view::npos ? Kind::kCsv : Kind::kColumns;
  }

  void addSnap(std::string_view line) {
    const auto columns = wordsOf(line);
    const std::size_t open = line.find('"');
    const std::size_t close = line.rfind('"');
    if (columns.size() < 8 || open == close || columns[7].front() != '"' ||
        close + 1 != line.size()) {
      throw fail("labels.table_row", "this is not a line of an ITK-SNAP table",
                 "a line is: index R G B A visible mesh \"name\"");
    }
    for (std::size_t i = 1; i < 7; ++i) {
      if (!numberIn<double>(columns[i])) {
        throw fail("labels.table_row", "`" + std::string(columns[i]) + "` is not a number");
      }
    }
    add(columns[0], line.substr(open + 1, close - open - 1),
        {std::string(columns[1]), std::string(columns[2]), std::string(columns[3])});
  }

  void addCsv(std::string_view line) {
    const std::vector<std::string> fields = csvFields(line);
    if (header_may_come_ && !fields[0].empty() && !numberIn<double>(fields[0])) {
      findColors(fields);
      return;
    }
    std::vector<std::string> color;
    for (const std::size_t column : color_columns_) {
      if (column < fields.size() && !fields[column].empty()) color.push_back(fields[column]);
    }
    if (color.size() != 3) color.clear();
    add(fields[0], fields.size() > 1 ? fields[1] : "", color);
  }

  /// Finds the columns of colors in a header line.
  void findColors(const std::vector<std::string>& fields) {
    for (const char* name : {"color_r", "color_g", "color_b"}) {
      for (std::size_t i = 2; i < fields.size(); ++i) {
        if (lowerCase(fields[i]) == name) color_columns_.push_back(i);
      }
    }
    if (color_columns_.size() != 3) color_columns_.clear();
  }

  void addColumns(std::string_view line) {
    const auto columns = columnsOf(line);
    // A name with blanks would be cut off, or another format misread; both are refused.
    for (std::size_t i = 2; i < columns.size(); ++i) {
      if (!numberIn<double>(columns[i])) {
        throw fail("labels.table_row",
                   "`" + std::string(columns[i]) + "` stands after the name but is not a number",
                   std::string(kExpected) + "; a name with blanks needs CSV or tabs");
      }
    }
    std::vector<std::string> color;
    if (columns.size() >= 5) color.assign(columns.begin() + 2, columns.begin() + 5);
    add(columns[0], columns.size() > 1 ? columns[1] : std::string_view{}, color);
  }

  void add(std::string_view value_text, std::string_view name,
           const std::vector<std::string>& color) {
    const auto value = numberIn<int>(value_text);
    if (!value) {
      throw fail("labels.table_row", "`" + std::string(value_text) + "` is not a label value",
                 kExpected);
    }
    if (name.empty()) {
      throw fail("labels.table_row", "label " + std::to_string(*value) + " has no name", kExpected);
    }
    const auto [entry, is_new] = table_.names.emplace(*value, name);
    if (!is_new && entry->second != name) {
      throw fail("labels.table_duplicate",
                 "label " + std::to_string(*value) + " is named `" + std::string(name) +
                     "` here and `" + entry->second + "` before",
                 "keep one of the two lines");
    }
    if (color.empty()) return;
    LabelColor rgb{};
    for (std::size_t i = 0; i < 3; ++i) {
      const auto c = numberIn<double>(color[i]);
      if (!c || !(*c >= 0.0 && *c <= 255.0)) {
        throw fail("labels.table_color",
                   "`" + color[i] + "` is not a color: red, green and blue are from 0 to 255");
      }
      rgb[i] = static_cast<float>(*c / 255.0);
    }
    table_.colors[*value] = rgb;
  }

  const std::string& path_;
  int line_ = 0;
  std::optional<Kind> kind_;  ///< decided by the first line that is not a comment
  bool header_may_come_ = true;
  std::vector<std::size_t> color_columns_;
  LabelTable table_;
};

/// The table in the header of an image.
LabelTable tableOfImage(const std::string& path) {
  LabelTable table = readImageInfo(path).labels;
  if (table.names.empty()) {
    throw inputError("labels.table_empty", "this image has no table of names of its own", {}, path);
  }
  return table;
}

}  // namespace

LabelTable readLabelTable(const std::string& path) {
  std::error_code failure;
  if (std::filesystem::is_directory(path, failure)) {
    throw inputError("labels.table_missing", "this is a directory, not a table of names", {}, path);
  }
  if (std::filesystem::exists(path, failure) &&
      !std::filesystem::is_regular_file(path, failure)) {  // reading a pipe may never end
    throw inputError("labels.table_missing", "this is not a file",
                     "write the table to a file first", path);
  }
  std::ifstream file(path, std::ios::binary);
  if (!file)
    throw inputError("labels.table_missing", "the table of names cannot be read", {}, path);
  if (isImageFile(path)) return tableOfImage(path);
  TableReader reader(path);
  for (std::string line; std::getline(file, line);) {
    pollStop();
    reader.addLine(asUtf8(line));
  }
  return reader.finish();
}

}  // namespace palpate::vdb
