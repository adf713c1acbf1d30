#pragma once
/// The final report of a verb. main() prints it once, as text or as one JSON object.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpate::tools {

using Json = nlohmann::ordered_json;

/// A table of a report's text, as cells.
struct ReportTable {
  std::string title;
  std::vector<std::vector<std::string>> rows;  ///< the heading first
};

struct Report {
  Json json;                             ///< with "schema": "palpate.<verb>/1" first
  std::string text;                      ///< for people; ends with a newline
  std::vector<ReportTable> tables = {};  ///< the tables of the text, for a page
  std::vector<std::string> notes = {};   ///< sentences of the text that are in none of the tables
  bool is_yes = true;  ///< false: the work is done, but the answer is negative (exit 1)
};

}  // namespace palpate::tools
