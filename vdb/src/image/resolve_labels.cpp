#include <algorithm>
#include <charconv>
#include <optional>
#include <set>
#include <string_view>

#include "palpate/core/error.h"
#include "palpate/scene/scene_file.h"
#include "palpate/vdb/scan_surface.h"

namespace palpate::vdb {
namespace {

std::optional<int> wholeNumber(std::string_view text) {
  int value = 0;
  const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (failure != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

[[noreturn]] void failUnknown(const std::string& entry, const NameTable& names,
                              const std::string& source) {
  if (names.empty()) {
    throw inputError(
        "labels.no_names", "label `" + entry + "` is a name, and the image has no names",
        "give the image a table of names (names: labels.csv), or use label values", source);
  }
  std::vector<std::string_view> candidates;
  for (const auto& [value, name] : names) candidates.emplace_back(name);
  const std::string close = suggest(entry, candidates);
  std::string hint = close.empty() ? "names are case-sensitive; * and ? stand for any characters"
                                   : "did you mean `" + close + "`?";
  throw inputError("labels.unknown", "no label is named `" + entry + "`", std::move(hint), source);
}

}  // namespace

std::vector<int> resolveLabels(const std::vector<std::string>& match, const NameTable& names,
                               const std::string& source) {
  std::set<int> values;
  for (const std::string& entry : match) {
    if (const auto value = wholeNumber(entry)) {
      values.insert(*value);
      continue;
    }
    const bool is_glob = entry.find_first_of("*?") != std::string::npos;
    bool found = false;
    for (const auto& [value, name] : names) {
      // Label 0 is the background in almost every table; a glob that matched it would fill the
      // image.
      if (name == entry || (is_glob && value != 0 && matchesGlob(entry, name))) {
        values.insert(value);
        found = true;
      }
    }
    if (!found) failUnknown(entry, names, source);
  }
  return {values.begin(), values.end()};
}

}  // namespace palpate::vdb
