#include <algorithm>

#include "command_line/verb.h"
#include "pack/bundle.h"
#include "palpate/core/text.h"
#include "palpate/scene/suggestion.h"
#include "palpate/version.h"

namespace palpate::tools {
namespace {

bool isOfNumbers(const std::string& text) {
  return text.find_first_not_of("0123456789+-.eE, ") == std::string::npos;
}

bool looksLikePoint(const std::string& text) {
  return std::count(text.begin(), text.end(), ',') == 2 && isOfNumbers(text);
}

/// The error for an unknown option, with a suggestion.
Error unknownArgument(const CLI::App& app, const Verb& verb, const std::string& argument) {
  const std::string more = "see palpate " + std::string(verb.name) + " --help";
  if (argument.find(',') != std::string::npos && isOfNumbers(argument)) {
    return usageError("'" + argument + "' is not a point", "a point is three numbers: X,Y,Z");
  }
  if (argument.empty() || argument[0] != '-') {
    return usageError("unexpected argument '" + argument + "'", more);
  }
  std::vector<std::string> names = {"--help"};
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
  }
  const std::string word = argument.substr(0, argument.find('='));
  const std::string close =
      suggest(word, std::vector<std::string_view>(names.begin(), names.end()));
  return usageError("'" + std::string(verb.name) + "' has no option " + word,
                    close.empty() ? more : "did you mean " + close + "?");
}

/// `--insert A B C` becomes `--insert A --insert B --insert C`, so that a list of points never
/// swallows the arguments behind it; and "-.5,..." is told apart from a short option.
std::vector<std::string> spreadPoints(const Verb& verb, const std::vector<std::string>& arguments) {
  std::vector<std::string> out;
  std::string list;
  bool first = false;
  for (const std::string& argument : arguments) {
    if (verb.point_lists.contains(argument)) {
      list = argument;
      first = true;
      out.push_back(argument);
      continue;
    }
    if (!list.empty() && looksLikePoint(argument)) {
      if (!first) out.push_back(list);
      first = false;
    } else {
      list.clear();
    }
    out.push_back(argument.starts_with("-.") ? "-0" + argument.substr(1) : argument);
  }
  return out;
}

/// `argument` as one word of a shell.
std::string inShell(const std::string& argument) {
  constexpr const char* kPlain =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789_-+=:,./@%";
  if (!argument.empty() && argument.find_first_not_of(kPlain) == std::string::npos) return argument;
  std::string out = "'";
  for (const char c : argument) {
    if (c == '\'') {
      out += "'\\''";
    } else {
      out += c;
    }
  }
  return out + "'";
}

}  // namespace

const std::vector<Verb>& verbs() {
  static const std::vector<Verb> all = {
      touchVerb(),   viewVerb(),  replayVerb(),   importVerb(),  bakeVerb(),    packVerb(),
      convertVerb(), infoVerb(),  checkVerb(),    queryVerb(),   explainVerb(), renderVerb(),
      reportVerb(),  benchVerb(), accuracyVerb(), devicesVerb(), doctorVerb(),  helpVerb()};
  return all;
}

const Verb* findVerb(std::string_view name) {
  const auto& all = verbs();
  const auto at =
      std::find_if(all.begin(), all.end(), [&](const Verb& v) { return v.name == name; });
  return at == all.end() ? nullptr : &*at;
}

Error unknownVerb(const std::string& word) {
  return usageError(
      "there is no verb '" + word + "'",
      suggestionFor(word, verbs(), "the verbs are " + joined(verbs(), ", ", &Verb::name),
                    &Verb::name));
}

Invocation parseCommandLine(const std::vector<std::string>& arguments) {
  Invocation invocation;
  invocation.general.command = "palpate";
  for (const std::string& argument : arguments) {
    invocation.general.command += " " + inShell(argument);
  }
  // General options may stand before the verb as well.
  std::size_t at = 0;
  std::vector<std::string> rest;
  while (at < arguments.size() && arguments[at].starts_with("--") && arguments[at] != "--help" &&
         arguments[at] != "--version") {
    if (arguments[at] != "--json" && arguments[at] != "--quiet" && arguments[at] != "--force") {
      throw usageError("'" + arguments[at] + "' cannot stand before the verb",
                       "put the verb first: palpate VERB " + arguments[at]);
    }
    rest.push_back(arguments[at++]);
  }
  if (at == arguments.size()) {
    throw usageError("a verb is missing", "palpate --help lists them");
  }
  const std::string& word = arguments[at];
  if (word == "--help" || word == "-h") {
    invocation.print = overview();
    return invocation;
  }
  if (word == "--version") {
    invocation.print = "palpate " PALPATE_VERSION_STRING "\n";
    return invocation;
  }
  const Verb* verb = findVerb(word);
  if (verb == nullptr) throw unknownVerb(word);
  rest.insert(rest.end(), arguments.begin() + static_cast<std::ptrdiff_t>(at) + 1, arguments.end());
  if (std::any_of(rest.begin(), rest.end(),
                  [](const std::string& a) { return a == "--help" || a == "-h"; })) {
    invocation.print = verbHelp(*verb);
    return invocation;
  }

  invocation.verb = word;
  auto app = makeApp(*verb, invocation);
  rest = spreadPoints(*verb, rest);
  std::reverse(rest.begin(), rest.end());  // as CLI11 wants them
  try {
    app->parse(std::move(rest));
  } catch (const CLI::ExtrasError&) {
    const auto extras = app->remaining();
    const auto option = std::find_if(extras.begin(), extras.end(),
                                     [](const std::string& a) { return a.starts_with('-'); });
    throw unknownArgument(*app, *verb, option != extras.end() ? *option : extras.front());
  } catch (const CLI::ParseError& error) {
    throw usageError(error.what(), "see palpate " + word + " --help");
  }
  try {
    verb->check(invocation);
  } catch (const Error& error) {
    Problem problem = error.problem();
    if (problem.hint.empty()) problem.hint = "usage: " + std::string(verb->usage);
    throw Error(ErrorKind::kUsage, problem);
  }
  openBundles(invocation.options);
  return invocation;
}

}  // namespace palpate::tools
