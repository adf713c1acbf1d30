#pragma once
/// The definition of a verb of the command line, and the parts that definitions are built from.

#include <CLI/CLI.hpp>
#include <functional>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "command_line.h"
#include "palpate/core/error.h"
#include "palpate/core/text.h"

namespace palpate::tools {

struct Verb {
  const char* name;
  const char* line;     ///< its purpose, in one line
  const char* example;  ///< a command that runs from the project's folder
  const char* usage;
  const char* details;                ///< text after the options; may be empty
  std::set<std::string> point_lists;  ///< options that take several points in a row
  std::function<void(CLI::App&, Invocation&)> define;
  std::function<void(const Invocation&)> check;  ///< checks that required options are there
  bool writes = false;  ///< the verb writes files, so that --force has a meaning
};

/// All verbs, in the order of `palpate --help`.
[[nodiscard]] const std::vector<Verb>& verbs();
/// The verb of that name; null if there is none.
[[nodiscard]] const Verb* findVerb(std::string_view name);
/// Makes the parser of one verb; it stores its results in `invocation`, which must outlive it.
[[nodiscard]] std::unique_ptr<CLI::App> makeApp(const Verb& verb, Invocation& invocation);

// scene_verbs.cpp
[[nodiscard]] Verb touchVerb();
[[nodiscard]] Verb queryVerb();
[[nodiscard]] Verb explainVerb();
[[nodiscard]] Verb renderVerb();
[[nodiscard]] Verb replayVerb();
[[nodiscard]] Verb reportVerb();
/// Options for the device in the hand.
void addDevice(CLI::App& app, const char* group, DeviceOptions& o, const std::string& what);
/// The names of the simulated devices.
[[nodiscard]] std::string deviceModels();
/// Checks the name of a file: returns "" unless it is empty.
[[nodiscard]] std::string named(const std::string& text);
// file_verbs.cpp
[[nodiscard]] Verb bakeVerb();
[[nodiscard]] Verb convertVerb();
[[nodiscard]] Verb infoVerb();
[[nodiscard]] Verb checkVerb();
[[nodiscard]] Verb benchVerb();
[[nodiscard]] Verb helpVerb();

/// Options for facts that a scan or, if `meshes`, a mesh does not state.
void addScan(CLI::App& app, const char* group, ScanOptions& o, bool meshes);

// view_verb.cpp
[[nodiscard]] Verb viewVerb();

// pack_verb.cpp
[[nodiscard]] Verb packVerb();

// import_verb.cpp
[[nodiscard]] Verb importVerb();

// accuracy_verb.cpp
[[nodiscard]] Verb accuracyVerb();

// device_verbs.cpp
[[nodiscard]] Verb devicesVerb();
[[nodiscard]] Verb doctorVerb();
/// Options that say how to reach a device that a hand holds.
void addRealDevice(CLI::App& app, RealDeviceOptions& o);

// help.cpp
[[nodiscard]] std::string verbHelp(const Verb& verb);
[[nodiscard]] std::string overview();

// parse.cpp
[[nodiscard]] Error unknownVerb(const std::string& word);

[[nodiscard]] inline Error usageError(std::string message, std::string hint) {
  return Error(ErrorKind::kUsage, {"usage.command_line", std::move(message), std::move(hint)});
}

inline void need(bool there, const char* what) {
  if (!there) throw usageError(std::string(what) + " is missing", "");
}

template <class Options>
Options& choose(Invocation& invocation) {
  return invocation.options.emplace<Options>();
}

template <class Options>
const Options& chosen(const Invocation& invocation) {
  return std::get<Options>(invocation.options);
}

/// An option whose value is called `what` in --help, in help group `group`.
template <class T>
CLI::Option* add(CLI::App& app, const char* group, const char* names, const char* what, T& value,
                 const char* text) {
  auto* option = app.add_option(names, value, text)->group(group)->option_text(what);
  return option->multi_option_policy(CLI::MultiOptionPolicy::Throw);
}

inline void addFlag(CLI::App& app, const char* group, const char* names, bool& value,
                    const char* text) {
  app.add_flag(names, value, text)->group(group);
}

/// A list option that takes one value each time it is given.
template <class T>
CLI::Option* addList(CLI::App& app, const char* group, const char* names, const char* what,
                     std::vector<T>& values, const char* text) {
  auto* option = app.add_option(names, values, text)->group(group)->option_text(what);
  return option->expected(1)->take_all()->allow_extra_args(false);
}

/// An option for one of a few words. If `what` is not given, it is these words: "a|b".
template <class T>
void addChoice(CLI::App& app, const char* group, const char* names,
               const std::vector<std::string>& words, T& value, const char* text,
               const std::string& what = {}) {
  add(app, group, names, what.empty() ? joined(words, "|").c_str() : what.c_str(), value, text)
      ->check(CLI::IsMember(words));
}

}  // namespace palpate::tools
