#pragma once
/// What a verb has to say in the end. Printed once, by main(), as text or as one JSON object.

#include <nlohmann/json.hpp>
#include <string>
#include <vector>

namespace palpate::tools {

using Json = nlohmann::ordered_json;

/// A table of a report's text, cell by cell.
struct ReportTable {
  std::string title;
  std::vector<std::vector<std::string>> rows;  ///< the heading first
};

struct Report {
  Json json;                             ///< with "schema": "palpate.<verb>/1" first
  std::string text;                      ///< for people; ends with a newline
  std::vector<ReportTable> tables = {};  ///< of the text, for a page
  std::vector<std::string> notes = {};   ///< sentences of the text that stand in none of them
  bool is_yes = true;                    ///< false: the work is done, but the answer is no (exit 1)
};

}  // namespace palpate::tools
