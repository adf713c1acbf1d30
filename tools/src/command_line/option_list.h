#pragma once
/// The options of a verb as its declaration made them.

#include <string>
#include <vector>

#include "command_line/verb.h"

namespace palpate::tools {

struct OptionWords {
  std::vector<std::string> names = {};  ///< "-o", "--output"
  std::string value = {};               ///< what stands behind it, for people; empty: a flag
  std::string help = {};
  std::string group = {};
  std::vector<std::string> choices = {};  ///< empty: anything
  bool is_file = false;
};

/// In the order of their groups, with --help.
[[nodiscard]] std::vector<OptionWords> optionsOf(const Verb& verb);

}  // namespace palpate::tools
