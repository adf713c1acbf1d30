#pragma once
/// What a verb has to say in the end. Printed once, by main(), as text or as one JSON object.

#include <nlohmann/json.hpp>
#include <string>

namespace palpate::tools {

using Json = nlohmann::ordered_json;

struct Report {
  Json json;           ///< with "schema": "palpate.<verb>/1" first
  std::string text;    ///< for people; ends with a newline
  bool is_yes = true;  ///< false: the work is done, but the answer is no (exit 1)
};

}  // namespace palpate::tools
