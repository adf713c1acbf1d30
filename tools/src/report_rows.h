#pragma once
/// Rows of a report: the same calls make a table for people and an array for programs.

#include <string>
#include <utility>
#include <vector>

#include "report.h"
#include "text.h"

namespace palpate::tools {

class ReportRows {
 public:
  explicit ReportRows(std::vector<std::string> heading) : table_(std::move(heading)) {}

  void add(std::vector<std::string> cells, Json json) {
    table_.add(std::move(cells));
    json_.push_back(std::move(json));
  }
  /// Writes the array as `key`, and the table below `title`; without rows, the text `none` (nothing
  /// if it is empty).
  void writeTo(Report& report, const std::string& key, const std::string& title,
               const std::string& none = {}) {
    report.json[key] = std::move(json_);
    if (table_.empty() && none.empty()) return;
    if (!table_.empty()) report.tables.push_back({title, table_.rows()});
    report.text += "\n" + title + "\n" + (table_.empty() ? none : table_.text("  "));
  }

 private:
  Table table_;
  Json json_ = Json::array();
};

}  // namespace palpate::tools
