#pragma once
/// Parses the command line. The only code that uses the option parser.

#include <string>
#include <vector>

#include "options.h"
#include "pack/pack_options.h"

namespace palpate::tools {

struct Invocation {
  std::string verb;  ///< empty if only `print` has to be printed
  GeneralOptions general;
  bool no_cache = false;  ///< for verbs that make the grids of scenes
  AnyOptions options;
  std::string print;  ///< help or version: goes to stdout, and nothing else is done
};

/// @throws Error (kUsage) that names the fault, with a suggestion where a typing error is likely.
[[nodiscard]] Invocation parseCommandLine(const std::vector<std::string>& arguments);

/// What `palpate help`, `palpate help VERB` and `palpate help --markdown` print.
[[nodiscard]] std::string helpText(const HelpOptions& options);

}  // namespace palpate::tools
