#pragma once
/// argv -> what to do. The only place that knows the option parser.

#include <string>
#include <vector>

#include "options.h"
#include "pack/pack_options.h"

namespace palpate::tools {

struct Invocation {
  std::string verb;  ///< empty if only `print` is wanted
  GeneralOptions general;
  bool no_cache = false;  ///< of verbs that make the grids of scenes
  AnyOptions options;
  std::string print;  ///< help or version: to stdout, and nothing else is done
};

/// @throws Error (kUsage) that names what is wrong, with a suggestion where a slip is likely.
[[nodiscard]] Invocation parseCommandLine(const std::vector<std::string>& arguments);

/// What `palpate help`, `palpate help VERB` and `palpate help --markdown` print.
[[nodiscard]] std::string helpText(const HelpOptions& options);

}  // namespace palpate::tools
